#include "host/reference/angles.h"

#include <algorithm>
#include <cmath>

namespace clshade::reference {

Angles angles_between(const glm::dvec3& normal, const glm::dvec3& eye, const glm::dvec3& light) {
    Angles a;
    a.nl = glm::dot(normal, light);
    a.ne = std::max(glm::dot(normal, eye), 1e-4);
    a.el = glm::dot(eye, light);
    a.gamma = a.el - a.ne * a.nl;

    // H = (L + E) / m and E.H = |L + E| / 2 with m = |L + E|, and rule 8's guards for an eye behind the surface.
    const glm::dvec3 sum = light + eye;
    const double length2 = glm::dot(sum, sum);
    const double m = std::sqrt(std::max(length2, 1e-12));
    const glm::dvec3 half = sum / m;
    const glm::dvec3 cross = glm::cross(normal, half);
    a.eh = std::min(length2 / (2.0 * m), 1.0);
    a.half = half;
    a.nh = std::min(std::max(glm::dot(normal, sum), 1e-12) / m, 1.0);
    // Below the guard H is shorter than 1, and |N x H|^2 no longer what N.H leaves of 1.
    a.sin2_nh = length2 < 1e-12 ? 1.0 - a.nh * a.nh : std::min(glm::dot(cross, cross), 1.0);
    return a;
}

} // namespace clshade::reference
