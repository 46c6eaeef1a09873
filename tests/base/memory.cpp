#include "host/base/aligned_buffer.h"
#include "host/base/error.h"
#include "host/base/plane_slab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace clshade {
namespace {

bool all_zero(std::span<const float> values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return v == 0.0F; });
}

TEST(AlignedBuffer, IsPageAlignedAndZero) {
    const AlignedBuffer buffer(1000);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % 4096, 0U);
    EXPECT_EQ(buffer.size(), 1000U);
    EXPECT_TRUE(all_zero(buffer.span()));
}

TEST(AlignedBuffer, MovesItsMemory) {
    AlignedBuffer first(16);
    first.span()[3] = 7.0F;
    const float* place = first.data();
    AlignedBuffer second(std::move(first));
    EXPECT_EQ(second.data(), place);
    AlignedBuffer third;
    third = std::move(second);
    EXPECT_EQ(third.data(), place);
    EXPECT_EQ(third.span()[3], 7.0F);
    EXPECT_EQ(third.size(), 16U);
}

TEST(AlignedBuffer, EmptyOwnsNothing) {
    const AlignedBuffer buffer(0);
    EXPECT_EQ(buffer.data(), nullptr);
    EXPECT_TRUE(buffer.span().empty());
}

TEST(AlignedBuffer, RefusesWhatCannotBeAddressed) {
    EXPECT_THROW(AlignedBuffer(std::numeric_limits<std::size_t>::max() / 2), RuntimeFailure);
}

TEST(PlaneSlab, PadsRowsAndPlanes) {
    const PlaneSlab slab(17, 3, 2);
    EXPECT_EQ(slab.pitch(), 32);
    EXPECT_EQ(slab.padded_pixels(), 1024U); // 96 rounded up
    EXPECT_EQ(slab.stride(), 1024U + plane_skew);
    EXPECT_EQ(slab.all().size(), 2 * slab.stride());
    EXPECT_TRUE(all_zero(slab.all()));
}

TEST(PlaneSlab, EveryRowStartsOnACacheLine) {
    PlaneSlab slab(37, 5, 3);
    for (int p = 0; p < slab.count(); ++p) {
        for (int y = 0; y < slab.height(); ++y) {
            EXPECT_EQ(reinterpret_cast<std::uintptr_t>(slab.row(p, y).data()) % 64, 0U) << p << ' ' << y;
        }
    }
}

TEST(PlaneSlab, PixelsLieWhereTheHeaderSays) {
    PlaneSlab slab(20, 4, 3);
    slab.at(2, 19, 3) = 5.0F;
    EXPECT_EQ(slab.all()[2 * slab.stride() + 115], 5.0F);
    EXPECT_EQ(slab.plane(2)[115], 5.0F); // 3 * 32 + 19
    EXPECT_EQ(std::as_const(slab).row(2, 3)[19], 5.0F);
    EXPECT_EQ(std::count(slab.all().begin(), slab.all().end(), 0.0F),
              static_cast<std::ptrdiff_t>(slab.all().size()) - 1);
}

TEST(PlaneSlab, RefusesEmptyImages) {
    EXPECT_THROW(PlaneSlab(0, 4, 1), RuntimeFailure);
    EXPECT_THROW(PlaneSlab(4, -1, 1), RuntimeFailure);
    EXPECT_THROW(PlaneSlab(4, 4, -1), RuntimeFailure);
    EXPECT_EQ(PlaneSlab(4, 4, 0).count(), 0);
}

TEST(Error, CarriesTheExitCodeOfItsFamily) {
    EXPECT_EQ(static_cast<int>(RuntimeFailure("x").exit_code()), 1);
    EXPECT_EQ(static_cast<int>(UsageError("x").exit_code()), 2);
    EXPECT_EQ(static_cast<int>(DeviceError("x").exit_code()), 5);
    EXPECT_STREQ(UsageError("scene.toml:1:1: wrong; do it right").what(), "scene.toml:1:1: wrong; do it right");
}

} // namespace
} // namespace clshade
