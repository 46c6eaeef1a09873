// Known errors put into a copy of the reference are found, counted and placed.
#include "host/reference/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace clshade::reference {
namespace {

constexpr int width = 40;
constexpr int height = 25; // 1000 pixels

/// A reference of 1, 2, 4 in R, G, B (exact in float) and the same on the device.
struct Pair {
    Image reference;
    PlaneSlab device{width, height, 4};
    Pair() {
        reference.width = width;
        reference.height = height;
        for (int p = 0; p < 4; ++p) {
            const double value = p < 3 ? std::exp2(p) : 1.0;
            reference.planes.emplace_back(std::size_t{width} * height, value);
            for (int y = 0; y < height; ++y) {
                for (float& v : device.row(p, y)) {
                    v = static_cast<float>(value);
                }
            }
        }
    }
    [[nodiscard]] Comparison run(const Tolerance& tolerance, std::span<const std::uint8_t> selected = {}) const {
        return compare(device, reference, {}, tolerance, selected);
    }
};

TEST(Compare, EqualPlanesHaveNoError) {
    const Comparison c = Pair().run(Tolerance::plain(0.0, 0.0, 100.0));
    EXPECT_EQ(c.pixels, 1000U);
    EXPECT_EQ(c.max_rel, 0.0);
    EXPECT_EQ(c.max_abs, 0.0);
    EXPECT_EQ(c.max_ulp, 0.0);
    EXPECT_EQ(c.outside, 0U);
    EXPECT_TRUE(passes(c, Tolerance::plain(0.0, 0.0, 100.0)));
}

TEST(Compare, FindsOneError) {
    Pair pair;
    pair.device.at(1, 17, 9) = 2.0F * (1.0F + 0x1p-10F);
    const Tolerance tolerance = Tolerance::plain(1e-5, 1e-7, 99.9);
    const Comparison c = pair.run(tolerance);
    EXPECT_DOUBLE_EQ(c.max_rel, 0x1p-10);
    EXPECT_DOUBLE_EQ(c.max_abs, 0x1p-9);
    EXPECT_DOUBLE_EQ(c.rms_rel, 0x1p-10 / std::sqrt(3000.0));
    EXPECT_DOUBLE_EQ(c.rms_abs, 0x1p-9 / std::sqrt(3000.0));
    EXPECT_EQ(c.max_ulp, 8192.0); // 2^-10 of 2^23 floats in the octave
    EXPECT_EQ(c.p50_rel, 0.0);
    EXPECT_EQ(c.p999_rel, 0.0);
    EXPECT_DOUBLE_EQ(c.p9999_rel, 0x1p-10);
    EXPECT_EQ(c.outside, 1U);
    EXPECT_EQ(c.worst.x, 17);
    EXPECT_EQ(c.worst.y, 9);
    EXPECT_EQ(c.worst.channel, 1);
    EXPECT_EQ(c.worst.reference, 2.0);
    EXPECT_DOUBLE_EQ(c.worst.device, 2.0 * (1.0 + 0x1p-10));
    EXPECT_DOUBLE_EQ(c.worst.share, 0x1p-9 / (2e-5 + 1e-7));
    EXPECT_TRUE(passes(c, tolerance)); // one in 1000
    EXPECT_FALSE(passes(c, Tolerance::plain(1e-5, 1e-7, 99.99)));
}

TEST(Compare, PercentilesFollowTheRanks) {
    // Errors of 1, 2, ..., 1000 units in R.
    Pair pair;
    for (int i = 0; i < 1000; ++i) {
        pair.device.at(0, i % width, i / width) = 1.0F + static_cast<float>(i + 1) * 0x1p-20F;
    }
    const Comparison c = pair.run(Tolerance::plain(500.5 * 0x1p-20, 0.0, 50.0));
    EXPECT_DOUBLE_EQ(c.p50_rel, 500.0 * 0x1p-20);
    EXPECT_DOUBLE_EQ(c.p99_rel, 990.0 * 0x1p-20);
    EXPECT_DOUBLE_EQ(c.p999_rel, 999.0 * 0x1p-20);
    EXPECT_DOUBLE_EQ(c.p9999_rel, 1000.0 * 0x1p-20);
    EXPECT_DOUBLE_EQ(c.max_rel, 1000.0 * 0x1p-20);
    EXPECT_EQ(c.outside, 500U);
    EXPECT_TRUE(passes(c, Tolerance::plain(0.0, 0.0, 50.0)));
    EXPECT_FALSE(passes(c, Tolerance::plain(0.0, 0.0, 50.1)));
}

TEST(Compare, LooksAtSelectedPixelsOnly) {
    Pair pair;
    pair.device.at(0, 3, 2) = 1.5F;
    std::vector<std::uint8_t> selected(1000, 1);
    selected[2 * width + 3] = 0;
    const Comparison without = pair.run(Tolerance::plain(0.0, 0.0, 100.0), selected);
    EXPECT_EQ(without.pixels, 999U);
    EXPECT_EQ(without.max_rel, 0.0);
    std::vector<std::uint8_t> only(1000, 0);
    only[2 * width + 3] = 1;
    const Comparison with = pair.run(Tolerance::plain(0.0, 0.0, 100.0), only);
    EXPECT_EQ(with.pixels, 1U);
    EXPECT_EQ(with.max_rel, 0.5);
}

TEST(Compare, NothingComparedDoesNotPass) {
    const std::vector<std::uint8_t> none(1000, 0);
    const Comparison c = Pair().run(Tolerance::plain(1.0, 1.0, 0.0), none);
    EXPECT_EQ(c.pixels, 0U);
    EXPECT_EQ(c.worst.x, -1);
    EXPECT_FALSE(passes(c, Tolerance::plain(1.0, 1.0, 0.0)));
}

TEST(Compare, NonFiniteDeviceValueIsAnInfiniteError) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Pair pair;
        pair.device.at(2, 1, 1) = bad;
        Tolerance tolerance = Tolerance::plain(1e30, 1e30, 0.0);
        tolerance.hard = 1e30;
        const Comparison c = pair.run(tolerance);
        EXPECT_EQ(c.outside, 1U);
        EXPECT_EQ(c.beyond_hard, 1U);
        EXPECT_TRUE(std::isinf(c.max_abs));
        EXPECT_FALSE(passes(c, tolerance));
    }
}

