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

    // H = (L + E) / |L + E| and E.H = |L + E| / 2, with rule 8's guards for an eye behind the surface.
    const glm::dvec3 sum = light + eye;
    const double length2 = glm::dot(sum, sum);
    const double length = std::sqrt(std::max(length2, 1e-7));
    const glm::dvec3 half = sum / length;
    const glm::dvec3 cross = glm::cross(normal, half);
    a.eh = length2 / (2.0 * length);
    a.nh = std::clamp(glm::dot(normal, half), 1e-18, 1.0);
    // Below the guard H is shorter than 1, and |N x H|^2 no longer what N.H leaves of 1.
    a.sin2_nh = length2 < 1e-7 ? 1.0 - a.nh * a.nh : std::min(glm::dot(cross, cross), 1.0);
    return a;
}

} // namespace clshade::reference
