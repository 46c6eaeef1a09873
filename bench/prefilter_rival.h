// The straightforward C++ pre-filter that the device's is measured against (bench/simd/filter.cpp).
#pragma once

#include "bench/host_kernels.h"
#include "bench/worker_pool.h"
#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"

#include <string_view>

namespace clshade {

/// The same maps, irradiance, SH and mean as Prefilter::filter makes, by the same rules (filter_layout.h). Halving the
/// picture, SH and mean are the host's own functions on either side. It neither hashes the picture nor stores a result.
class PrefilterRival {
  public:
    /// As for HostRivals.
    explicit PrefilterRival(int threads, std::string_view instruction_set = {})
        : kernels_(&host_kernels(instruction_set)), pool_(threads_or_all(threads)) {}

    [[nodiscard]] FilteredSet filter(const LatLong& image);

  private:
    const HostKernels* kernels_;
    WorkerPool pool_;
};

} // namespace clshade
