#include "bench/bench_rows.h"

#include "host/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>

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

BenchRow row_of(const BenchScene& scene, std::vector<Rival> rivals, bool against_lambert) {
    BenchRow row;
    row.name = scene.mixed ? fmt::format("shade.mixed4.{}", name_of(scene.lights))
                           : fmt::format("shade.{}.{}.{}", name_of(scene.specular), name_of(scene.diffuse),
                                         name_of(scene.lights));
    row.width = deck_width;
    row.height = deck_height;
    row.scene = scene;
    row.rivals = std::move(rivals);
    row.against_lambert = against_lambert;
    return row;
}

/// Every row at its own size, in the order of the report.
std::vector<BenchRow> all_rows() {
    std::vector<BenchRow> rows = {lambert_row(large_width, large_height), lambert_row(deck_width, deck_height)};
    const auto add = [&rows](SpecularModel specular, DiffuseModel diffuse, BenchLights lights,
                             std::vector<Rival> rivals) {
        rows.push_back(row_of({specular, diffuse, lights, false}, std::move(rivals), true));
    };
    using enum DiffuseModel;
    add(SpecularModel::blinn_phong, lambert, BenchLights::distant8,
        {Rival::stream_opencl, Rival::stream_cpp, Rival::hand_simd, Rival::reference});
    add(SpecularModel::blinn_phong, lambert, BenchLights::point1, streams);
    add(SpecularModel::blinn_phong, lambert, BenchLights::spot1, streams);
    for (const DiffuseModel diffuse : {oren_nayar, oren_nayar_full, oren_nayar_qualitative, oren_nayar_simplified_1,
                                       oren_nayar_simplified_2, oren_nayar_shininess}) {
        add(SpecularModel::blinn_phong, diffuse, BenchLights::distant1, streams);
    }
    add(SpecularModel::blinn_phong_exact, lambert, BenchLights::distant1, streams);
    rows.push_back(row_of({.mixed = true}, streams, true));
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

BenchRow lambert_row(int width, int height) {
    BenchRow row = row_of({}, all_rivals, false);
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
    constexpr std::string_view no_layers = "layered materials are not built yet";
    constexpr std::string_view single = "one directional light, single layer";
    return {
        {"one light, Blinn-Oren-Nayar", "one light, Blinn-Lambert", 1.289, "shade.blinn_phong.oren_nayar.distant1", ""},
        {"one directional light, dual layer, no absorption", single, 1.030, "", no_layers},
        {"one directional light, dual layer, approximated absorption", single, 1.121, "", no_layers},
        {"one directional light, dual layer, original absorption", single, 1.606, "", no_layers},
    };
}

} // namespace clshade
