// How long it takes from nothing, and from the binary cache, to a kernel that has run.
#pragma once

#include "bench/bench_frame.h"
#include "host/device/device.h"
#include "host/device/program.h"

#include <filesystem>
#include <optional>

namespace clshade {

struct BuildTimes {
    double cold_ms = 0.0;
    double cached_ms = 0.0;
};

/// Builds a row's program into an empty binary cache, then loads it from there, each time from making the shader to the
/// end of its first launch over a picture of 64x64 pixels. Sources get a mark nobody has seen before, so that a
/// cache inside the driver does not answer for the compiler. With an environment (as for apply_scene) the AmbientBRDF
/// tables belong to it, but not the compiler's work on the kernel that makes them, which all rows share; nor does
/// filtering. Throws RuntimeFailure.
[[nodiscard]] BuildTimes measure_build(Device& device, const BenchScene& scene, const std::filesystem::path& kernel_dir,
                                       int lanes, const std::optional<BoundEnvironment>& environment = {});

} // namespace clshade
