#include "host/reference/fresnel.h"

#include <cmath>

namespace clshade::reference {

glm::dvec3 schlick(const glm::dvec3& f0, double cosine) {
    // models.md section 1: F = F0 + (1 - F0) (1 - c)^5
    return f0 + (1.0 - f0) * std::pow(1.0 - cosine, 5.0);
}

glm::dvec3 schlick_gaussian(const glm::dvec3& f0, double cosine) {
    // models.md section 2: F = F0 + (1 - F0) 2^((-5.55473 c - 6.98316) c)
    return f0 + (1.0 - f0) * std::exp2((-5.55473 * cosine - 6.98316) * cosine);
}

} // namespace clshade::reference
