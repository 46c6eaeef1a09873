// Real spherical harmonics of bands 0 to 2, without the Condon-Shortley sign (models.md section 6).
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>

namespace clshade::reference {

/// Y_00; Y_1m along y, z, x; Y_2m: xy, yz, 3 z^2 - 1, xz, x^2 - y^2. d is a unit vector.
[[nodiscard]] std::array<double, 9> sh_basis(const glm::dvec3& d);

/// Coefficients of radiance, per colour channel.
using ShRadiance = std::array<glm::dvec3, 9>;

/// Band 0, 1 or 2 of E/pi for a normal d: c_l sum_m L_lm Y_lm(d), c = 1, 2/3, 1/4.
[[nodiscard]] glm::dvec3 sh_irradiance_band(const ShRadiance& radiance, std::size_t band, const glm::dvec3& d);

/// sum_m L_1m Y_1m(d), for d of any length: "(d.v)" of models.md section 9.5.
[[nodiscard]] glm::dvec3 sh_linear(const ShRadiance& radiance, const glm::dvec3& d);

} // namespace clshade::reference
