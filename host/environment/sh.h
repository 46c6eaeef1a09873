// Sums over a lat-long picture: spherical harmonics and the mean.
#pragma once

#include "host/environment/lat_long.h"

#include <glm/glm.hpp>

#include <array>

namespace clshade {

/// L_lm = sum over the texels of L Y_lm dw, l = 0..2, in the picture's frame: radiance, order and signs of models.md
/// section 6 (filter_layout.h, SH). Double throughout.
[[nodiscard]] std::array<glm::dvec3, 9> sh_of(const LatLong& image);

/// Mean radiance over the sphere.
[[nodiscard]] glm::dvec3 mean_radiance(const LatLong& image);

} // namespace clshade
