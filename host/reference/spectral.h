// Metals from their optical constants (models.md section 4): conductor Fresnel at 81 wavelengths, to linear sRGB.
#pragma once

#include "host/scene/scene.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>

namespace clshade::reference {

inline constexpr std::size_t wavelength_count = 81;

/// Wavelength i in nanometres: 380, 385, ..., 780.
[[nodiscard]] double wavelength(std::size_t i);

/// Fit of the CIE 1931 colour-matching functions (xbar, ybar, zbar) at a wavelength in nanometres (Wyman, Sloan and
/// Shirley 2013).
[[nodiscard]] glm::dvec3 cmf_fit_xyz(double nanometres);

/// CIE XYZ to linear sRGB.
[[nodiscard]] glm::dvec3 srgb_of_xyz(const glm::dvec3& xyz);

/// n and k of a metal at a wavelength: piecewise linear, clamped outside the samples.
[[nodiscard]] ComplexIndex index_at(const Metal& metal, double nanometres);

/// A metal at the 81 wavelengths. Reflectances are R_j = sum_i R(lambda_i, c) r_j(lambda_i) / sum_i r_j(lambda_i) for
/// j = R, G, B, clamped to 0..1: a flat spectrum stays grey.
class SpectralMetal {
  public:
    SpectralMetal() = default;
    explicit SpectralMetal(const Metal& metal);

    /// Seen from a medium of the given index (1: air) at a cosine; both per channel.
    [[nodiscard]] glm::dvec3 reflectance(const glm::dvec3& medium, const glm::dvec3& cosine) const;
    /// Seen from air.
    [[nodiscard]] glm::dvec3 reflectance(double cosine) const {
        return reflectance(glm::dvec3(1.0), glm::dvec3(cosine));
    }
    /// Reflectance in air at normal incidence.
    [[nodiscard]] const glm::dvec3& f0() const { return f0_; }

  private:
    std::array<double, wavelength_count> n_{};
    std::array<double, wavelength_count> k_{};
    std::array<glm::dvec3, wavelength_count> weights_{}; ///< r_j / sum r_j
    glm::dvec3 f0_{0.0};
};

} // namespace clshade::reference
