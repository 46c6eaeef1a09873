// The part of reading an environment that touches image files.
#pragma once

#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"

#include <cstdint>
#include <filesystem>
#include <optional>

namespace clshade::cli {

struct EnvironmentFile {
    LatLong image;                   ///< without texels if there are maps
    std::optional<FilteredSet> maps; ///< of a folder that `prefilter` wrote
};

/// A lat-long picture or a set of maps. `max_memory` and `whole` as for read_lat_long. Throws RuntimeFailure; in builds
/// without image files UsageError.
[[nodiscard]] EnvironmentFile read_environment_file(const std::filesystem::path& path, std::uint64_t max_memory,
                                                    bool whole);

} // namespace clshade::cli
