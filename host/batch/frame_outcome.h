// What became of a frame.
#pragma once

#include "host/base/stage_times.h"
#include "host/gbuffer/frame.h"
#include "host/shading/shader.h"

#include <cstdint>
#include <string>
#include <vector>

namespace clshade {

struct FrameOutcome {
    std::string skipped; ///< why nothing was written; empty: it was
    int width = 0;
    int height = 0;
    int bands = 1; ///< more where the frame did not fit into memory
    PixelCounts counts;
    /// "read", "device", "environment", "build", "transfer", "kernel", "prepare", "write": elapsed time of the stage.
    /// "read" and "write" of frames in flight overlap.
    StageTimes stages;
    double busy_milliseconds = 0.0; ///< of all threads that decoded and encoded, summed
    std::vector<KernelTime> kernels;
    std::vector<std::string> warnings;
    std::vector<std::string> notes; ///< what was found out and is no fault, such as a recovered camera's residual
    std::string build;              ///< "built" or "from the cache" for the first frame of a program, else empty
    std::string environment;        ///< the same for the environment's maps
    std::string program;            ///< identity of the kernel
    std::string camera;             ///< where it came from
    std::uint64_t bytes_read = 0;
    std::uint64_t bytes_written = 0;
    std::string input_hash;  ///< XXH3 of the file, if asked for
    std::string output_hash; ///< of its completion stamp; empty for skipped frames
};

} // namespace clshade
