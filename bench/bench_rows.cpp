#include "bench/bench_rows.h"

#include "host/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

namespace clshade {

namespace {

constexpr int large_width = 3840;
constexpr int large_height = 2160;
constexpr int deck_width = 1280; // the deck's own picture size
constexpr int deck_height = 720;
constexpr int quick_width = 320;
constexpr int quick_height = 180;

const std::vector<Rival> streams = {Rival::stream_opencl, Rival::stream_cpp};
const std::vector<Rival> all_rivals = {Rival::stream_opencl, Rival::stream_cpp,   Rival::openmp_simd,
                                       Rival::hand_simd,     Rival::naive_opencl, Rival::reference};

std::string_view name_of(BenchLights lights) {
    switch (lights) {
    case BenchLights::distant1:
        return "distant1";
    case BenchLights::distant8:
        return "distant8";
    case BenchLights::point1:
        return "point1";
    case BenchLights::spot1:
        return "spot1";
    }
    return "?";
}

BenchScene scene_of(BoundMaterial material, BenchLights lights = BenchLights::distant1) {
    return {.materials = {std::move(material)}, .lights = lights, .ids = BenchIds::tiles, .variant = {}};
}

/// What the coated rows are measured against.
BenchScene bare_scene() {
    BenchScene scene = scene_of(layer_base());
    scene.variant = "constant_f0";
    return scene;
}

BenchScene coated_scene(int coats, AbsorptionModel absorption) {
    return scene_of(coated(coats, FresnelModel::constant, absorption));
}

/// Four materials of different stacks.
std::vector<BoundMaterial> mixed_materials() {
    return {single_layer(), coated(1, FresnelModel::constant, AbsorptionModel::approximated),
            single_layer(SpecularModel::blinn_phong_anisotropic), skin()};
}

BenchRow row_of(BenchScene scene, std::vector<Rival> rivals) {
    BenchRow row;
    row.name = row_name(scene);
    row.scene = std::move(scene);
    row.rivals = std::move(rivals);
    return row;
}

BenchRow against_lambert(BenchScene scene, std::vector<Rival> rivals = streams) {
    BenchRow row = row_of(std::move(scene), std::move(rivals));
    row.baselines.push_back({"", {BenchScene{}}});
    return row;
}

BenchRow against_base(BenchScene scene, std::vector<Rival> rivals = streams) {
    BenchRow row = row_of(std::move(scene), std::move(rivals));
    row.baselines.push_back({"", {bare_scene()}});
    return row;
}

/// A coat on a base whose F0 comes from a map: three planes and three square roots more.
BenchRow mapped_base_row() {
    BenchScene scene = scene_of(coated(1, FresnelModel::constant, AbsorptionModel::approximated, single_layer()));
    scene.variant = "f0_map";
    return against_lambert(std::move(scene));
}

BenchRow mixed_row(BenchIds ids) {
    BenchRow row =
        row_of({.materials = mixed_materials(), .lights = BenchLights::distant1, .ids = ids, .variant = {}}, streams);
    BenchBaseline alone{std::string(mean_alone), {}};
    for (const BoundMaterial& material : row.scene.materials) {
        alone.scenes.push_back(scene_of(material));
    }
    row.baselines.push_back(std::move(alone));
    return row;
}

/// Rows at both sizes: what the limits of speed are about.
std::vector<BenchRow> main_rows() {
    using enum AbsorptionModel;
    std::vector<BenchRow> rows = {row_of({}, all_rivals)};
    rows.push_back(against_lambert(scene_of(single_layer(SpecularModel::blinn_phong, DiffuseModel::oren_nayar))));
    rows.push_back(against_lambert(bare_scene()));
    for (const AbsorptionModel absorption : {none, approximated, original}) {
        rows.push_back(against_base(coated_scene(1, absorption)));
    }
    for (const int coats : {3, most_coats}) {
        rows.push_back(against_base(coated_scene(coats, approximated)));
    }
    rows.push_back(mapped_base_row());
    rows.push_back(against_lambert(scene_of(single_layer(SpecularModel::blinn_phong_anisotropic))));
    rows.push_back(against_lambert(scene_of(skin())));
    rows.push_back(mixed_row(BenchIds::tiles));
    rows.push_back(mixed_row(BenchIds::scattered));
    return rows;
}

/// Rows at the deck's size only.
std::vector<BenchRow> further_rows() {
    using enum DiffuseModel;
    std::vector<BenchRow> rows;
    rows.push_back(against_lambert(scene_of(single_layer(), BenchLights::distant8),
                                   {Rival::stream_opencl, Rival::stream_cpp, Rival::hand_simd, Rival::reference}));
    rows.push_back(against_lambert(scene_of(single_layer(), BenchLights::point1)));
    rows.push_back(against_lambert(scene_of(single_layer(), BenchLights::spot1)));
    for (const DiffuseModel diffuse : {oren_nayar_full, oren_nayar_qualitative, oren_nayar_simplified_1,
                                       oren_nayar_simplified_2, oren_nayar_shininess}) {
        rows.push_back(against_lambert(scene_of(single_layer(SpecularModel::blinn_phong, diffuse))));
    }
    rows.push_back(against_lambert(scene_of(single_layer(SpecularModel::blinn_phong_exact))));
    rows.push_back(against_lambert(scene_of(single_layer(SpecularModel::blinn_phong_spectral, DiffuseModel::none))));
    rows.push_back(against_base(scene_of(coated(1, FresnelModel::exact, AbsorptionModel::original)),
                                {Rival::stream_opencl, Rival::stream_cpp, Rival::reference}));
    return rows;
}

/// Every row at its own size, sizes together, in the order of the report.
std::vector<BenchRow> all_rows() {
    std::vector<BenchRow> rows;
    const auto add = [&rows](std::vector<BenchRow> more, int width, int height) {
        for (BenchRow& row : more) {
            row.width = width;
            row.height = height;
            rows.push_back(std::move(row));
        }
    };
    add(main_rows(), large_width, large_height);
    add(main_rows(), deck_width, deck_height);
    add(further_rows(), deck_width, deck_height);
    return rows;
}

std::regex compile_filter(const std::string& filter) {
    try {
        return std::regex(filter, std::regex::ECMAScript);
    } catch (const std::regex_error& error) {
        throw UsageError(fmt::format("--filter '{}' is not a regular expression ({}); try a part of a key, such as "
                                     "oren_nayar",
                                     filter, error.what()));
    }
}

} // namespace

std::string_view name_of(BenchStatus status) {
    switch (status) {
    case BenchStatus::ok:
        return "ok";
    case BenchStatus::skipped:
        return "skipped";
    case BenchStatus::unsupported:
        return "unsupported";
    case BenchStatus::error:
        return "error";
    }
    return "?";
}

std::vector<std::string> benchmark_keys(const BenchOptions& options) {
    std::vector<std::string> keys;
    for (const BenchRow& row : select_rows(options)) {
        keys.push_back(row.key());
    }
    return keys;
}

std::string_view name_of(Rival rival) {
    switch (rival) {
    case Rival::stream_opencl:
        return "stream_opencl";
    case Rival::stream_cpp:
        return "stream_cpp";
    case Rival::openmp_simd:
        return "openmp_simd";
    case Rival::hand_simd:
        return "hand_simd";
    case Rival::naive_opencl:
        return "naive_opencl";
    case Rival::reference:
        return "reference";
    }
    return "?";
}

std::string BenchRow::key() const {
    return fmt::format("{}.{}x{}", name, width, height);
}

std::string row_name(const BenchScene& scene) {
    if (scene.materials.size() == 1) {
        return fmt::format("shade.{}{}{}.{}", model_key(scene.materials.front()), scene.variant.empty() ? "" : ".",
                           scene.variant, name_of(scene.lights));
    }
    return fmt::format("shade.mixed{}.{}.{}", scene.materials.size(),
                       scene.ids == BenchIds::tiles ? "tiles" : "scattered", name_of(scene.lights));
}

BenchRow lambert_row(int width, int height) {
    BenchRow row = row_of({}, all_rivals);
    row.width = width;
    row.height = height;
    return row;
}

std::vector<BenchRow> select_rows(const BenchOptions& options) {
    if (options.width < 0 || options.height < 0 || (options.width > 0) != (options.height > 0)) {
        throw UsageError(
            fmt::format("--size {}x{} is no picture size; give both, such as 1280x720", options.width, options.height));
    }
    const std::regex filter = compile_filter(options.filter);
    std::vector<BenchRow> chosen;
    for (BenchRow& row : all_rows()) {
        if (options.width > 0) {
            row.width = options.width;
            row.height = options.height;
        } else if (options.quick) {
            row.width = quick_width;
            row.height = quick_height;
        }
        const std::string key = row.key();
        const bool known =
            std::any_of(chosen.begin(), chosen.end(), [&key](const BenchRow& other) { return other.key() == key; });
        if (!known && std::regex_search(key, filter)) {
            chosen.push_back(std::move(row));
        }
    }
    return chosen;
}

std::vector<DeckEntry> deck_entries() {
    using enum AbsorptionModel;
    constexpr std::string_view single = "one directional light, single layer";
    constexpr std::string_view lambert = "one light, Blinn-Lambert";
    const std::string ours = row_name({});
    const std::string base = row_name(bare_scene());
    const auto dual = [](AbsorptionModel absorption) { return row_name(coated_scene(1, absorption)); };
    const std::string oren_nayar =
        row_name(scene_of(single_layer(SpecularModel::blinn_phong, DiffuseModel::oren_nayar)));
    return {
        {single, single, 1.0, base, base},
        {"one directional light, dual layer, no absorption", single, 1.030, dual(none), base},
        {"one directional light, dual layer, approximated absorption", single, 1.121, dual(approximated), base},
        {"one directional light, dual layer, original absorption", single, 1.606, dual(original), base},
        {lambert, lambert, 1.0, ours, ours},
        {"one light, Blinn-Oren-Nayar", lambert, 1.289, oren_nayar, ours},
    };
}

std::vector<LayerEntry> layer_entries() {
    std::vector<LayerEntry> entries = {{1, row_name(bare_scene())}};
    for (const int coats : {1, 3, most_coats}) {
        entries.push_back({coats + 1, row_name(coated_scene(coats, AbsorptionModel::approximated))});
    }
    return entries;
}

} // namespace clshade
