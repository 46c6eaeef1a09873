// The whole runner on small pictures: statuses, figures, rivals, deck rows, a broken kernel, the lane tuning.
#include "bench/bench_rows.h"
#include "bench/benchmark.h"
#include "bench/deck_table.h"
#include "host/base/error.h"
#include "host/device/device.h"
#include "host/shading/kernel_library.h"
#include "tests/device/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace clshade {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Device cpu() {
    return Device(select_device(list_devices(), "cpu"));
}

BenchOptions quick(const std::string& filter) {
    BenchOptions options;
    options.quick = true;
    options.width = 160;
    options.height = 90;
    options.filter = filter;
    return options;
}

const RivalResult& rival(const BenchResult& result, const std::string& name) {
    const auto found = std::find_if(result.against.begin(), result.against.end(),
                                    [&name](const RivalResult& each) { return each.name == name; });
    if (found == result.against.end()) {
        throw std::out_of_range(result.key + " has no rival " + name);
    }
    return *found;
}

bool is_prefilter(const BenchResult& result) {
    return result.key.starts_with("prefilter.");
}

int lights_in(const std::string& key) {
    if (key.find("distant8") != std::string::npos) {
        return 8;
    }
    return key.find(".environment.") == std::string::npos ? 1 : 0;
}

/// Of the deepest stack, by the row's key.
int layers_in(const std::string& key) {
    if (key.find("mixed4") != std::string::npos) {
        return 2;
    }
    const std::size_t at = key.find("layers");
    return at == std::string::npos ? 1 : std::stoi(key.substr(at + 6));
}

/// Normal and position are 6; albedo and F0 are 3 each, shininess and ids 1. Gold is all but its shininess constant,
/// skin all but its albedo.
int planes_read_in(const std::string& key) {
    if (key.find("spectral") != std::string::npos) {
        return 7;
    }
    if (key.find("layers2.blinn_phong.oren_nayar.constant.approximated.distant1.") != std::string::npos) {
        return 9;
    }
    const auto has = [&key](const char* part) { return key.find(part) != std::string::npos; };
    if ((has("layers") || has("constant_f0")) && !has("f0_map")) {
        return 10; // F0 is a constant
    }
    return has("mixed4") ? 14 : 13;
}

const BenchResult& result_named(const BenchReport& report, const std::string& key) {
    const auto found = std::find_if(report.results.begin(), report.results.end(),
                                    [&key](const BenchResult& each) { return each.key == key; });
    if (found == report.results.end()) {
        throw std::out_of_range("no result " + key);
    }
    return *found;
}

/// Writes one of the kernel files, changed, into a folder for --kernel-dir.
void write_changed(const std::filesystem::path& folder, const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
}

