// Physically based Blinn-Phong (models.md sections 1 and 2).
//
// f_cos is the BRDF times N.L: radiance for an irradiance of 1 on a surface facing the light.
#pragma once

#include "host/reference/angles.h"

#include <glm/glm.hpp>

namespace clshade::reference {

/// Normaliser of the lobe, exact form (section 1); n >= 0.
[[nodiscard]] double normaliser_exact(double n);
/// Normaliser of the lobe, linear form (section 2); n >= 0, accurate from about 9.
[[nodiscard]] double normaliser_linear(double n);

/// (N.H)^n, good to about 1e-12 relative for n up to 65536; 1 for n = 0 whatever N.H is (section 0, rule 4).
[[nodiscard]] double lobe(const Angles& angles, double n);

/// N.L / max(N.L, N.E): the cosine of f_cos and the attenuation of sections 1 to 3 in one bounded factor.
[[nodiscard]] double attenuated_cosine(const Angles& angles);

/// Specular f_cos of the exact form (section 1). Needs N.L > 0.
[[nodiscard]] glm::dvec3 blinn_phong_exact(const Angles& angles, const glm::dvec3& f0, double n);
/// Specular f_cos of the approximated form (section 2). Needs N.L > 0.
[[nodiscard]] glm::dvec3 blinn_phong(const Angles& angles, const glm::dvec3& f0, double n);

/// What the exact form leaves to the diffuse part: 1 - Schlick(F0, N.L) (section 1).
[[nodiscard]] glm::dvec3 diffuse_weight_exact(const Angles& angles, const glm::dvec3& f0);
/// What the approximated form leaves to the diffuse part: 1 - F0 (section 2).
[[nodiscard]] glm::dvec3 diffuse_weight(const glm::dvec3& f0);

} // namespace clshade::reference
