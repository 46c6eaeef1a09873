// The device's part of the AmbientBRDF tables.
#pragma once

#include "host/device/device.h"
#include "host/device/program.h"
#include "host/environment/filtered_set.h"
#include "host/prefilter/prefilter.h"

#include <vector>

namespace clshade {

inline constexpr const char* ambient_kernel_file = "ambient_brdf.cl";

/// Scale and bias with both normalisers. Throws RuntimeFailure.
[[nodiscard]] AmbientTables ambient_on_device(Device& device, const SourceSet& kernels, const ProgramCache& cache,
                                              int lanes);
/// RGB interleaved.
[[nodiscard]] std::vector<float> spectral_on_device(Device& device, const SourceSet& kernels, const ProgramCache& cache,
                                                    int lanes, const ReflectanceCurve& curve, bool linear);

} // namespace clshade
