// Rows of pre-filtering: which environments, and whether from nothing or from the cache.
#pragma once

#include "bench/benchmark.h"

#include <string>
#include <vector>

namespace clshade {

struct PrefilterRow {
    int width = 0; ///< of the environment
    int height = 0;
    bool cached = false; ///< the result lies in the cache

    /// "prefilter.1024x512", "prefilter.1024x512.cached"
    [[nodiscard]] std::string key() const;
};

/// All rows that the filter of the options chooses. A picture's size does not change them; `quick` makes the
/// environments small. Throws UsageError as select_rows does.
[[nodiscard]] std::vector<PrefilterRow> select_prefilter_rows(const BenchOptions& options);

} // namespace clshade
