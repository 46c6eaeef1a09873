// Means over octahedral maps.
#pragma once

#include <glm/glm.hpp>

#include <span>

namespace clshade {

/// Mean over the sphere of the map that is bilinear between the vertices of `grid` (RGB interleaved, filter_layout.h,
/// GRID), good to 1e-3. `cells` is even. For a filtered level: the picture's own mean, if no energy was lost.
[[nodiscard]] glm::dvec3 grid_mean(std::span<const float> grid, int cells);

} // namespace clshade
