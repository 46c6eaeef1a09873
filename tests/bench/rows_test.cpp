// Which rows there are, what they are called and how they are chosen; what the bench frame holds.
#include "bench/bench_frame.h"
#include "bench/bench_rows.h"
#include "bench/benchmark.h"
#include "bench/deck_table.h"
#include "bench/prefilter_rows.h"
#include "host/base/error.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Pair;
using ::testing::ThrowsMessage;

MATCHER_P2(IsNear, value, distance, "") {
    return std::abs(arg - value) <= distance;
}

/// The row of this name at the deck's size.
BenchRow find_row(const std::string& name) {
    for (BenchRow& row : select_rows({})) {
        if (row.name == name && row.width == 1280) {
            return row;
        }
    }
    throw std::out_of_range("no row " + name);
}

TEST(BenchRows, KeysAreStable) {
    // A baseline file names them: adding is fine, renaming is not.
    const std::vector<std::string> at_both_sizes = {
        "shade.blinn_phong.lambert.distant1",
        "shade.blinn_phong.oren_nayar.distant1",
        "shade.blinn_phong.lambert.constant_f0.distant1",
        "shade.layers2.blinn_phong.lambert.constant.none.distant1",
        "shade.layers2.blinn_phong.lambert.constant.approximated.distant1",
        "shade.layers2.blinn_phong.lambert.constant.original.distant1",
        "shade.layers4.blinn_phong.lambert.constant.approximated.distant1",
        "shade.layers8.blinn_phong.lambert.constant.approximated.distant1",
        "shade.layers2.blinn_phong.lambert.constant.approximated.f0_map.distant1",
        "shade.blinn_phong_anisotropic.lambert.distant1",
        "shade.layers2.blinn_phong.oren_nayar.constant.approximated.distant1",
        "shade.mixed4.tiles.distant1",
        "shade.mixed4.scattered.distant1",
    };
    std::vector<std::string> expected;
    const auto add = [&expected](const std::vector<std::string>& names, const std::string& size) {
        for (const std::string& name : names) {
            expected.push_back(name + size);
        }
    };
    add(at_both_sizes, ".3840x2160");
    add({"shade.blinn_phong.lambert.constant_f0.environment",
         "shade.layers2.blinn_phong.lambert.constant.approximated.environment",
         "shade.blinn_phong.lambert.constant_f0.distant1_environment",
         "shade.layers2.blinn_phong.oren_nayar.constant.approximated.distant1_environment"},
        ".3840x2160");
    add(at_both_sizes, ".1280x720");
    for (const char* name :
         {"shade.blinn_phong.lambert.distant8", "shade.blinn_phong.lambert.point1", "shade.blinn_phong.lambert.spot1",
          "shade.blinn_phong.oren_nayar_full.distant1", "shade.blinn_phong.oren_nayar_qualitative.distant1",
          "shade.blinn_phong.oren_nayar_simplified_1.distant1", "shade.blinn_phong.oren_nayar_simplified_2.distant1",
          "shade.blinn_phong.oren_nayar_shininess.distant1", "shade.blinn_phong_exact.lambert.distant1",
          "shade.blinn_phong_spectral.none.distant1", "shade.layers2.blinn_phong.lambert.exact.original.distant1"}) {
        expected.push_back(std::string(name) + ".1280x720");
    }
    for (const char* lights : {"environment", "distant1_environment"}) {
        for (const char* stack : {"blinn_phong.lambert.constant_f0", "blinn_phong.oren_nayar.constant_f0",
                                  "layers2.blinn_phong.lambert.constant.approximated",
                                  "layers2.blinn_phong.oren_nayar.constant.approximated"}) {
            add({fmt::format("shade.{}.{}", stack, lights)}, ".1280x720");
        }
        if (std::string_view(lights) == "environment") { // the one-light kernel's own material
            add({"shade.blinn_phong.lambert.environment"}, ".1280x720");
        }
    }
    add({"prefilter.1024x512", "prefilter.4096x2048", "prefilter.1024x512.cached"}, "");
    EXPECT_THAT(benchmark_keys({}), ElementsAreArray(expected));
}

