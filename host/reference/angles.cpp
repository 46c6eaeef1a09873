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

    // H = (L + E) / |L + E|; rule 8: below |L + E|^2 = 1e-7 there is no half vector and both cosines are 0.
    const glm::dvec3 sum = light + eye;
    const double length2 = glm::dot(sum, sum);
    if (length2 >= 1e-7) {
        const glm::dvec3 half = sum / std::sqrt(length2);
        const glm::dvec3 cross = glm::cross(normal, half);
        a.eh = std::clamp(glm::dot(eye, half), 0.0, 1.0);
        a.nh = std::clamp(glm::dot(normal, half), 0.0, 1.0);
        a.sin2_nh = std::min(glm::dot(cross, cross), 1.0);
    }
    return a;
}

} // namespace clshade::reference
