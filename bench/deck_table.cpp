#include "bench/deck_table.h"

#include "bench/bench_rows.h"
#include "bench/bench_scenes.h"
#include "bench/prefilter_rows.h"

#include <fmt/format.h>

#include <algorithm>

namespace clshade {

namespace {

constexpr auto lambert = DiffuseModel::lambert;
constexpr auto oren_nayar = DiffuseModel::oren_nayar;
constexpr auto no_light = BenchLights::none;
constexpr auto distant1 = BenchLights::distant1;

std::string single_row(DiffuseModel diffuse, BenchLights lights) {
    return row_name(in_studio(bare_scene(diffuse), lights));
}

std::string dual_row(DiffuseModel diffuse, BenchLights lights) {
    return row_name(in_studio(dual_scene(diffuse), lights));
}

std::string deck_sized(const std::string& row) {
    return fmt::format("{}.{}x{}", row, deck_width, deck_height);
}

const BenchResult* timed(const std::vector<BenchResult>& results, const std::string& key) {
    const auto found = std::find_if(results.begin(), results.end(), [&key](const BenchResult& result) {
        return result.key == key && result.status == BenchStatus::ok;
    });
    return found == results.end() ? nullptr : &*found;
}

void judge_ratio(std::vector<SpeedLimit>& limits, const std::vector<BenchResult>& results, std::string name,
                 double limit, const std::string& row, const std::string& baseline) {
    const BenchResult* result = timed(results, deck_sized(row));
    if (result == nullptr) {
        return;
    }
    for (const RivalResult& rival : result->against) {
        if (rival.name == deck_sized(baseline) && rival.status == BenchStatus::ok) {
            limits.push_back({std::move(name), false, limit, rival.ratio});
            return;
        }
    }
}

} // namespace

std::vector<DeckEntry> deck_entries() {
    using enum AbsorptionModel;
    constexpr std::string_view single = "one directional light, single layer";
    constexpr std::string_view one_light = "one light, Blinn-Lambert";
    constexpr std::string_view single_ibl = "one environment, single layer";
    constexpr std::string_view one_ibl = "one environment, Blinn-Lambert";
    constexpr std::string_view both_lights = "light + environment, Blinn-Lambert";
    const std::string ours = row_name({});
    const std::string base = row_name(bare_scene());
    const auto dual = [](AbsorptionModel absorption) { return row_name(coated_scene(1, absorption)); };
    const std::string matte = row_name(scene_of(single_layer(SpecularModel::blinn_phong, oren_nayar)));
    const std::string ibl = single_row(lambert, no_light);
    const std::string both = single_row(lambert, distant1);
    return {
        {single, single, 1.0, base, base},
        {"one directional light, dual layer, no absorption", single, 1.030, dual(none), base},
        {"one directional light, dual layer, approximated absorption", single, 1.121, dual(approximated), base},
        {"one directional light, dual layer, original absorption", single, 1.606, dual(original), base},
        {single_ibl, single_ibl, 1.0, ibl, ibl},
        {"one environment, dual layer", single_ibl, 1.427, dual_row(lambert, no_light), ibl},
        {one_light, one_light, 1.0, ours, ours},
        {"one light, Blinn-Oren-Nayar", one_light, 1.289, matte, ours},
        {one_ibl, one_ibl, 1.0, ibl, ibl},
        {"one environment, Blinn-Oren-Nayar", one_ibl, 1.200, single_row(oren_nayar, no_light), ibl},
        {both_lights, both_lights, 1.0, both, both},
        {"light + environment, Blinn-Oren-Nayar", both_lights, 1.044, single_row(oren_nayar, distant1), both},
        {"light + environment, layered Blinn-Lambert", both_lights, 1.099, dual_row(lambert, distant1), both},
        {"light + environment, layered Blinn-Oren-Nayar", both_lights, 1.138, heaviest_row(), both},
    };
}

std::vector<LayerEntry> layer_entries() {
    std::vector<LayerEntry> entries = {{1, row_name(bare_scene())}};
    for (const int coats : {1, 3, most_coats}) {
        entries.push_back({coats + 1, row_name(coated_scene(coats, AbsorptionModel::approximated))});
    }
    return entries;
}

std::string heaviest_row() {
    return dual_row(DiffuseModel::oren_nayar, BenchLights::distant1);
}

std::optional<BenchHeadline> headline_of(const std::vector<BenchResult>& results) {
    const BenchResult* ours = timed(results, deck_sized(heaviest_row()));
    return ours == nullptr ? std::nullopt : std::optional(BenchHeadline{ours->key, deck_heaviest_ms, ours->median_ms});
}

std::vector<SpeedLimit> judged_limits(const std::vector<BenchResult>& results) {
    std::vector<SpeedLimit> limits;
    const std::string ibl = single_row(lambert, no_light);
    // Twice: with every parameter from a map, as the one-light kernel has them, and with F0 a constant.
    judge_ratio(limits, results, "one environment to one light, every parameter from a map", 2.5,
                row_name(in_studio(scene_of(single_layer()), no_light)), row_name(scene_of(single_layer())));
    judge_ratio(limits, results, "one environment to one light, single layer of the deck's tables", 2.5, ibl,
                row_name(bare_scene()));
    judge_ratio(limits, results, "dual to single layer, one environment", 1.30, dual_row(lambert, no_light), ibl);
    judge_ratio(limits, results, "Oren-Nayar to Lambert, one environment", 1.10, single_row(oren_nayar, no_light), ibl);
    judge_ratio(limits, results, "layered Oren-Nayar to Blinn-Lambert, light + environment", 1.14, heaviest_row(),
                single_row(lambert, distant1));
    if (const auto headline = headline_of(results)) {
        limits.push_back({"the deck's heaviest row", true, deck_heaviest_ms, headline->median_ms});
    }
    constexpr PrefilterRow small{.width = 1024, .height = 512, .cached = false};
    constexpr PrefilterRow stored{.width = 1024, .height = 512, .cached = true};
    if (const BenchResult* cold = timed(results, small.key())) {
        limits.push_back({"pre-filter 1024x512, nothing cached, with its build", true, 2000.0, cold->build_cold_ms});
    }
    if (const BenchResult* cached = timed(results, stored.key())) {
        limits.push_back({"pre-filter 1024x512, from the cache", true, 50.0, cached->median_ms});
    }
    return limits;
}

} // namespace clshade
