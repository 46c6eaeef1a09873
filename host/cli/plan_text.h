// A planned frame in words: what `inspect` and a dry run print.
#pragma once

#include "host/batch/frame_input.h"
#include "host/batch/frame_job.h"
#include "host/batch/run_scene.h"
#include "host/device/device.h"
#include "host/environment/environment_input.h"

#include <string>

namespace clshade::cli {

/// One line per role that has channels: role, channels, rule.
[[nodiscard]] std::string roles_text(const PlannedInput& input);

/// What shading the frame would do. `environment` may be null.
[[nodiscard]] std::string plan_text(const PlannedInput& input, const FrameJob& job, const RunScene& scene,
                                    const EnvironmentInput* environment, const DeviceInfo& device);

} // namespace clshade::cli
