// The two files of a program that depend on the frame's structure: which planes lie where (frame_layout.h) and what its
// materials do (materials.cl). Everything else of kernels/ is the same for every frame. Values (colours, shininess,
// light strengths) are not in the source, so that changing one needs no compiler.
#pragma once

#include "host/gbuffer/frame.h"

#include <string>
#include <vector>

namespace clshade {

/// Replaces kernels/frame_layout.h.
[[nodiscard]] std::string frame_layout_source(const Frame& frame, const AovSelection& aovs);
/// Replaces kernels/materials.cl.
[[nodiscard]] std::string materials_source(const Frame& frame);

/// Planes a pixel of the frame is read from, each once, in slab order: roles and parameters, not those only passed
/// through.
[[nodiscard]] std::vector<PlaneIndex> planes_read(const Frame& frame);

/// Stable key of the kernel: "shade.blinn_phong.lambert.distant1", "shade.mixed4.distant2_spot1".
[[nodiscard]] std::string kernel_key(const Frame& frame);

} // namespace clshade
