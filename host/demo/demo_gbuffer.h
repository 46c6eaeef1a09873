// The built-in G-buffer of `clshade demo`: a signed-distance scene sphere-traced on the host. No files, no OpenCL.
#pragma once

#include "host/base/plane_slab.h"
#include "host/scene/scene.h"

#include <string>
#include <vector>

namespace clshade {

/// One frame of the demo as a renderer would hand it over.
struct DemoFrame {
    PlaneSlab planes;
    std::vector<std::string> plane_names; ///< "Normal.X", ..., "Position.X", "Depth.Z", "Albedo.R", "F0.R",
                                          ///< "Roughness.V", "MaterialID.V", "UV.A" (coverage)
    Camera camera;                        ///< with its vertical field of view
};

/// Renders frame `index` (1-based) of `count` at width x height: spheres, a ground, letters, several materials with
/// varying roughness and F0; camera moves along an arc. Planes that renderers filter (normal, albedo, F0, roughness)
/// are averaged over samples and premultiplied by coverage; position, depth and ids are one sample at the pixel centre.
[[nodiscard]] DemoFrame render_demo_frame(int width, int height, int index, int count, int threads);

/// The picture that the demo's scene takes its environment from, a lat-long of the built-in studio.
inline constexpr const char* demo_environment = "studio.exr";

/// The scene file that belongs to the demo (TOML text): environment, lights and materials by id.
[[nodiscard]] std::string demo_scene_toml();

} // namespace clshade