TEST(BenchRows, TheFilterSearchesTheKey) {
    BenchOptions options;
    options.filter = "oren_nayar\\..*distant1\\.";
    EXPECT_THAT(benchmark_keys(options),
                ElementsAre("shade.blinn_phong.oren_nayar.distant1.3840x2160",
                            "shade.layers2.blinn_phong.oren_nayar.constant.approximated.distant1.3840x2160",
                            "shade.blinn_phong.oren_nayar.distant1.1280x720",
                            "shade.layers2.blinn_phong.oren_nayar.constant.approximated.distant1.1280x720"));
    options.filter = "layers8.*3840";
    EXPECT_THAT(benchmark_keys(options),
                ElementsAre("shade.layers8.blinn_phong.lambert.constant.approximated.distant1.3840x2160"));
    options.filter = "1024";
    EXPECT_THAT(benchmark_keys(options), ElementsAre("prefilter.1024x512", "prefilter.1024x512.cached"));
    options.filter = "^lambert";
    EXPECT_THAT(benchmark_keys(options), ElementsAre());
    options.filter = "(";
    EXPECT_THAT([&] { (void)benchmark_keys(options); },
                ThrowsMessage<UsageError>(HasSubstr("--filter '(' is not a regular expression")));
}

TEST(BenchRows, OneSizeForAllLeavesEachKeyOnce) {
    BenchOptions options;
    options.width = 64;
    options.height = 32;
    const std::vector<std::string> keys = benchmark_keys(options);
    EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), keys.size());
    // An environment's size is no picture's.
    EXPECT_TRUE(std::all_of(keys.begin(), keys.end(), [](const std::string& key) {
        return key.ends_with(".64x32") != key.starts_with("prefilter.");
    }));
    options.height = 0;
    EXPECT_THROW((void)benchmark_keys(options), UsageError);
}

TEST(BenchRows, TheLambertRowMeetsEveryRival) {
    EXPECT_THAT(lambert_row(64, 32).rivals, ElementsAre(Rival::stream_opencl, Rival::stream_cpp, Rival::openmp_simd,
                                                        Rival::hand_simd, Rival::naive_opencl, Rival::reference));
    EXPECT_EQ(lambert_row(64, 32).key(), "shade.blinn_phong.lambert.distant1.64x32");
}

TEST(BenchRows, DeckRatiosAreThoseOfTheDeck) {
    // Times of models.md section 13; ratios are given to three decimals.
    const std::vector<double> expected = {1.0,         0.34 / 0.33, 0.37 / 0.33, 0.53 / 0.33, 1.0,
                                          4.28 / 3.00, 1.0,         1.25 / 0.97, 1.0,         1.62 / 1.35,
                                          1.0,         7.17 / 6.87, 7.55 / 6.87, 7.82 / 6.87};
    const std::vector<DeckEntry> deck = deck_entries();
    ASSERT_EQ(deck.size(), expected.size());
    for (std::size_t i = 0; i < deck.size(); ++i) {
        EXPECT_NEAR(deck[i].ratio, expected[i], 5e-4) << deck[i].name;
        EXPECT_EQ(deck[i].row == deck[i].baseline_row, deck[i].name == deck[i].baseline) << deck[i].name;
    }
}

TEST(BenchRows, EveryRowOfTheDeckIsTimedAtItsSize) {
    const std::vector<std::string> keys = benchmark_keys({});
    for (const DeckEntry& entry : deck_entries()) {
        EXPECT_THAT(keys, Contains(entry.row + ".1280x720")) << entry.name;
        EXPECT_THAT(keys, Contains(entry.baseline_row + ".1280x720")) << entry.name;
    }
    EXPECT_THAT(keys, Contains(heaviest_row() + ".1280x720"));
    EXPECT_THAT(keys, Contains(heaviest_row() + ".3840x2160"));
}

