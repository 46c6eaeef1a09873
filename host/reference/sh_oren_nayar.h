// Oren-Nayar under an environment given as spherical harmonics (models.md section 9). x = N.E in 0..1, shininess >= 0.
#pragma once

#include "host/scene/scene.h"

#include <glm/glm.hpp>

namespace clshade::reference {

/// K(x) of 9.1, its polynomial, and that of the full model (9.2).
[[nodiscard]] double sh_k(double x);
[[nodiscard]] double sh_k_fit(double x);
[[nodiscard]] double sh_k_full_fit(double x);

/// D: the factor of the constant band. `order1` has that of `precise`; only `full` looks at the albedo rho.
[[nodiscard]] glm::dvec3 sh_dc_factor(AmbientDiffuse form, double shininess, double x, const glm::dvec3& rho);

/// S of 9.4: the deck's factor of the linear band.
[[nodiscard]] double sh_linear_factor(double shininess, double x);

/// 9.5: what the linear band gives along N and along the tangential part of E.
struct ShLinearExact {
    double along_normal = 0.0;  ///< a_N
    double along_tangent = 0.0; ///< a_T
};
[[nodiscard]] ShLinearExact sh_linear_exact(double shininess, double x);

} // namespace clshade::reference
