// Order statistics of timings, and ratios paired by rounds.
#pragma once

#include <span>
#include <vector>

namespace clshade {

/// The p-th percentile, p in [0, 100], linear between the two nearest ranks (0: minimum, 100: maximum).
/// Throws std::invalid_argument for no values.
[[nodiscard]] double percentile(std::span<const double> values, double p);

/// The 50th percentile.
[[nodiscard]] double median(std::span<const double> values);

/// (90th - 10th percentile) / median: what the middle four fifths of the rounds scatter by.
[[nodiscard]] double spread(std::span<const double> values);

/// Median over the rounds of ours[i] / theirs[i]. Rounds that only one of the two took part in are left out: they are
/// counted from the first round on. Throws std::invalid_argument when no round is shared.
[[nodiscard]] double paired_ratio(std::span<const double> ours, std::span<const double> theirs);

/// Mean of several contestants inside each round, over the rounds that all of them have. Throws std::invalid_argument
/// for no contestants.
[[nodiscard]] std::vector<double> mean_by_rounds(std::span<const std::span<const double>> contestants);

} // namespace clshade
