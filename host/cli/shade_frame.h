// One frame from input file to output file.
#pragma once

#include "host/cli/frame_input.h"
#include "host/cli/frame_output.h"
#include "host/cli/kernel_dump.h"
#include "host/cli/progress.h"
#include "host/cli/run_environment.h"
#include "host/cli/run_stats.h"
#include "host/cli/session.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace clshade::cli {

/// What `shade` does with every frame.
struct ShadeSettings {
    AovSelection aovs;
    std::vector<std::string> keep;
    std::string view;
    ExrSettings exr;
    bool update_only = false; ///< -u
    bool no_clobber = false;
    bool dry_run = false;
    KernelDump* kernel_dump = nullptr; ///< --dump-kernel; null: none
    int threads = 1;
};

struct FrameJob {
    std::optional<int> number; ///< absent outside sequences
    std::filesystem::path input;
    std::filesystem::path output;
    std::filesystem::path preview; ///< a PNG written beside the output; empty: none
};

struct FrameOutcome {
    std::string skipped; ///< why nothing was written; empty: it was
    int width = 0;
    int height = 0;
    PixelCounts counts;
    StageTimes stages;
    std::vector<KernelTime> kernels;
    std::vector<std::string> warnings;
    std::string plan;        ///< of a dry run: what would be done
    std::string build;       ///< "built" or "from the cache" for the first frame of a program, else empty
    std::string environment; ///< the same for the environment's maps
};

/// Shades one frame; the device is opened once header, scene and environment have proved good. Throws UsageError,
/// RuntimeFailure, DeviceError; nothing is written then.
[[nodiscard]] FrameOutcome shade_frame(const FrameJob& job, const ChosenScene& scene, RunEnvironment& environment,
                                       const ShadeSettings& settings, Session& session, Progress& progress);

/// Throws UsageError when material ids are not whole numbers: such a plane has been filtered and would mix materials.
void refuse_filtered_ids(const std::string& file, const PixelCounts& counts);

/// Warnings for what was counted: non-finite and clamped pixels, tangents that are none.
[[nodiscard]] std::vector<std::string> count_warnings(const std::string& file, const PixelCounts& counts);

} // namespace clshade::cli
