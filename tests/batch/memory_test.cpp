// Memory that goes from frame to frame, and what frames take.
#include "host/batch/memory.h"
#include "host/batch/slab_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace clshade {
namespace {

TEST(SlabPool, GivesBackWhatFits) {
    SlabPool pool;
    EXPECT_EQ(pool.take(32, 4, 2).count(), 0);
    PlaneSlab slab(32, 4, 2);
    const float* memory = slab.data();
    pool.give(std::move(slab));
    pool.give(PlaneSlab(32, 4, 5)); // inputs and outputs of one picture
    EXPECT_EQ(pool.take(32, 4, 3).count(), 0);
    EXPECT_EQ(pool.take(32, 4, 2).data(), memory);
    EXPECT_EQ(pool.take(32, 4, 2).count(), 0) << "given away";
    EXPECT_EQ(pool.take(32, 4, 5).count(), 5);
}

TEST(SlabPool, ForgetsOtherShapes) {
    SlabPool pool;
    pool.give(PlaneSlab(32, 4, 2));
    pool.give(PlaneSlab(64, 4, 2));
    EXPECT_EQ(pool.take(32, 4, 2).count(), 0);
    pool.clear();
    EXPECT_EQ(pool.take(64, 4, 2).count(), 0);
    pool.give(PlaneSlab());
    EXPECT_EQ(pool.take(0, 0, 0).count(), 0);
}

TEST(Memory, OfAFrame) {
    // 100 pixels take 112 floats; 10 planes read, 4 written and packed: 18 in all.
    EXPECT_EQ(band_memory(100, 10, 4, 50), 112U * 50U * 18U * 4U);
    FramePlan plan;
    plan.frame.data_window = {10, 20, 109, 69};
    plan.channels = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    EXPECT_EQ(frame_memory(plan, 4), band_memory(100, 10, 4, 50));
    plan.keep = {3};
    EXPECT_EQ(frame_memory(plan, 4), band_memory(100, 10, 5, 50));
}

TEST(Memory, OfTheProcessAndTheMachine) {
    const std::uint64_t before = resident_memory();
    EXPECT_GT(before, 0U);
    PlaneSlab slab(4096, 1024, 4); // 64 MiB, resident once they are touched
    std::fill(slab.all().begin(), slab.all().end(), 1.0F);
    EXPECT_GT(resident_memory(), before + (60U << 20U));
    EXPECT_GT(machine_memory(), resident_memory());
}

} // namespace
} // namespace clshade