TEST(Benchmark, EveryRowIsTimedAndHasPlausibleFigures) {
    Device device = cpu();
    const BenchOptions options = quick("");
    const BenchReport report = run_benchmarks(device, options);
    std::vector<std::string> keys;
    for (const BenchResult& result : report.results) {
        keys.push_back(result.key);
        ASSERT_EQ(result.status, BenchStatus::ok) << result.key << ": " << result.reason;
        if (is_prefilter(result)) {
            continue; // the next test
        }
        EXPECT_EQ(result.width, 160);
        EXPECT_EQ(result.height, 90);
        EXPECT_EQ(result.lights, lights_in(result.key)) << result.key;
        EXPECT_EQ(result.environments, result.key.find("environment") != std::string::npos ? 1 : 0) << result.key;
        EXPECT_FALSE(result.max_error.has_value());
        EXPECT_EQ(result.layers, layers_in(result.key)) << result.key;
        EXPECT_GT(result.lanes, 0);
        EXPECT_EQ(result.rounds, 3);
        EXPECT_GT(result.min_ms, 0.0);
        EXPECT_GE(result.median_ms, result.min_ms);
        EXPECT_GE(result.spread, 0.0);
        EXPECT_EQ(result.bytes_per_pixel, 4.0 * (planes_read_in(result.key) + 4)) << result.key;
        EXPECT_NEAR(result.mpix_per_s, 160 * 90 * 1e-3 / result.median_ms, 1e-9 * result.mpix_per_s);
        EXPECT_NEAR(result.gb_per_s, result.mpix_per_s * result.bytes_per_pixel * 1e-3, 1e-9 * result.gb_per_s);
        EXPECT_GT(result.build_cold_ms, result.build_cached_ms) << result.key;
        EXPECT_FALSE(result.against.empty());
        for (const RivalResult& each : result.against) {
            ASSERT_EQ(each.status, BenchStatus::ok) << result.key << " against " << each.name << ": " << each.reason;
            EXPECT_GT(each.median_ms, 0.0);
            EXPECT_GT(each.ratio, 0.0);
            EXPECT_GT(each.rounds, 0);
        }
    }
    EXPECT_EQ(keys, benchmark_keys(options));
    EXPECT_FALSE(report.headline.has_value()) << "it is about the deck's size";

    // Every table is filled, from the rounds that the rows report.
    const std::string size = ".160x90";
    const std::vector<DeckEntry> entries = deck_entries();
    ASSERT_EQ(report.deck.size(), entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const DeckRow& row = report.deck[i];
        const BenchResult& ours = result_named(report, entries[i].row + size);
        ASSERT_EQ(row.status, BenchStatus::ok) << row.name << ": " << row.reason;
        EXPECT_EQ(row.deck_ratio, entries[i].ratio);
        EXPECT_EQ(row.width, 160);
        EXPECT_EQ(row.height, 90);
        EXPECT_EQ(row.median_ms, ours.median_ms);
        const std::string baseline = entries[i].baseline_row + size;
        EXPECT_EQ(row.ratio, ours.key == baseline ? 1.0 : rival(ours, baseline).ratio) << row.name;
    }
    const std::string single = layer_entries().front().row + size;
    const std::vector<LayerEntry> stacks = layer_entries();
    ASSERT_EQ(report.layers.size(), stacks.size());
    for (std::size_t i = 0; i < stacks.size(); ++i) {
        const LayerGrowth& row = report.layers[i];
        const BenchResult& ours = result_named(report, stacks[i].row + size);
        EXPECT_EQ(row.layers, ours.layers);
        EXPECT_EQ(row.median_ms, ours.median_ms);
        EXPECT_EQ(row.ratio, ours.key == single ? 1.0 : rival(ours, single).ratio);
        EXPECT_NEAR(1.0 + row.per_layer * (row.layers - 1), row.ratio, 1e-12);
    }
}

TEST(Benchmark, ThePrefilterIsTimedFromNothingAndFromTheCache) {
    Device device = cpu();
    const BenchReport report = run_benchmarks(device, quick("prefilter"));
    ASSERT_EQ(report.results.size(), 3U);
    for (const BenchResult& result : report.results) {
        ASSERT_EQ(result.status, BenchStatus::ok) << result.key << ": " << result.reason;
        EXPECT_EQ(result.width, 2 * result.height);
        EXPECT_EQ(result.lights, 0);
        EXPECT_EQ(result.environments, 1);
        EXPECT_EQ(result.layers, 0);
        EXPECT_EQ(result.rounds, 1);
        EXPECT_GT(result.min_ms, 0.0);
        // Read 3 floats a texel, and write far more for such small pictures.
        EXPECT_GT(result.bytes_per_pixel, 12.0);
        EXPECT_GT(result.build_cold_ms, result.build_cached_ms) << result.key;
        EXPECT_GT(result.max_error.value(), 0.0);
        EXPECT_LT(result.max_error.value(), 1e-4);
    }
    const BenchResult& anew = result_named(report, "prefilter.128x64");
    const BenchResult& cached = result_named(report, "prefilter.128x64.cached");
    EXPECT_LT(cached.median_ms, 0.5 * anew.median_ms); // measured at a thirtieth
    ASSERT_EQ(anew.against.size(), 1U);
    EXPECT_EQ(rival(anew, "openmp_simd").status, BenchStatus::ok) << anew.against[0].reason;
    EXPECT_GT(rival(anew, "openmp_simd").ratio, 0.0);
    EXPECT_GT(rival(anew, "openmp_simd").max_error, 0.0);
    EXPECT_TRUE(cached.against.empty());
    EXPECT_FALSE(report.headline.has_value());
    EXPECT_TRUE(report.limits.empty()) << "limits are about other sizes";
}

TEST(Benchmark, APrefilterThatComputesSomethingElseIsAnErrorNotARecord) {
    Device device = cpu();
    const tests::TemporaryFolder folder;
    // The lobe's exponent a tenth too small.
    std::string text = kernel_sources().text("filter.cl");
    const std::string power = "half_exponent * log2_cosine_squared";
    const std::size_t at = text.find(power);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, power.size(), "0.9f * " + power);
    write_changed(folder.path(), "filter.cl", text);
    BenchOptions options = quick("prefilter.128x64");
    options.kernel_dir = folder.path();
    const BenchReport report = run_benchmarks(device, options);
    ASSERT_EQ(report.results.size(), 2U);
    for (const BenchResult& result : report.results) {
        EXPECT_EQ(result.status, BenchStatus::error);
        EXPECT_THAT(result.reason, HasSubstr("double precision"));
    }
}

