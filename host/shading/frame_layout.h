// Which planes lie where: frame_layout.h of a program, and the key a kernel is known by.
#pragma once

#include "host/gbuffer/frame.h"

#include <string>
#include <vector>

namespace clshade {

/// Replaces kernels/frame_layout.h.
[[nodiscard]] std::string frame_layout_source(const Frame& frame, const AovSelection& aovs);

/// Planes a pixel of the frame is read from, each once, in slab order: roles, parameters and Cryptomatte claims, not
/// those only passed through.
[[nodiscard]] std::vector<PlaneIndex> planes_read(const Frame& frame);

/// Stable key of the kernel: "shade.blinn_phong.lambert.distant1", "shade.mixed4.distant2_spot1".
[[nodiscard]] std::string kernel_key(const Frame& frame);

} // namespace clshade
