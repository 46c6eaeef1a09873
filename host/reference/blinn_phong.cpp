#include "host/reference/blinn_phong.h"

#include "host/reference/fresnel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clshade::reference {

double normaliser_exact(double n) {
    // models.md section 1: (n + 2) / (4 pi (2 - 2^(-n/2)))
    return (n + 2.0) / (4.0 * std::numbers::pi * (2.0 - std::exp2(-0.5 * n)));
}

double normaliser_linear(double n) {
    // models.md section 2: 0.0397436 n + 0.0856832
    return 0.0397436 * n + 0.0856832;
}

double lobe(const Angles& angles, double n) {
    if (n == 0.0) {
        return 1.0;
    }
    if (angles.nh <= 0.0) {
        return 0.0;
    }
    // (N.H)^n = exp(n log N.H). Near the highlight one rounding of N.H, a value near 1, would be multiplied by n; there
    // models.md section 14 has log N.H = 1/2 log1p(-|N x H|^2). Near N.H = 0 it is 1 - |N x H|^2 that cancels.
    const double log_nh = angles.nh > 0.5 ? 0.5 * std::log1p(-angles.sin2_nh) : std::log(angles.nh);
    return std::exp(n * log_nh);
}

double attenuated_cosine(const Angles& angles) {
    return angles.nl / std::max(angles.nl, angles.ne);
}

glm::dvec3 blinn_phong_exact(const Angles& angles, const glm::dvec3& f0, double n) {
    // models.md section 1: f_r = norm F(F0, E.H) (N.H)^n / max(N.L, N.E)
    return normaliser_exact(n) * lobe(angles, n) * attenuated_cosine(angles) * schlick(f0, angles.eh);
}

glm::dvec3 blinn_phong(const Angles& angles, const glm::dvec3& f0, double n) {
    // models.md section 2: the same with the linear normaliser and the Gaussian Fresnel term
    return normaliser_linear(n) * lobe(angles, n) * attenuated_cosine(angles) * schlick_gaussian(f0, angles.eh);
}

glm::dvec3 diffuse_weight_exact(const Angles& angles, const glm::dvec3& f0) {
    return 1.0 - schlick(f0, std::min(angles.nl, 1.0));
}

glm::dvec3 diffuse_weight(const glm::dvec3& f0) {
    return 1.0 - f0;
}

} // namespace clshade::reference