TEST(Benchmark, MaterialsByIdStandAgainstTheMeanOfEachAlone) {
    Device device = cpu();
    const BenchReport report = run_benchmarks(
        device, quick("mixed4|^shade\\.blinn_phong(_anisotropic)?\\.lambert\\.distant1|layers2.*approximated"));
    double least = 0.0; // no round's mean is below the mean of everyone's best round
    for (const char* alone :
         {"shade.blinn_phong.lambert", "shade.layers2.blinn_phong.lambert.constant.approximated",
          "shade.blinn_phong_anisotropic.lambert", "shade.layers2.blinn_phong.oren_nayar.constant.approximated"}) {
        least += 0.25 * result_named(report, std::string(alone) + ".distant1.160x90").min_ms;
    }
    const RivalResult& tiles = rival(result_named(report, "shade.mixed4.tiles.distant1.160x90"), "mean_alone");
    const RivalResult& scattered = rival(result_named(report, "shade.mixed4.scattered.distant1.160x90"), "mean_alone");
    ASSERT_EQ(tiles.status, BenchStatus::ok) << tiles.reason;
    EXPECT_GE(tiles.min_ms, least * (1.0 - 1e-12));
    EXPECT_GE(tiles.median_ms, tiles.min_ms);
    EXPECT_EQ(tiles.rounds, 3);
    // Both meet the same four kernels in the same rounds.
    EXPECT_EQ(tiles.median_ms, scattered.median_ms);
    EXPECT_EQ(tiles.min_ms, scattered.min_ms);
}

TEST(Benchmark, AFilterLeavesTheFourMaterialsAloneInTheRunButNotInTheReport) {
    Device device = cpu();
    const BenchReport report = run_benchmarks(device, quick("mixed4\\.tiles"));
    ASSERT_EQ(report.results.size(), 1U);
    EXPECT_EQ(rival(report.results[0], "mean_alone").status, BenchStatus::ok);
    EXPECT_GT(rival(report.results[0], "mean_alone").ratio, 0.0);
}

TEST(Benchmark, TheNaiveKernelAndTheReferenceAreFoundSlower) {
    Device device = cpu();
    BenchOptions options = quick("^shade\\.blinn_phong\\.lambert\\.distant1\\.");
    options.width = 640;
    options.height = 360;
    const BenchReport report = run_benchmarks(device, options);
    ASSERT_EQ(report.results.size(), 1U);
    const BenchResult& row = report.results.front();
    ASSERT_EQ(row.against.size(), 6U);
    // Measured near 1/40 and 1/100: a factor of three is no question of noise.
    EXPECT_LT(rival(row, "naive_opencl").ratio, 1.0 / 3.0);
    EXPECT_LT(rival(row, "reference").ratio, 1.0 / 3.0);
}

TEST(Benchmark, AFilterLeavesTheBaselineInTheRunButNotInTheReport) {
    Device device = cpu();
    const BenchReport report = run_benchmarks(device, quick("phong\\.oren_nayar\\.distant1"));
    ASSERT_EQ(report.results.size(), 1U);
    const BenchResult& row = report.results.front();
    EXPECT_EQ(row.key, "shade.blinn_phong.oren_nayar.distant1.160x90");
    EXPECT_GT(rival(row, "shade.blinn_phong.lambert.distant1.160x90").ratio, 0.0);

    ASSERT_EQ(report.deck.size(), deck_entries().size());
    for (const DeckRow& deck : report.deck) {
        const bool timed = deck.baseline == "one light, Blinn-Lambert"; // not the tables of layers and environments
        EXPECT_EQ(deck.status, timed ? BenchStatus::ok : BenchStatus::skipped) << deck.name;
        EXPECT_EQ(deck.ratio.has_value(), timed) << deck.name;
        EXPECT_EQ(deck.reason.empty(), timed) << deck.name;
        if (deck.name == "one light, Blinn-Oren-Nayar") {
            EXPECT_EQ(deck.ratio, rival(row, "shade.blinn_phong.lambert.distant1.160x90").ratio);
        }
    }
}

