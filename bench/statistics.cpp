#include "bench/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace clshade {

double percentile(std::span<const double> values, double p) {
    if (values.empty()) {
        throw std::invalid_argument("a percentile of no values");
    }
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const double rank = std::clamp(p, 0.0, 100.0) / 100.0 * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(std::floor(rank));
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

double median(std::span<const double> values) {
    return percentile(values, 50.0);
}

double spread(std::span<const double> values) {
    return (percentile(values, 90.0) - percentile(values, 10.0)) / median(values);
}

double paired_ratio(std::span<const double> ours, std::span<const double> theirs) {
    const std::size_t shared = std::min(ours.size(), theirs.size());
    std::vector<double> ratios;
    ratios.reserve(shared);
    for (std::size_t i = 0; i < shared; ++i) {
        ratios.push_back(ours[i] / theirs[i]);
    }
    if (ratios.empty()) {
        throw std::invalid_argument("a ratio of no rounds");
    }
    return median(ratios);
}

std::vector<double> mean_by_rounds(std::span<const std::span<const double>> contestants) {
    if (contestants.empty()) {
        throw std::invalid_argument("a mean of no contestants");
    }
    std::size_t shared = contestants.front().size();
    for (const std::span<const double> each : contestants) {
        shared = std::min(shared, each.size());
    }
    std::vector<double> means(shared, 0.0);
    for (const std::span<const double> each : contestants) {
        for (std::size_t i = 0; i < shared; ++i) {
            means[i] += each[i] / static_cast<double>(contestants.size());
        }
    }
    return means;
}

} // namespace clshade
