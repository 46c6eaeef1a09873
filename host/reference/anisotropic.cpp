#include "host/reference/anisotropic.h"

#include "host/reference/blinn_phong.h"
#include "host/reference/fresnel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace clshade::reference {

namespace {

/// First axis of the frame of Duff et al. on a unit vector.
glm::dvec3 duff_axis(const glm::dvec3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    return {1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

} // namespace

TangentFrame tangent_frame(const glm::dvec3& t, const glm::dvec3& normal) {
    TangentFrame frame;
    const double length = glm::length(t);
    const glm::dvec3 u = t - glm::dot(t, normal) * normal;
    const bool absurd = length * length > static_cast<double>(std::numeric_limits<float>::max());
    frame.missing = !(length >= 1e-6) || glm::length(u) < 1e-4 * length || absurd;
    frame.tangent = frame.missing ? duff_axis(normal) : glm::normalize(u);
    frame.bitangent = glm::cross(normal, frame.tangent);
    return frame;
}

double anisotropic_exponent(const Angles& angles, const TangentFrame& frame, double n_u, double n_v) {
    // The sum of both squares is 1 - (N.H)^2 without its cancellation. At the very centre N.H^e is 1 for any e.
    if (angles.sin2_nh < 1e-12) {
        return 0.5 * (n_u + n_v);
    }
    const double th = glm::dot(frame.tangent, angles.half);
    const double bh = glm::dot(frame.bitangent, angles.half);
    return (n_u * th * th + n_v * bh * bh) / std::max(th * th + bh * bh, 1e-12);
}

double normaliser_anisotropic(double n_u, double n_v) {
    // models.md section 3: a = n_u + 2, b = n_v + 2,
    // Norm = sqrt(a b) / (8 pi (1 - w)), w = (2^(-a/2) + 2 2^(-a b/(a + b)) + 2^(-b/2)) / 4
    const double a = n_u + 2.0;
    const double b = n_v + 2.0;
    const double w = 0.25 * (std::exp2(-0.5 * a) + 2.0 * std::exp2(-a * b / (a + b)) + std::exp2(-0.5 * b));
    return std::sqrt(a * b) / (8.0 * std::numbers::pi * (1.0 - w));
}

double normaliser_anisotropic_cheap(double n_u, double n_v) {
    return normaliser_linear(std::sqrt((n_u + 2.0) * (n_v + 2.0)) - 2.0);
}

double anisotropic_f_cos(const Angles& angles, const TangentFrame& frame, double n_u, double n_v) {
    return normaliser_anisotropic(n_u, n_v) * lobe(angles, anisotropic_exponent(angles, frame, n_u, n_v)) *
           attenuated_cosine(angles);
}

glm::dvec3 blinn_phong_anisotropic(const Angles& angles, const TangentFrame& frame, const glm::dvec3& f0, double n_u,
                                   double n_v) {
    return anisotropic_f_cos(angles, frame, n_u, n_v) * schlick(f0, angles.eh);
}

} // namespace clshade::reference
