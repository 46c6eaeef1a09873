// Order statistics and paired ratios on numbers worked out by hand.
#include "bench/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

namespace clshade {
namespace {

TEST(Statistics, MedianOfOddAndEvenCounts) {
    EXPECT_DOUBLE_EQ(median(std::array{3.0, 1.0, 2.0}), 2.0);
    EXPECT_DOUBLE_EQ(median(std::array{4.0, 1.0, 3.0, 2.0}), 2.5);
    EXPECT_DOUBLE_EQ(median(std::array{7.0}), 7.0);
}

TEST(Statistics, PercentileIsLinearBetweenRanks) {
    const std::array values{50.0, 10.0, 20.0, 40.0, 30.0};
    EXPECT_DOUBLE_EQ(percentile(values, 0.0), 10.0);
    EXPECT_DOUBLE_EQ(percentile(values, 100.0), 50.0);
    EXPECT_DOUBLE_EQ(percentile(values, 25.0), 20.0);
    EXPECT_DOUBLE_EQ(percentile(values, 90.0), 46.0); // rank 3.6
}

TEST(Statistics, SpreadIsTheMiddleFourFifthsOverTheMedian) {
    EXPECT_DOUBLE_EQ(spread(std::array{10.0, 20.0, 30.0, 40.0, 50.0}), (46.0 - 14.0) / 30.0);
    EXPECT_DOUBLE_EQ(spread(std::array{2.0, 2.0, 2.0}), 0.0);
}

TEST(Statistics, OneOutlierMovesNeitherMedianNorRatio) {
    EXPECT_DOUBLE_EQ(median(std::array{1.0, 1.0, 1.0, 1.0, 900.0}), 1.0);
    EXPECT_DOUBLE_EQ(paired_ratio(std::array{2.0, 2.0, 900.0}, std::array{1.0, 1.0, 1.0}), 2.0);
}

TEST(Statistics, RatioIsPairedByRounds) {
    // The machine becomes three times slower from round to round: the ratio of medians would say 2 / 3, pairs say 2.
    EXPECT_DOUBLE_EQ(paired_ratio(std::array{2.0, 6.0, 18.0}, std::array{1.0, 3.0, 9.0}), 2.0);
    EXPECT_DOUBLE_EQ(paired_ratio(std::array{1.0, 4.0, 9.0}, std::array{1.0, 1.0, 1.0}), 4.0);
}

TEST(Statistics, RatioWithARivalOfFewerRoundsUsesTheSharedOnes) {
    EXPECT_DOUBLE_EQ(paired_ratio(std::array{1.0, 1.0, 100.0, 100.0}, std::array{4.0, 2.0}), 0.375);
    EXPECT_DOUBLE_EQ(paired_ratio(std::array{4.0, 2.0}, std::array{1.0, 1.0, 100.0, 100.0}), 3.0);
}

TEST(Statistics, TheMeanIsTakenRoundByRound) {
    const std::array a{1.0, 4.0, 90.0};
    const std::array b{3.0, 8.0, 10.0, 77.0};
    const std::array<std::span<const double>, 2> contestants{a, b};
    EXPECT_EQ(mean_by_rounds(contestants), (std::vector<double>{2.0, 6.0, 50.0}));
    // The machine becomes slower from round to round, the ratio to the mean stays.
    EXPECT_DOUBLE_EQ(paired_ratio(std::array{4.0, 12.0, 100.0}, mean_by_rounds(contestants)), 2.0);
    EXPECT_THROW((void)mean_by_rounds({}), std::invalid_argument);
}

TEST(Statistics, NothingIsNoNumber) {
    EXPECT_THROW((void)median({}), std::invalid_argument);
    EXPECT_THROW((void)paired_ratio({}, std::array{1.0}), std::invalid_argument);
}

} // namespace
} // namespace clshade
