// Environments of the benches: the studio that rows stand in, and pictures to pre-filter.
#pragma once

#include "host/device/device.h"
#include "host/environment/lat_long.h"
#include "host/gbuffer/frame.h"

#include <cstdint>
#include <filesystem>
#include <optional>

namespace clshade {

/// The built-in studio as the environment of a bench frame. One for all rows and sizes, so that it is filtered once by
/// either side. Refers to the device.
class BenchStudio {
  public:
    /// lanes: as in BenchOptions.
    BenchStudio(Device& device, std::filesystem::path kernel_dir, int lanes)
        : device_(&device), kernel_dir_(std::move(kernel_dir)), lanes_(lanes) {}

    /// With picture and maps; filtered when it is first asked for. Throws RuntimeFailure.
    [[nodiscard]] const BoundEnvironment& environment();

  private:
    Device* device_;
    std::filesystem::path kernel_dir_;
    int lanes_;
    std::optional<BoundEnvironment> environment_;
};

/// A sky over hills, with detail down to single texels and three suns of a few texels with peaks up to 2e5: what makes
/// pre-filtering hard. 2 height x height texels, even height.
[[nodiscard]] LatLong sunny_sky(int height, std::uint64_t seed);

} // namespace clshade
