// What `bench --tune` measured: the best vector width per device and driver, kept beside the program cache.
#pragma once

#include "host/device/device.h"

#include <filesystem>
#include <optional>

namespace clshade::cli {

/// $XDG_CACHE_HOME/clshade/lanes.json, else in ~/.cache; empty where no folder can be had.
[[nodiscard]] std::filesystem::path lane_store_file();
/// The stored width. Absent, unreadable and doubtful entries all mean "not tuned".
[[nodiscard]] std::optional<int> stored_lanes(const DeviceInfo& device);
/// Stores it and keeps what other devices have. Throws RuntimeFailure if that cannot be done.
void store_lanes(const DeviceInfo& device, int lanes);

} // namespace clshade::cli