TEST(BenchRows, RowsInTheStudioDifferInWhatTheirNamesSay) {
    const BenchRow single = find_row("shade.blinn_phong.lambert.constant_f0.environment");
    const BenchRow heaviest = find_row(heaviest_row());
    EXPECT_TRUE(single.scene.environment && heaviest.scene.environment);
    EXPECT_EQ(single.scene.lights, BenchLights::none);
    EXPECT_EQ(heaviest.scene.lights, BenchLights::distant1);
    const BoundMaterial& plain = single.scene.materials.at(0);
    const BoundMaterial& layered = heaviest.scene.materials.at(0);
    EXPECT_EQ(plain.layers.size(), 1U);
    ASSERT_EQ(layered.layers.size(), 2U);
    EXPECT_EQ(layered.layers[0].shininess.constant.r, 512.0);
    EXPECT_EQ(layered.absorption, AbsorptionModel::approximated);
    EXPECT_EQ(layered.base().f0.constant, plain.base().f0.constant);
    EXPECT_EQ(layered.base().shininess.planes, plain.base().shininess.planes);
    EXPECT_EQ(layered.albedo.planes, plain.albedo.planes);
    EXPECT_EQ(plain.diffuse, DiffuseModel::lambert);
    EXPECT_EQ(layered.diffuse, DiffuseModel::oren_nayar);
    // The limit "one environment to one light" is taken from this pair.
    ASSERT_EQ(single.baselines.size(), 1U);
    EXPECT_EQ(row_name(single.baselines[0].scenes.at(0)), "shade.blinn_phong.lambert.constant_f0.distant1");
}

/// A result that took that long, and so many times as long as another row.
BenchResult timed(const std::string& key, double milliseconds, const std::string& other = "", double ratio = 0.0) {
    BenchResult result;
    result.key = key;
    result.median_ms = milliseconds;
    if (!other.empty()) {
        RivalResult rival;
        rival.name = other;
        rival.ratio = ratio;
        result.against.push_back(rival);
    }
    return result;
}

TEST(SpeedLimits, AreJudgedOnWhatWasTimedAtTheDecksSize) {
    EXPECT_TRUE(judged_limits({}).empty());
    const std::string single = "shade.blinn_phong.lambert.constant_f0.environment.1280x720";
    const std::string light = "shade.blinn_phong.lambert.constant_f0.distant1.1280x720";
    const std::string dual = "shade.layers2.blinn_phong.lambert.constant.approximated.environment.1280x720";
    std::vector<BenchResult> results = {timed(single, 3.0, light, 2.4), timed(dual, 4.0, single, 1.31),
                                        timed(heaviest_row() + ".3840x2160", 30.0),
                                        timed("prefilter.1024x512.cached", 49.0)};
    const std::vector<SpeedLimit> limits = judged_limits(results);
    ASSERT_EQ(limits.size(), 3U);
    EXPECT_EQ(limits[0].limit, 2.5);
    EXPECT_EQ(limits[0].value, 2.4);
    EXPECT_TRUE(limits[0].met());
    EXPECT_EQ(limits[1].limit, 1.30);
    EXPECT_EQ(limits[1].value, 1.31);
    EXPECT_FALSE(limits[1].met());
    EXPECT_TRUE(limits[2].in_milliseconds);
    EXPECT_EQ(limits[2].limit, 50.0);
    EXPECT_EQ(limits[2].value, 49.0);
    results[0].status = BenchStatus::error;
    EXPECT_EQ(judged_limits(results).size(), 2U);
}

TEST(SpeedLimits, TheHeadlineIsTheDecksHeaviestRowAtItsSize) {
    EXPECT_FALSE(headline_of({timed(heaviest_row() + ".3840x2160", 30.0)}).has_value());
    const std::vector<BenchResult> results = {timed(heaviest_row() + ".1280x720", 5.0)};
    const auto headline = headline_of(results);
    ASSERT_TRUE(headline.has_value());
    EXPECT_EQ(headline->deck_ms, 7.82);
    EXPECT_EQ(headline->median_ms, 5.0);
    const std::vector<SpeedLimit> limits = judged_limits(results);
    ASSERT_EQ(limits.size(), 1U);
    EXPECT_EQ(limits[0].limit, 7.82);
    EXPECT_TRUE(limits[0].met());
}

