// Directions and cosines for the tests of the reference.
#pragma once

#include "host/reference/angles.h"

#include <glm/glm.hpp>

#include <cmath>
#include <numbers>

namespace clshade::reference {

inline double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

/// Unit vector at angle theta from N = (0, 0, 1) and azimuth phi, both in radians.
inline glm::dvec3 direction_at(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Angles for N = (0, 0, 1) without the clamp of N.E, for checks of the formulas themselves.
inline Angles unclamped_angles(const glm::dvec3& eye, const glm::dvec3& light) {
    Angles a = angles_between({0.0, 0.0, 1.0}, eye, light);
    a.ne = eye.z;
    a.gamma = a.el - a.ne * a.nl;
    return a;
}

/// "Geometry of the test vectors" of models.md section 0.
inline Angles vector_angles(double theta_l_deg, double theta_e_deg, double dphi_deg) {
    return unclamped_angles(direction_at(radians(theta_e_deg), radians(dphi_deg)),
                            direction_at(radians(theta_l_deg), 0.0));
}

} // namespace clshade::reference
