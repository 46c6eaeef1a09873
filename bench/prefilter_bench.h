// Timing the pre-filter.
//
// What is timed is the whole of Prefilter::filter by a clock on the host: hashing the picture, halving it, the kernels,
// sums on the host, storing the result on disk; from a cache that has the program but not the result, which a user
// meets with every new environment. build_cold_ms is the same with an empty cache, the compiler's work included, and
// build_cached_ms, like the rows `cached`, the same when the cache has the result. The rival (prefilter_rival.h) has
// neither hash nor file. Both are checked against the reference's sums in double precision at sampled vertices of every
// map before anything is timed, so that both are known to be equally right.
#pragma once

#include "bench/benchmark.h"
#include "bench/prefilter_rows.h"
#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"

#include <functional>
#include <string>
#include <vector>

namespace clshade {

/// What is allowed, on either side: direct sums in single precision reach 1e-5, one that lost a sun or a row is off by
/// far more.
inline constexpr double prefilter_tolerance = 1e-4;

/// Largest |a - b| / (largest of the three channels of b) over R, G, B at 32 vertices of each level and of the
/// irradiance map: a the set's, b the reference's. NaN counts as infinite.
[[nodiscard]] double prefilter_error(const FilteredSet& set, const LatLong& image);

/// One result per row, in their order; a row that fails has status error and the reason. `tell` is called before each
/// environment.
[[nodiscard]] std::vector<BenchResult> run_prefilter_rows(Device& device, const BenchOptions& options,
                                                          const std::vector<PrefilterRow>& rows,
                                                          const std::function<void(const std::string& what)>& tell);

} // namespace clshade