TEST(Compare, DarkChannelsCountAbsolutelyOnly) {
    Pair pair;
    pair.reference.planes[0][0] = 1e-8;
    pair.device.at(0, 0, 0) = 2e-8F;
    const Comparison c = pair.run(Tolerance::plain(1e-5, 1e-7, 100.0));
    EXPECT_EQ(c.max_rel, 0.0);
    EXPECT_EQ(c.max_ulp, 0.0);
    EXPECT_NEAR(c.max_abs, 1e-8, 1e-14);
    EXPECT_EQ(c.outside, 0U);
}

TEST(Compare, HardLimitHoldsForEveryPixel) {
    Pair pair;
    pair.device.at(0, 5, 5) = 1.0F + 0x1p-12F;
    Tolerance tolerance = Tolerance::plain(0x1p-14, 0.0, 50.0);
    tolerance.hard = 5.0;
    EXPECT_TRUE(passes(pair.run(tolerance), tolerance)); // four times the tolerance, in one pixel
    tolerance.hard = 3.0;
    EXPECT_EQ(pair.run(tolerance).beyond_hard, 1U);
    EXPECT_FALSE(passes(pair.run(tolerance), tolerance));
}

TEST(Compare, AllowsForLightLevelAndRounding) {
    Pair pair;
    pair.device.at(1, 0, 0) = 2.0F + 0x1p-10F;
    RoundingScale scale;
    scale.irradiance.assign(1000, 0.0);
    scale.shift.fill(std::vector<double>(1000, 0.0));
    Tolerance tolerance;
    tolerance.per_irradiance = 1e-6;
    tolerance.per_roundoff = 3.0;
    const auto outside = [&] { return compare(pair.device, pair.reference, scale, tolerance).outside; };
    EXPECT_EQ(outside(), 1U);
    scale.irradiance[0] = 1001.0;
    EXPECT_EQ(outside(), 0U);
    scale.irradiance[0] = 0.0;
    scale.shift[0][0] = 1.0; // another channel's
    EXPECT_EQ(outside(), 1U);
    scale.shift[1][0] = 0x1p-10 / 2.9;
    EXPECT_EQ(outside(), 0U);
    scale.shift[1][0] = 0x1p-10 / 3.1;
    EXPECT_EQ(outside(), 1U);
}

TEST(Compare, OtherPlanes) {
    Pair pair;
    pair.device.at(3, 7, 7) = 0.5F;
    const Tolerance tolerance = Tolerance::plain(1e-6, 0.0, 100.0);
    EXPECT_EQ(compare(pair.device, pair.reference, {}, tolerance).outside, 0U);
    const Comparison alpha = compare(pair.device, pair.reference, {}, tolerance, {}, 3, 1);
    EXPECT_EQ(alpha.outside, 1U);
    EXPECT_EQ(alpha.max_abs, 0.5);
}

TEST(UlpDistance, CountsFloats) {
    EXPECT_EQ(ulp_distance(1.0F, 1.0F), 0.0);
    EXPECT_EQ(ulp_distance(1.0F, std::nextafter(1.0F, 2.0F)), 1.0);
    EXPECT_EQ(ulp_distance(1.0F, std::nextafter(1.0F, 0.0F)), 1.0);
    EXPECT_EQ(ulp_distance(0.0F, -0.0F), 0.0);
    EXPECT_EQ(ulp_distance(std::numeric_limits<float>::denorm_min(), -std::numeric_limits<float>::denorm_min()), 2.0);
    EXPECT_EQ(ulp_distance(1.0F, 2.0F), 0x1p23);
    EXPECT_TRUE(std::isinf(ulp_distance(1.0F, std::numeric_limits<float>::quiet_NaN())));
}

} // namespace
} // namespace clshade::reference
