#include "host/reference/diffuse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clshade::reference {

namespace {

constexpr double pi = std::numbers::pi;

/// s2 / (s2 + k), also for s2 = 0 and s2 = infinity.
double saturation(double sigma2, double k) {
    return 1.0 / (1.0 + k / sigma2);
}

/// The angles of section 8: incidence and reflection sorted, and the cosine of the azimuth between them.
struct SphericalAngles {
    double alpha = 0.0; ///< the larger angle from N
    double beta = 0.0;  ///< the smaller
    double cos_dphi = 0.0;
};

SphericalAngles spherical(const Angles& a) {
    const double nl = std::min(a.nl, 1.0);
    const double ne = std::min(a.ne, 1.0);
    const double theta_i = std::acos(nl);
    const double theta_r = std::acos(ne);
    const double sin_i = std::sqrt(1.0 - nl * nl);
    const double sin_r = std::sqrt(1.0 - ne * ne);
    SphericalAngles s;
    s.alpha = std::max(theta_i, theta_r);
    s.beta = std::min(theta_i, theta_r);
    // 8.1: 0 if either sine < 1e-7. Where N.E was raised to 1e-4 the quotient can pass -1: it is a cosine, so clamp it.
    if (sin_i >= 1e-7 && sin_r >= 1e-7) {
        s.cos_dphi = std::clamp(a.gamma / (sin_i * sin_r), -1.0, 1.0);
    }
    return s;
}

double cubed(double x) {
    return x * x * x;
}
double squared(double x) {
    return x * x;
}

/// 8.4 with given coefficients: L = rho/pi (NL A + B max(0, gamma) min(1, NL/NE)).
glm::dvec3 qualitative_form(const Angles& a, const glm::dvec3& rho, double coeff_a, double coeff_b) {
    return rho / pi * (a.nl * coeff_a + coeff_b * std::max(0.0, a.gamma) * std::min(1.0, a.nl / a.ne));
}

} // namespace

glm::dvec3 lambert(const Angles& angles, const glm::dvec3& rho) {
    return rho / pi * angles.nl;
}

OrenNayarParts oren_nayar_full(const Angles& angles, const glm::dvec3& rho, double sigma2) {
    // models.md section 8.1
    const auto [alpha, beta, cos_dphi] = spherical(angles);
    const double c1 = 1.0 - 0.5 * saturation(sigma2, 0.33);
    const double c2 =
        0.45 * saturation(sigma2, 0.09) * (std::sin(alpha) - (cos_dphi < 0.0 ? cubed(2.0 * beta / pi) : 0.0));
    const double c3 = 0.125 * saturation(sigma2, 0.09) * squared(4.0 * alpha * beta / (pi * pi));
    OrenNayarParts parts;
    parts.l1 = rho / pi * angles.nl *
               (c1 + cos_dphi * c2 * std::tan(beta) + (1.0 - std::abs(cos_dphi)) * c3 * std::tan(0.5 * (alpha + beta)));
    parts.l2 =
        0.17 * rho * rho / pi * angles.nl * saturation(sigma2, 0.13) * (1.0 - cos_dphi * squared(2.0 * beta / pi));
    return parts;
}

glm::dvec3 oren_nayar_qualitative(const Angles& angles, const glm::dvec3& rho, double sigma2) {
    // models.md section 8.2: L = rho/pi NL (A + B max(0, cos dphi) sin(alpha) tan(beta))
    const auto [alpha, beta, cos_dphi] = spherical(angles);
    return rho / pi * angles.nl *
           (coefficient_a(sigma2) + coefficient_b(sigma2) * std::max(0.0, cos_dphi) * std::sin(alpha) * std::tan(beta));
}

glm::dvec3 oren_nayar_simplified_1(const Angles& angles, const glm::dvec3& rho, double sigma2) {
    // models.md section 8.3: L = rho/pi NL (A + B max(0, gamma) / max(NL, NE))
    return rho / pi * angles.nl *
           (coefficient_a(sigma2) +
            coefficient_b(sigma2) * std::max(0.0, angles.gamma) / std::max(angles.nl, angles.ne));
}

glm::dvec3 oren_nayar_simplified_2(const Angles& angles, const glm::dvec3& rho, double sigma2) {
    return qualitative_form(angles, rho, coefficient_a(sigma2), coefficient_b(sigma2));
}

glm::dvec3 oren_nayar_shininess(const Angles& angles, const glm::dvec3& rho, double shininess) {
    return qualitative_form(angles, rho, shininess_a(shininess), shininess_b(shininess));
}

glm::dvec3 oren_nayar_improved(const Angles& angles, const glm::dvec3& rho, double shininess) {
    // models.md section 8.6: L = rho/pi [NL A + B gamma t], t = min(1, NL/NE) if gamma >= 0, else NL
    const double t = angles.gamma >= 0.0 ? std::min(1.0, angles.nl / angles.ne) : angles.nl;
    return rho / pi * (angles.nl * improved_a(shininess) + angles.gamma * shininess_b(shininess) * t);
}

double sigma2_of_shininess(double shininess) {
    return 2.0 / shininess;
}

double coefficient_a(double sigma2) {
    return 1.0 - 0.5 * saturation(sigma2, 0.33);
}
double coefficient_b(double sigma2) {
    return 0.45 * saturation(sigma2, 0.09);
}
double shininess_a(double shininess) {
    return 1.0 - 1.0 / (2.0 + 0.33 * shininess);
}
double shininess_b(double shininess) {
    return 1.0 / (2.22222 + 0.1 * shininess);
}
double improved_a(double shininess) {
    return 1.0 - 1.0 / (2.0 + 0.65 * shininess);
}

} // namespace clshade::reference
