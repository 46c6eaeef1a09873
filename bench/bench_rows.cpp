#include "bench/bench_rows.h"

#include "bench/bench_scenes.h"
#include "bench/key_filter.h"
#include "host/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <regex>
#include <utility>

namespace clshade {

namespace {

constexpr int large_width = 3840;
constexpr int large_height = 2160;
constexpr int quick_width = 320;
constexpr int quick_height = 180;

const std::vector<Rival> streams = {Rival::stream_opencl, Rival::stream_cpp};
const std::vector<Rival> all_rivals = {Rival::stream_opencl, Rival::stream_cpp,   Rival::openmp_simd,
                                       Rival::hand_simd,     Rival::naive_opencl, Rival::reference};

std::string_view name_of(BenchLights lights) {
    switch (lights) {
    case BenchLights::none:
        return "unlit";
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

/// As in the shader's key of a kernel: "distant1", "environment", "distant1_environment".
std::string lights_key(const BenchScene& scene) {
    if (!scene.environment) {
        return std::string(name_of(scene.lights));
    }
    return scene.lights == BenchLights::none ? "environment" : fmt::format("{}_environment", name_of(scene.lights));
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

BenchRow against(BenchScene baseline, BenchScene scene, std::vector<Rival> rivals = streams) {
    BenchRow row = row_of(std::move(scene), std::move(rivals));
    row.baselines.push_back({"", {std::move(baseline)}});
    return row;
}

BenchRow against_lambert(BenchScene scene, std::vector<Rival> rivals = streams) {
    return against(BenchScene{}, std::move(scene), std::move(rivals));
}

BenchRow against_base(BenchScene scene, std::vector<Rival> rivals = streams) {
    return against(bare_scene(), std::move(scene), std::move(rivals));
}

/// A coat on a base whose F0 comes from a map: three planes and three square roots more.
BenchRow mapped_base_row() {
    BenchScene scene = scene_of(coated(1, FresnelModel::constant, AbsorptionModel::approximated, single_layer()));
    scene.variant = "f0_map";
    return against_lambert(std::move(scene));
}

BenchRow mixed_row(BenchIds ids) {
    BenchRow row = row_of({.materials = mixed_materials(), .ids = ids}, streams);
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

/// The four stacks of the deck's tables of image-based light: one of them, the others against it.
std::vector<BenchRow> stacks_in_studio(BenchLights lights) {
    using enum DiffuseModel;
    const BenchScene plain = in_studio(bare_scene(lambert), lights);
    std::vector<BenchRow> rows = {against_base(plain)};
    for (const BenchScene& scene : {bare_scene(oren_nayar), dual_scene(lambert), dual_scene(oren_nayar)}) {
        rows.push_back(against(plain, in_studio(scene, lights)));
    }
    return rows;
}

std::vector<BenchRow> environment_rows() {
    std::vector<BenchRow> rows = stacks_in_studio(BenchLights::none);
    rows.push_back(against_lambert(in_studio(scene_of(single_layer()), BenchLights::none)));
    std::vector<BenchRow> lit = stacks_in_studio(BenchLights::distant1);
    std::move(lit.begin(), lit.end(), std::back_inserter(rows));
    return rows;
}

/// What limits of speed are about, and the deck's heaviest row.
std::vector<BenchRow> main_environment_rows() {
    using enum DiffuseModel;
    const BenchScene single = in_studio(bare_scene(lambert), BenchLights::none);
    const BenchScene lit = in_studio(bare_scene(lambert), BenchLights::distant1);
    return {against_base(single), against(single, in_studio(dual_scene(lambert), BenchLights::none)), against_base(lit),
            against(lit, in_studio(dual_scene(oren_nayar), BenchLights::distant1))};
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
    add(main_environment_rows(), large_width, large_height);
    add(main_rows(), deck_width, deck_height);
    add(further_rows(), deck_width, deck_height);
    add(environment_rows(), deck_width, deck_height);
    return rows;
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
    const std::string lights = lights_key(scene);
    if (scene.materials.size() == 1) {
        return fmt::format("shade.{}{}{}.{}", model_key(scene.materials.front()), scene.variant.empty() ? "" : ".",
                           scene.variant, lights);
    }
    return fmt::format("shade.mixed{}.{}.{}", scene.materials.size(),
                       scene.ids == BenchIds::tiles ? "tiles" : "scattered", lights);
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
    const std::regex filter = compiled_filter(options.filter);
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

} // namespace clshade