TEST(SpeedLimits, TheFirstPrefilterCountsWithItsBuild) {
    BenchResult row = timed("prefilter.1024x512", 400.0);
    row.build_cold_ms = 2100.0;
    const std::vector<SpeedLimit> limits = judged_limits({row});
    ASSERT_EQ(limits.size(), 1U);
    EXPECT_EQ(limits[0].limit, 2000.0);
    EXPECT_EQ(limits[0].value, 2100.0);
    EXPECT_FALSE(limits[0].met());
}

TEST(BenchRows, LayersAreCountedFromOneToEight) {
    const std::vector<std::string> keys = benchmark_keys({});
    std::vector<int> layers;
    for (const LayerEntry& entry : layer_entries()) {
        layers.push_back(entry.layers);
        const auto row = find_row(entry.row);
        EXPECT_EQ(row.scene.materials.at(0).layers.size(), static_cast<std::size_t>(entry.layers)) << entry.row;
        EXPECT_THAT(keys, Contains(entry.row + ".3840x2160"));
    }
    EXPECT_THAT(layers, ElementsAre(1, 2, 4, 8));
}

TEST(BenchRows, EveryRowHasARivalThatMovesTheSameBytes) {
    for (const BenchRow& row : select_rows({})) {
        EXPECT_THAT(row.rivals, IsSupersetOf({Rival::stream_opencl, Rival::stream_cpp})) << row.key();
        const bool is_lambert = row.name == lambert_row(1, 1).name;
        EXPECT_EQ(row.baselines.size(), is_lambert ? 0U : 1U) << row.key();
    }
}

TEST(BenchRows, FourMaterialsAreMeasuredAgainstEachOfThemAlone) {
    for (const char* name : {"shade.mixed4.tiles.distant1", "shade.mixed4.scattered.distant1"}) {
        const BenchRow row = find_row(name);
        ASSERT_EQ(row.baselines.size(), 1U);
        EXPECT_EQ(row.baselines[0].name, "mean_alone");
        ASSERT_EQ(row.scene.materials.size(), 4U);
        ASSERT_EQ(row.baselines[0].scenes.size(), 4U);
        std::set<std::string> stacks;
        for (std::size_t i = 0; i < 4; ++i) {
            const BenchScene& alone = row.baselines[0].scenes[i];
            ASSERT_EQ(alone.materials.size(), 1U);
            EXPECT_EQ(model_key(alone.materials[0]), model_key(row.scene.materials[i]));
            stacks.insert(model_key(alone.materials[0]));
            // Each is a row of its own too.
            EXPECT_EQ(find_row(row_name(alone)).scene.lights, row.scene.lights);
        }
        EXPECT_EQ(stacks.size(), 4U) << "four different stacks";
    }
}

TEST(BenchFrame, HoldsPlausibleValuesAndDependsOnTheSeedAlone) {
    const Frame frame = make_bench_frame(200, 120, 3);
    double least_shininess = 1e9;
    double greatest_shininess = 0.0;
    std::set<float> ids;
    std::map<float, int> scattered;
    int repeated = 0;
    for (int y = 0; y < 120; ++y) {
        for (int x = 0; x < 200; ++x) {
            const glm::dvec3 normal(frame.planes.at(0, x, y), frame.planes.at(1, x, y), frame.planes.at(2, x, y));
            ASSERT_NEAR(glm::length(normal), 1.0, 1e-6);
            for (int p = 6; p < 12; ++p) {
                ASSERT_GE(frame.planes.at(p, x, y), 0.0F);
                ASSERT_LE(frame.planes.at(p, x, y), 1.0F);
            }
            least_shininess = std::min(least_shininess, static_cast<double>(frame.planes.at(12, x, y)));
            greatest_shininess = std::max(greatest_shininess, static_cast<double>(frame.planes.at(12, x, y)));
            ids.insert(frame.planes.at(13, x, y));
            ++scattered[frame.planes.at(14, x, y)];
            repeated += x > 0 && frame.planes.at(14, x, y) == frame.planes.at(14, x - 1, y) ? 1 : 0;
            // Tiles of 16 pixels have one id.
            ASSERT_EQ(frame.planes.at(13, x, y), frame.planes.at(13, x / 16 * 16, y / 16 * 16));
        }
    }
    EXPECT_GE(least_shininess, 8.0);
    EXPECT_LT(least_shininess, 32.0);
    EXPECT_GT(greatest_shininess, 128.0);
    EXPECT_LE(greatest_shininess, 256.0);
    EXPECT_THAT(ids, ElementsAre(1.0F, 2.0F, 3.0F, 4.0F));
    // Scattered ids: a quarter each, and a neighbour is the same one time in four. Of 24000 draws one standard
    // deviation is 67: 400 is six of them.
    EXPECT_THAT(scattered, ElementsAre(Pair(1.0F, IsNear(6000, 400)), Pair(2.0F, IsNear(6000, 400)),
                                       Pair(3.0F, IsNear(6000, 400)), Pair(4.0F, IsNear(6000, 400))));
    EXPECT_NEAR(repeated, 6000, 400);

    const auto bytes_of = [](const Frame& f) { return std::as_bytes(f.planes.all()); };
    const Frame again = make_bench_frame(200, 120, 3);
    const Frame other = make_bench_frame(200, 120, 4);
    EXPECT_EQ(std::memcmp(bytes_of(frame).data(), bytes_of(again).data(), bytes_of(frame).size()), 0);
    EXPECT_NE(std::memcmp(bytes_of(frame).data(), bytes_of(other).data(), bytes_of(frame).size()), 0);
}

