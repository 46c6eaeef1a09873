// Scene values as the kernels take them: the structs of kernels/types.h filled from a Frame.
#pragma once

#include "host/gbuffer/frame.h"
#include "kernels/types.h"

#include <vector>

namespace clshade {

[[nodiscard]] FrameConstants frame_constants(const Frame& frame);
/// One entry per light of the frame; one unused entry for a frame without lights, since no device takes an empty
/// buffer.
[[nodiscard]] std::vector<LightConstants> light_constants(const Frame& frame);

/// SH and matrix of the frame's environment, whose maps there must be.
[[nodiscard]] EnvironmentConstants environment_constants(const BoundEnvironment& environment);

} // namespace clshade
