// The device's part of filtering one environment.
#pragma once

#include "host/device/device.h"
#include "host/device/program.h"
#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"

#include <functional>

namespace clshade {

struct FilterCost {
    double kernel_milliseconds = 0.0;
    double build_milliseconds = 0.0;
};

inline constexpr const char* filter_kernel_file = "filter.cl";

/// The radiance levels and the irradiance map; nothing else of the set. Throws RuntimeFailure.
[[nodiscard]] FilterCost filter_on_device(Device& device, const SourceSet& kernels, const ProgramCache& cache,
                                          int lanes, const LatLong& image, const std::function<void(double)>& progress,
                                          FilteredSet& set);

} // namespace clshade
