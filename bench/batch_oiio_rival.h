// What a user of OpenImageIO writes in an afternoon: read the file, one parallel loop, write the file.
#pragma once

#include "bench/host_kernels.h"

#include <filesystem>
#include <string>
#include <vector>

namespace clshade {

struct OiioWork {
    std::vector<std::filesystem::path> inputs; ///< of the sequence of batch_sequence.h
    std::vector<std::filesystem::path> outputs;
    bool half = true; ///< of the outputs
    std::string compression;
    rivals::DistantLight light{}; ///< unit vector to it, irradiance
    int threads = 1;
};

/// Empty, or why this build cannot run it.
[[nodiscard]] std::string oiio_rival_trouble();

/// Blinn-Phong and Lambert under one light, as the automatic material has them. OpenImageIO reads all channels,
/// interleaved and as float, and runs as many threads of its own and of OpenEXR's as it does by itself; buffers are
/// kept from frame to frame; the loop is compiled for the processor's own vectors. Returns milliseconds. Leaves
/// OpenEXR's pool without threads. Throws RuntimeFailure naming the file.
double run_oiio_rival(const OiioWork& work);

} // namespace clshade