TEST(Benchmark, DeckRowsWithoutTheirKernelAreSkipped) {
    Device device = cpu();
    const BenchReport report = run_benchmarks(device, quick("point1"));
    const DeckRow& dual = report.deck.back();
    EXPECT_EQ(dual.status, BenchStatus::skipped) << dual.name;
    EXPECT_FALSE(dual.reason.empty());
    EXPECT_EQ(dual.width, 0);
}

TEST(Benchmark, AFilterThatMatchesNothingNamesTheKeys) {
    Device device = cpu();
    EXPECT_THAT([&] { (void)run_benchmarks(device, quick("skin")); },
                ThrowsMessage<UsageError>(HasSubstr("shade.blinn_phong.oren_nayar.distant1.160x90")));
}

TEST(Benchmark, OnOtherThanCpuDevicesHostRivalsAreSkipped) {
    DeviceInfo info = select_device(list_devices(), "cpu");
    info.kind = DeviceKind::other; // the same device under another flag
    Device device(info);
    const BenchReport report = run_benchmarks(device, quick("^shade\\.blinn_phong\\.lambert\\.distant1\\."));
    const BenchResult& row = report.results.at(0);
    ASSERT_EQ(row.status, BenchStatus::ok) << row.reason;
    for (const char* name : {"stream_cpp", "openmp_simd", "hand_simd", "reference"}) {
        EXPECT_EQ(rival(row, name).status, BenchStatus::skipped) << name;
        EXPECT_FALSE(rival(row, name).reason.empty()) << name;
    }
    EXPECT_EQ(rival(row, "stream_opencl").status, BenchStatus::ok);
    EXPECT_EQ(rival(row, "naive_opencl").status, BenchStatus::ok);
}

TEST(Benchmark, AKernelThatComputesSomethingElseIsAnErrorNotARecord) {
    Device device = cpu();
    const tests::TemporaryFolder folder;
    // The linear normaliser of section 2, ten times too small.
    std::string text = kernel_sources().text("blinn_phong.cl");
    const std::size_t at = text.find("0.0397436");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 9, "0.0039743");
    write_changed(folder.path(), "blinn_phong.cl", text);
    BenchOptions options = quick("^shade\\.blinn_phong\\.lambert\\.distant1\\.");
    options.kernel_dir = folder.path();
    const BenchReport report = run_benchmarks(device, options);
    EXPECT_EQ(report.results.at(0).status, BenchStatus::error);
    EXPECT_THAT(report.results.at(0).reason, HasSubstr("the reference"));
    EXPECT_EQ(report.deck.at(0).status, BenchStatus::skipped);
}

TEST(Benchmark, AKernelThatDoesNotBuildFailsItsRowOnly) {
    Device device = cpu();
    const tests::TemporaryFolder folder;
    write_changed(folder.path(), "blinn_phong.cl", "this is no kernel\n");
    BenchOptions options = quick("point1|spot1");
    options.kernel_dir = folder.path();
    const BenchReport report = run_benchmarks(device, options);
    ASSERT_EQ(report.results.size(), 2U);
    for (const BenchResult& result : report.results) {
        EXPECT_EQ(result.status, BenchStatus::error);
        EXPECT_FALSE(result.reason.empty());
        EXPECT_EQ(result.width, 160);
    }
}

TEST(Benchmark, ProgressCountsUpToTheTotal) {
    Device device = cpu();
    std::vector<int> seen;
    int total = 0;
    (void)run_benchmarks(device, quick("point1"), [&](const std::string& what, int done, int of) {
        EXPECT_FALSE(what.empty());
        EXPECT_LE(done, of);
        seen.push_back(done);
        total = of;
    });
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_FALSE(seen.empty());
    EXPECT_GT(total, 0);
}

TEST(TuneLanes, MeasuresEveryWidthAndChoosesOneOfThem) {
    Device device = cpu();
    const LaneTuning tuning = tune_lanes(device, quick(""));
    ASSERT_EQ(tuning.times.size(), 4U);
    std::vector<int> lanes;
    for (const LaneTime& each : tuning.times) {
        lanes.push_back(each.lanes);
        EXPECT_EQ(each.status, BenchStatus::ok) << each.reason;
        EXPECT_GT(each.median_ms, 0.0);
    }
    EXPECT_THAT(lanes, ElementsAre(1, 4, 8, 16));
    EXPECT_THAT(lanes, ::testing::Contains(tuning.best));
}

} // namespace
} // namespace clshade
