// What a layer's medium takes from an environment's light (models.md section 7).
#pragma once

#include "host/scene/scene.h"

#include <glm/glm.hpp>

namespace clshade::reference {

/// A_s and A_d for light that is mirrored, or scattered, below the medium.
struct PreintegratedAbsorption {
    glm::dvec3 specular{1.0};
    glm::dvec3 diffuse{1.0};
};

/// a >= 0 per channel: a' of section 7 for `deck` and `clamped`, alpha d for `exponential`. N.E > 0.
///   deck         A_s = max(0, 1 - 2 a/NE), A_d = max(0, 1 - a (2 + 1/NE))
///   clamped      A_s as deck, A_d = (c - a)^2/c with c = 1 - a/NE where c > a, else 0
///   exponential  A_s = exp(-2 a/NE), A_d = 2 E_3(a) exp(-a/NE)
[[nodiscard]] PreintegratedAbsorption preintegrated_absorption(AmbientAbsorption form, const glm::dvec3& a, double ne);

/// The exponential integral E_3(a) = int_1^inf exp(-a t)/t^3 dt, a >= 0.
[[nodiscard]] double exponential_integral_3(double a);

} // namespace clshade::reference
