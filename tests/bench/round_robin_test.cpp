// Contestants take turns, slow ones fewer, failing ones drop out, and a slower one is found slower.
#include "bench/round_robin.h"
#include "bench/statistics.h"
#include "bench/worker_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace clshade {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

RoundSettings rounds(int warm_up, int count, int slow) {
    RoundSettings settings;
    settings.warm_up = warm_up;
    settings.rounds = count;
    settings.seconds = 0.0;
    settings.slow_rounds = slow;
    return settings;
}

Contestant noting(std::string& order, char mark, bool slow = false) {
    return {std::string(1, mark),
            [&order, mark] {
                order += mark;
                return 1.0;
            },
            slow};
}

TEST(RoundRobin, ContestantsRunInTurns) {
    std::string order;
    const auto timings = run_round_robin({noting(order, 'a'), noting(order, 'b'), noting(order, 'c')}, rounds(2, 3, 1));
    ASSERT_EQ(order.size(), 15U);
    EXPECT_EQ(order.substr(0, 6), "abcabc");                        // warm-up
    for (std::size_t round = 6; round < order.size(); round += 3) { // each round everybody, in any order
        EXPECT_THAT(order.substr(round, 3), testing::UnorderedElementsAre('a', 'b', 'c'));
    }
    for (const Timings& each : timings) {
        EXPECT_THAT(each.milliseconds, SizeIs(3));
    }
}

TEST(RoundRobin, SlowContestantsWarmUpOnceAndRunInTheFirstRounds) {
    std::string order;
    const auto timings = run_round_robin({noting(order, 'a'), noting(order, 'S', true)}, rounds(2, 3, 2));
    EXPECT_EQ(order.substr(0, 3), "aSa"); // warm-up
    EXPECT_THAT(order.substr(3), testing::UnorderedElementsAre('a', 'S', 'a', 'S', 'a'));
    EXPECT_THAT(timings[0].milliseconds, SizeIs(3));
    EXPECT_THAT(timings[1].milliseconds, SizeIs(2));
}

TEST(RoundRobin, AFailingContestantDropsOutAndTellsWhy) {
    std::string order;
    int left = 2;
    const Contestant failing{"failing", [&left] {
                                 if (left-- == 0) {
                                     throw std::runtime_error("the device is gone");
                                 }
                                 return 1.0;
                             }};
    const auto timings = run_round_robin({failing, noting(order, 'a')}, rounds(0, 5, 1));
    EXPECT_THAT(timings[0].error, HasSubstr("the device is gone"));
    EXPECT_THAT(timings[0].milliseconds, SizeIs(2));
    EXPECT_EQ(order, "aaaaa");
    EXPECT_TRUE(timings[1].error.empty());
}

TEST(RoundRobin, GoesOnUntilTheTimeIsSpent) {
    RoundSettings settings = rounds(0, 1, 1);
    settings.seconds = 0.05;
    const auto start = std::chrono::steady_clock::now();
    std::string order;
    const auto timings = run_round_robin({noting(order, 'a')}, settings);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    EXPECT_TRUE(spent.count() >= 0.05 ||
                timings[0].milliseconds.size() == static_cast<std::size_t>(settings.max_rounds));
    EXPECT_GT(timings[0].milliseconds.size(), 1U);
}

/// Adds up `count` numbers so that the compiler must do it.
double add_up(std::size_t count) {
    std::atomic<double> sum{0.0};
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) {
        sum.store(sum.load(std::memory_order_relaxed) + 1.0, std::memory_order_relaxed);
    }
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

TEST(RoundRobin, AContestantWithMoreWorkIsFoundSlower) {
    const Contestant quick{"quick", [] { return add_up(100'000); }};
    const Contestant slower{"slower", [] { return add_up(400'000); }};
    const auto timings = run_round_robin({quick, slower}, rounds(1, 21, 1));
    // Four times the work; a median over 21 pairs stays above 2 on a busy machine too.
    EXPECT_GT(paired_ratio(timings[1].milliseconds, timings[0].milliseconds), 2.0);
    EXPECT_LT(paired_ratio(timings[0].milliseconds, timings[1].milliseconds), 0.5);
}

TEST(WorkerPool, EveryItemIsWorkedOnOnce) {
    for (const int threads : {1, 2, 5}) {
        WorkerPool pool(threads);
        EXPECT_EQ(pool.threads(), threads);
        std::vector<int> touched(10'000, 0);
        for (int run = 0; run < 20; ++run) {
            const double milliseconds = pool.run(touched.size(), 333, [&touched](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    ++touched[i];
                }
            });
            EXPECT_GT(milliseconds, 0.0);
        }
        EXPECT_THAT(touched, Each(20)) << threads << " threads";
    }
}

} // namespace
} // namespace clshade
