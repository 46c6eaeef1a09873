// Fresnel reflectance: Schlick's approximation, its Gaussian form, and the formulas it approximates.
//
// An index of refraction is at least 1 for a medium against air; infinity stands for a mirror (F0 = 1).
#pragma once

#include <glm/glm.hpp>

namespace clshade::reference {

/// Schlick 1994 (models.md section 1): reflectance per channel for F0 in 0..1 at a cosine in 0..1.
[[nodiscard]] glm::dvec3 schlick(const glm::dvec3& f0, double cosine);

/// Spherical-Gaussian form of Schlick (models.md section 2, constants of Lagarde 2012); off by at most 0.003766.
[[nodiscard]] glm::dvec3 schlick_gaussian(const glm::dvec3& f0, double cosine);

/// Dielectric, unpolarised (models.md section 5). n: index on the transmitted side over index on the incident side,
/// 0 or more; cosine of incidence in 0..1. 0 for n = 1, 1 for total internal reflection and at grazing incidence.
[[nodiscard]] double fresnel_dielectric(double n, double cosine);

/// Conductor, unpolarised (models.md section 4). n + i k: complex index over the index on the incident side; n, k >= 0.
[[nodiscard]] double fresnel_conductor(double n, double k, double cosine);

/// Reflectance at normal incidence between media of two indices: ((n2 - n1) / (n2 + n1))^2; 0 for equal ones.
[[nodiscard]] double f0_between(double n1, double n2);

/// Index against air of an F0 measured in air: (1 + sqrt F0) / (1 - sqrt F0); infinity for F0 = 1.
[[nodiscard]] double index_of_f0(double f0);

/// n2 / n1, 1 for equal ones, be they infinite.
[[nodiscard]] double relative_index(double n1, double n2);

/// Cosine inside a medium of index m of what comes from air at a cosine: sqrt(1 - (1 - c^2)/m^2).
[[nodiscard]] double refracted_cosine(double cosine, double m);

/// F_bottom(n1, n2) of section 5: what the bottom sends back through the top, all three factors at their own angles:
/// (1 - F(n1; c)) F(n2/n1; c') (1 - F(1/n1; c')).
[[nodiscard]] double f_bottom_exact(double n1, double n2, double cosine);

/// F_b of section 5: F0(n2/n1) (1 - F0(1/n1)), to be multiplied by F_transmittance = 1 - F(n1; E.H).
[[nodiscard]] double f_bottom_constant(double n1, double n2);

} // namespace clshade::reference
