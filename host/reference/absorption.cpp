#include "host/reference/absorption.h"

#include "host/reference/fresnel.h"

#include <cmath>

namespace clshade::reference {

glm::dvec3 absorption_approximated(const glm::dvec3& a, double nl, double ne) {
    return glm::max(glm::dvec3(0.0), 1.0 - a * (1.0 / nl + 1.0 / ne));
}

glm::dvec3 absorption_original(const glm::dvec3& alpha_d, const glm::dvec3& m, double nl, double ne) {
    glm::dvec3 a(1.0);
    for (int i = 0; i < 3; ++i) {
        a[i] = std::exp(-alpha_d[i] * (1.0 / refracted_cosine(nl, m[i]) + 1.0 / refracted_cosine(ne, m[i])));
    }
    return a;
}

} // namespace clshade::reference
