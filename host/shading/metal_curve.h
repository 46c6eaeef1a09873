// The Fresnel reflectance of a metal as polynomials, for kernels (models.md section 4): the sum over the spectrum is
// done here once, not per pixel.
#pragma once

#include "host/scene/scene.h"

#include <glm/glm.hpp>

#include <vector>

namespace clshade {

/// Where light meets the metal.
struct MetalSurroundings {
    glm::dvec3 index{1.0}; ///< of the medium above, per channel
    /// The cosine at the metal is that of E.H in air (false), or refracted into the medium (true).
    bool refracted = false;
    /// Per channel: the reflectance for normal incidence instead of the curve.
    glm::bvec3 constant{false};
};

/// Reflectance in linear RGB for the cosine c = E.H in air: the mean over 380, 385, ..., 780 nm under the
/// colour-matching functions of linear sRGB. Not clamped: saturated spectra leave 0..1.
[[nodiscard]] glm::dvec3 metal_reflectance(const Metal& metal, const MetalSurroundings& where, double c);

/// sum_i coefficients[i] x^i, x = 2 (1 + bend) c / (c + bend) - 1; then clamped to 0..1.
struct MetalCurve {
    double bend = 1.0;
    std::vector<glm::dvec3> coefficients; ///< lowest power first
    double error = 0.0;                   ///< largest absolute error, evaluated in single precision
};

/// Fits 12 to 40 coefficients; as few as leave an error of 1e-6, or the best there is.
[[nodiscard]] MetalCurve fit_metal_curve(const Metal& metal, const MetalSurroundings& where);

} // namespace clshade