TEST(BenchFrame, PositionsLieOnTheirPixelsRays) {
    const Frame frame = make_bench_frame(200, 120, 3);
    const View& view = frame.view;
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(199, 0), std::pair(57, 119)}) {
        const glm::dvec3 direction = view.direction + (x + 0.5) * view.direction_dx + (y + 0.5) * view.direction_dy;
        EXPECT_NEAR(glm::dot(direction, view.view_axis), 1.0, 1e-12);
        const glm::dvec3 seen(frame.planes.at(3, x, y), frame.planes.at(4, x, y), frame.planes.at(5, x, y));
        const glm::dvec3 on_ray = view.eye + direction * glm::dot(seen - view.eye, view.view_axis);
        EXPECT_NEAR(glm::distance(seen, on_ray), 0.0, 1e-5) << x << ", " << y;
    }
}

TEST(BenchFrame, AnEnvironmentComesAndGoesWithTheScene) {
    Frame frame = make_bench_frame(32, 16, 1);
    const BenchScene scene = find_row(heaviest_row()).scene;
    EXPECT_THROW(apply_scene(frame, scene), std::invalid_argument);
    BoundEnvironment studio;
    studio.intensity = {2.0, 2.0, 2.0};
    apply_scene(frame, scene, studio);
    ASSERT_TRUE(frame.environment.has_value());
    EXPECT_EQ(frame.environment->intensity, studio.intensity);
    EXPECT_EQ(frame.lights.size(), 1U);
    apply_scene(frame, {}, studio);
    EXPECT_FALSE(frame.environment.has_value());
    apply_scene(frame, {.lights = BenchLights::none});
    EXPECT_TRUE(frame.lights.empty());
}

TEST(BenchFrame, ScenesChangeLightsAndMaterialsOnly) {
    Frame frame = make_bench_frame(32, 16, 1);
    EXPECT_EQ(frame.lights.size(), 1U);
    EXPECT_EQ(frame.roles.material_id, no_plane);
    apply_scene(frame, {.lights = BenchLights::distant8});
    EXPECT_EQ(frame.lights.size(), 8U);
    const BenchScene tiles = find_row("shade.mixed4.tiles.distant1").scene;
    apply_scene(frame, tiles);
    ASSERT_EQ(frame.materials.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_THAT(frame.materials[i].ids, ElementsAre(static_cast<std::int64_t>(i) + 1));
    }
    EXPECT_EQ(frame.roles.material_id, 13);
    apply_scene(frame, find_row("shade.mixed4.scattered.distant1").scene);
    EXPECT_EQ(frame.roles.material_id, 14);
    apply_scene(frame, {});
    EXPECT_EQ(frame.materials.size(), 1U);
    EXPECT_EQ(frame.roles.material_id, no_plane);
}

} // namespace
} // namespace clshade
