// Fresnel reflectance: Schlick's approximation and its Gaussian form.
#pragma once

#include <glm/glm.hpp>

namespace clshade::reference {

/// Schlick 1994 (models.md section 1): reflectance per channel for F0 in 0..1 at a cosine in 0..1.
[[nodiscard]] glm::dvec3 schlick(const glm::dvec3& f0, double cosine);

/// Spherical-Gaussian form of Schlick (models.md section 2, constants of Lagarde 2012); off by at most 0.003766.
[[nodiscard]] glm::dvec3 schlick_gaussian(const glm::dvec3& f0, double cosine);

} // namespace clshade::reference
