#include "host/reference/preintegrated_absorption.h"

#include <algorithm>
#include <cmath>

namespace clshade::reference {

namespace {

double clamped_diffuse(double a, double ne) {
    const double c = 1.0 - a / ne;
    return c > a ? (c - a) * (c - a) / c : 0.0;
}

} // namespace

double exponential_integral_3(double a) {
    // models.md section 7: E_3(a) = (e^-a (1 - a) + a^2 E_1(a))/2 with E_1(a) = -Ei(-a). For large a the
    // sum cancels; from a = 2 on the continued fraction e^-a/(a + 3/(1 + 1/(a + 4/(1 + 2/(a + ...))))) converges fast.
    if (a == 0.0) {
        return 0.5;
    }
    if (a < 2.0) {
        return 0.5 * (std::exp(-a) * (1.0 - a) - a * a * std::expint(-a));
    }
    double fraction = a;
    for (int k = 60; k >= 1; --k) {
        fraction = a + (2.0 + k) / (1.0 + k / fraction);
    }
    return std::exp(-a) / fraction;
}

PreintegratedAbsorption preintegrated_absorption(AmbientAbsorption form, const glm::dvec3& a, double ne) {
    PreintegratedAbsorption result;
    for (int i = 0; i < 3; ++i) {
        switch (form) {
        case AmbientAbsorption::deck:
            result.specular[i] = std::max(0.0, 1.0 - 2.0 * a[i] / ne);
            result.diffuse[i] = std::max(0.0, 1.0 - a[i] * (2.0 + 1.0 / ne));
            break;
        case AmbientAbsorption::clamped:
            result.specular[i] = std::max(0.0, 1.0 - 2.0 * a[i] / ne);
            result.diffuse[i] = clamped_diffuse(a[i], ne);
            break;
        case AmbientAbsorption::exponential:
            result.specular[i] = std::exp(-2.0 * a[i] / ne);
            result.diffuse[i] = 2.0 * exponential_integral_3(a[i]) * std::exp(-a[i] / ne);
            break;
        }
    }
    return result;
}

} // namespace clshade::reference
