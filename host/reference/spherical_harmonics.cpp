#include "host/reference/spherical_harmonics.h"

#include <cmath>
#include <numbers>

namespace clshade::reference {

std::array<double, 9> sh_basis(const glm::dvec3& d) {
    constexpr double pi = std::numbers::pi;
    const double y0 = 0.5 * std::sqrt(1.0 / pi);
    const double y1 = 0.5 * std::sqrt(3.0 / pi);
    const double y2 = 0.5 * std::sqrt(15.0 / pi);
    const double y20 = 0.25 * std::sqrt(5.0 / pi);
    return {y0,
            y1 * d.y,
            y1 * d.z,
            y1 * d.x,
            y2 * d.x * d.y,
            y2 * d.y * d.z,
            y20 * (3.0 * d.z * d.z - 1.0),
            y2 * d.x * d.z,
            0.5 * y2 * (d.x * d.x - d.y * d.y)};
}

glm::dvec3 sh_irradiance_band(const ShRadiance& radiance, std::size_t band, const glm::dvec3& d) {
    constexpr std::array<double, 3> cosine_lobe{1.0, 2.0 / 3.0, 1.0 / 4.0};
    const std::array<double, 9> basis = sh_basis(d);
    glm::dvec3 sum(0.0);
    for (std::size_t i = band * band; i < (band + 1) * (band + 1); ++i) {
        sum += radiance[i] * basis[i];
    }
    return sum * cosine_lobe.at(band);
}

glm::dvec3 sh_linear(const ShRadiance& radiance, const glm::dvec3& d) {
    const std::array<double, 9> basis = sh_basis(d);
    return radiance[1] * basis[1] + radiance[2] * basis[2] + radiance[3] * basis[3];
}

} // namespace clshade::reference
