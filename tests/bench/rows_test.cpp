// Which rows there are, what they are called and how they are chosen; what the bench frame holds.
#include "bench/bench_frame.h"
#include "bench/bench_rows.h"
#include "bench/benchmark.h"
#include "host/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>

namespace clshade {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(BenchRows, KeysAreStable) {
    // A baseline file names them: adding is fine, renaming is not.
    EXPECT_THAT(
        benchmark_keys({}),
        ElementsAre("shade.blinn_phong.lambert.distant1.3840x2160", "shade.blinn_phong.lambert.distant1.1280x720",
                    "shade.blinn_phong.lambert.distant8.1280x720", "shade.blinn_phong.lambert.point1.1280x720",
                    "shade.blinn_phong.lambert.spot1.1280x720", "shade.blinn_phong.oren_nayar.distant1.1280x720",
                    "shade.blinn_phong.oren_nayar_full.distant1.1280x720",
                    "shade.blinn_phong.oren_nayar_qualitative.distant1.1280x720",
                    "shade.blinn_phong.oren_nayar_simplified_1.distant1.1280x720",
                    "shade.blinn_phong.oren_nayar_simplified_2.distant1.1280x720",
                    "shade.blinn_phong.oren_nayar_shininess.distant1.1280x720",
                    "shade.blinn_phong_exact.lambert.distant1.1280x720", "shade.mixed4.distant1.1280x720"));
}

TEST(BenchRows, TheFilterSearchesTheKey) {
    BenchOptions options;
    options.filter = "oren_nayar\\.";
    EXPECT_THAT(benchmark_keys(options), ElementsAre("shade.blinn_phong.oren_nayar.distant1.1280x720"));
    options.filter = "3840";
    EXPECT_THAT(benchmark_keys(options), ElementsAre("shade.blinn_phong.lambert.distant1.3840x2160"));
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
    EXPECT_TRUE(std::all_of(keys.begin(), keys.end(), [](const std::string& key) { return key.ends_with(".64x32"); }));
    options.height = 0;
    EXPECT_THROW((void)benchmark_keys(options), UsageError);
}

TEST(BenchRows, TheLambertRowMeetsEveryRival) {
    EXPECT_THAT(lambert_row(64, 32).rivals, ElementsAre(Rival::stream_opencl, Rival::stream_cpp, Rival::openmp_simd,
                                                        Rival::hand_simd, Rival::naive_opencl, Rival::reference));
    EXPECT_EQ(lambert_row(64, 32).key(), "shade.blinn_phong.lambert.distant1.64x32");
}

TEST(BenchRows, DeckRatiosAreThoseOfTheDeck) {
    const std::vector<DeckEntry> deck = deck_entries();
    ASSERT_EQ(deck.size(), 4U);
    EXPECT_DOUBLE_EQ(deck[0].ratio, 1.289); // 1.25 ms / 0.97 ms, models.md section 13
    EXPECT_NEAR(deck[0].ratio, 1.25 / 0.97, 5e-4);
    EXPECT_NEAR(deck[1].ratio, 0.34 / 0.33, 5e-4);
    EXPECT_NEAR(deck[2].ratio, 0.37 / 0.33, 5e-4);
    EXPECT_NEAR(deck[3].ratio, 0.53 / 0.33, 5e-4);
    for (const DeckEntry& entry : deck) {
        EXPECT_NE(entry.row.empty(), entry.reason.empty()) << entry.name;
    }
}

TEST(BenchFrame, HoldsPlausibleValuesAndDependsOnTheSeedAlone) {
    const Frame frame = make_bench_frame(200, 120, 3);
    double least_shininess = 1e9;
    double greatest_shininess = 0.0;
    std::set<float> ids;
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
            // Tiles of 16 pixels have one id.
            ASSERT_EQ(frame.planes.at(13, x, y), frame.planes.at(13, x / 16 * 16, y / 16 * 16));
        }
    }
    EXPECT_GE(least_shininess, 8.0);
    EXPECT_LT(least_shininess, 32.0);
    EXPECT_GT(greatest_shininess, 128.0);
    EXPECT_LE(greatest_shininess, 256.0);
    EXPECT_THAT(ids, ElementsAre(1.0F, 2.0F, 3.0F, 4.0F));

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

TEST(BenchFrame, ScenesChangeLightsAndMaterialsOnly) {
    Frame frame = make_bench_frame(32, 16, 1);
    EXPECT_EQ(frame.lights.size(), 1U);
    EXPECT_EQ(frame.roles.material_id, no_plane);
    apply_scene(frame, {.lights = BenchLights::distant8});
    EXPECT_EQ(frame.lights.size(), 8U);
    apply_scene(frame, {.mixed = true});
    EXPECT_EQ(frame.materials.size(), 4U);
    EXPECT_EQ(frame.roles.material_id, 13);
    apply_scene(frame, {});
    EXPECT_EQ(frame.materials.size(), 1U);
    EXPECT_EQ(frame.roles.material_id, no_plane);
}

} // namespace
} // namespace clshade
