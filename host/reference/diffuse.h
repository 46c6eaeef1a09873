// Diffuse models: Lambert and the Oren-Nayar family (models.md section 8).
//
// Every function gives f_cos (BRDF times N.L, "L for E_0 = 1" in section 8) and needs N.L > 0. rho is the albedo,
// sigma2 the variance of the facet slope angle (0 to infinity, infinity included), shininess = 2/sigma2.
#pragma once

#include "host/reference/angles.h"

#include <glm/glm.hpp>

namespace clshade::reference {

[[nodiscard]] glm::dvec3 lambert(const Angles& angles, const glm::dvec3& rho);

/// The two parts of the full model: single and double scattering between facets.
struct OrenNayarParts {
    glm::dvec3 l1{0.0};
    glm::dvec3 l2{0.0};
};
/// 8.1, as published.
[[nodiscard]] OrenNayarParts oren_nayar_full(const Angles& angles, const glm::dvec3& rho, double sigma2);
/// 8.2, written with angles and trigonometric functions as on the deck.
[[nodiscard]] glm::dvec3 oren_nayar_qualitative(const Angles& angles, const glm::dvec3& rho, double sigma2);
/// 8.3, equal to 8.2.
[[nodiscard]] glm::dvec3 oren_nayar_simplified_1(const Angles& angles, const glm::dvec3& rho, double sigma2);
/// 8.4, equal to 8.2 and 8.3.
[[nodiscard]] glm::dvec3 oren_nayar_simplified_2(const Angles& angles, const glm::dvec3& rho, double sigma2);
/// 8.5: 8.4 in shininess.
[[nodiscard]] glm::dvec3 oren_nayar_shininess(const Angles& angles, const glm::dvec3& rho, double shininess);
/// 8.6, the deck's improved qualitative model.
[[nodiscard]] glm::dvec3 oren_nayar_improved(const Angles& angles, const glm::dvec3& rho, double shininess);

/// 8.7: sigma^2 of a shininess >= 0; infinity for 0.
[[nodiscard]] double sigma2_of_shininess(double shininess);
/// Coefficients A and B of 8.2 to 8.4.
[[nodiscard]] double coefficient_a(double sigma2);
[[nodiscard]] double coefficient_b(double sigma2);
/// The same in shininess (8.5), and A of 8.6, whose B is that of 8.5.
[[nodiscard]] double shininess_a(double shininess);
[[nodiscard]] double shininess_b(double shininess);
[[nodiscard]] double improved_a(double shininess);

} // namespace clshade::reference
