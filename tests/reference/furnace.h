// White furnace: hemispherical-directional reflectance by integration.
#pragma once

#include "tests/reference/directions.h"

#include <cmath>
#include <functional>
#include <numbers>

namespace clshade::reference {

using Lobe = std::function<double(const Angles&)>; // f_cos

inline glm::dvec3 eye_at(double ne) {
    return {std::sqrt(1.0 - ne * ne), 0.0, ne};
}

/// Integral of f_cos over the hemisphere of L for a lobe about H, midpoint rule in u = (N.H)^(n+1) and the azimuth of
/// H: dw_L = 4 E.H dw_H, and (n + 1) (N.H)^n / 2 pi is the density of H.
inline double reflectance_of_lobe(const Lobe& f_cos, double n, double ne, int rings = 500, int sectors = 160) {
    constexpr double pi = std::numbers::pi;
    const glm::dvec3 eye = eye_at(ne);
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        const double u = (i + 0.5) / rings;
        const double nh = std::pow(u, 1.0 / (n + 1.0));
        const double density = (n + 1.0) * std::pow(nh, n) / (2.0 * pi);
        for (int j = 0; j < sectors; ++j) {
            const glm::dvec3 half =
                direction_at(std::acos(nh), (j + 0.5) / sectors * pi); // one half; the other mirrors
            const double eh = glm::dot(eye, half);
            const glm::dvec3 light = 2.0 * eh * half - eye;
            if (eh > 0.0 && light.z > 0.0) {
                sum += f_cos(unclamped_angles(eye, light)) * 4.0 * eh / density;
            }
        }
    }
    return sum / (rings * sectors);
}

/// The same for a diffuse model, midpoint rule in the angle of L and its azimuth.
inline double reflectance_of_diffuse(const Lobe& f_cos, double ne, int rings = 200, int sectors = 100) {
    constexpr double pi = std::numbers::pi;
    const glm::dvec3 eye = eye_at(ne);
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        const double theta = (i + 0.5) / rings * pi / 2.0;
        for (int j = 0; j < sectors; ++j) {
            sum += f_cos(unclamped_angles(eye, direction_at(theta, (j + 0.5) / sectors * pi))) * std::sin(theta);
        }
    }
    return sum * (pi / 2.0 / rings) * (2.0 * pi / sectors);
}

// Tables of models.md are printed to four decimals: half a unit of the last, and as much again for both integrations.
inline constexpr double printed = 1e-4;

} // namespace clshade::reference
