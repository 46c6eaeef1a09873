#include "host/reference/sh_oren_nayar.h"

#include "host/reference/diffuse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clshade::reference {

namespace {

constexpr double pi = std::numbers::pi;

double sine(double x) {
    return std::sqrt(std::max(1.0 - x * x, 0.0));
}

} // namespace

double sh_k(double x) {
    // models.md section 9.1: K = (2 s/pi) [(acos x - s x)/2 + (1 - s^3)/(3x) - 1/3], the quotient without its division
    const double s = sine(x);
    const double quotient = x * (1.0 + s + s * s) / (3.0 * (1.0 + s));
    return 2.0 * s / pi * (0.5 * (std::acos(x) - s * x) + quotient - 1.0 / 3.0);
}

double sh_k_fit(double x) {
    return (1.0 - x) * (0.28695 - 0.01409 * x - 0.20825 * x * x);
}

double sh_k_full_fit(double x) {
    // models.md section 9.2
    return (1.0 - x) * (0.39329 + 6.1174 * x - 5.7874 * x * x) / (1.0 + 19.838 * x);
}

glm::dvec3 sh_dc_factor(AmbientDiffuse form, double shininess, double x, const glm::dvec3& rho) {
    const double a = improved_a(shininess);
    const double b = shininess_b(shininess);
    switch (form) {
    case AmbientDiffuse::precise:
    case AmbientDiffuse::order1:
        break;
    case AmbientDiffuse::fit:
        return glm::dvec3(a + b * sh_k_fit(x));
    case AmbientDiffuse::coarse: // 9.3
        return glm::dvec3(a + 0.2623 * b * (1.0 - x));
    case AmbientDiffuse::coarsest:
        return glm::dvec3(1.0 - (0.3358 + 0.1977 * x) / (1.0 + 0.4597 * shininess));
    case AmbientDiffuse::full: // 9.2; A of the published model
        return shininess_a(shininess) + b * sh_k_full_fit(x) + 0.17 * rho / (1.0 + 0.065 * shininess);
    }
    return glm::dvec3(a + b * sh_k(x));
}

double sh_linear_factor(double shininess, double x) {
    // models.md section 9.4: S = f + (f - 1)(1 - x), f = 1 - 1/(2 + 0.65 shi)
    const double f = improved_a(shininess);
    return f + (f - 1.0) * (1.0 - x);
}

ShLinearExact sh_linear_exact(double shininess, double x) {
    // models.md section 9.5
    const double a = improved_a(shininess);
    const double b = shininess_b(shininess);
    const double s = sine(x);
    const double quotient = x < 1e-3 ? x * x / 3.0 : (std::asin(x) + s * x * (2.0 * x * x - 1.0)) / (8.0 * x);
    return {2.0 / 3.0 * a + 2.0 * b * s / pi * (s * s * s / 3.0 + quotient - pi / 16.0),
            0.5 * b * s * (2.0 / 3.0 - x + x * x * x / 3.0 + 0.25 * x * (1.0 + s * s) + 0.25)};
}

} // namespace clshade::reference
