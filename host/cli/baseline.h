// Comparing a benchmark with an earlier report (`bench --compare`).
#pragma once

#include "bench/benchmark.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <string>

namespace clshade::cli {

struct Baseline {
    std::string file;
    std::string device;
    std::map<std::string, double> median_ms; ///< by kernel key; rows that were ok only
};

/// Reads a report that `bench --json` wrote; keys it does not know are ignored. Throws RuntimeFailure if the file
/// cannot be read or is no such report.
[[nodiscard]] Baseline read_baseline(const std::filesystem::path& file);

struct BaselineComparison {
    std::string text; ///< table for the terminal
    nlohmann::json json;
    int regressed = 0; ///< rows that are slower by more than the limit
};

/// Rows of either side that the other lacks are listed and fail nothing. Throws UsageError if no row is in both.
[[nodiscard]] BaselineComparison compare_with(const Baseline& baseline, const BenchReport& bench,
                                              double regress_percent);

} // namespace clshade::cli
