// Rule 9 of host/gbuffer/frame.h: a material's lobes together.
#pragma once

#include "host/reference/angles.h"
#include "host/reference/material_values.h"

#include <glm/glm.hpp>

namespace clshade::reference {

/// f_cos of both parts, the diffuse one with its weight: radiance for an irradiance of 1.
struct Reflected {
    glm::dvec3 diffuse{0.0};
    glm::dvec3 specular{0.0};
};

/// Zero unless N.L > 0.
[[nodiscard]] Reflected reflect(const MaterialValues& material, const Angles& angles);

} // namespace clshade::reference
