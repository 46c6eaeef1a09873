#include "host/shading/layer_constants.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clshade {

double folded_normaliser_exact(double n) {
    return (n + 2.0) / (4.0 * std::numbers::pi * (2.0 - std::exp2(-0.5 * n)));
}

double folded_normaliser_linear(double n) {
    return 0.0397436 * n + 0.0856832;
}

double folded_normaliser_anisotropic(double n_u, double n_v) {
    const double a = n_u + 2.0;
    const double b = n_v + 2.0;
    const double w = 0.25 * (std::exp2(-0.5 * a) + 2.0 * std::exp2(-a * b / (a + b)) + std::exp2(-0.5 * b));
    return std::sqrt(a * b) / (8.0 * std::numbers::pi * (1.0 - w));
}

glm::dvec3 amplitude_of(const glm::dvec3& f0) {
    return glm::sqrt(f0);
}

glm::dvec3 index_of(const glm::dvec3& amplitude) {
    glm::dvec3 index;
    for (int c = 0; c < 3; ++c) {
        index[c] = (1.0 + amplitude[c]) / std::max(1.0 - amplitude[c], 1e-12);
    }
    return index;
}

glm::dvec3 folded_medium(const glm::dvec3& amplitude, const glm::dvec3& above) {
    glm::dvec3 medium;
    for (int c = 0; c < 3; ++c) {
        medium[c] = amplitude[c] > 0.0 ? amplitude[c] : above[c];
    }
    return medium;
}

glm::dvec3 folded_reflectance(const glm::dvec3& above, const glm::dvec3& below) {
    const glm::dvec3 amplitude = (below - above) / glm::max(1.0 - below * above, glm::dvec3(1e-12));
    return amplitude * amplitude;
}

glm::dvec3 folded_gain(const glm::dvec3& r, const glm::dvec3& amplitude, const glm::dvec3& above, bool is_base) {
    glm::dvec3 gain(0.0);
    for (int c = 0; c < 3; ++c) {
        if (above[c] == 0.0 && (is_base || amplitude[c] > 0.0)) {
            gain[c] = 1.0 - r[c];
        }
    }
    return gain;
}

glm::dvec3 folded_approximate_absorption(const glm::dvec3& depth) {
    glm::dvec3 a;
    for (int c = 0; c < 3; ++c) {
        a[c] = -0.5 * std::expm1(-2.0 * depth[c]);
    }
    return a;
}

glm::dvec3 folded_diffuse_transmittance(const glm::dvec3& absorption) {
    glm::dvec3 left(1.0);
    for (int c = 0; c < 3; ++c) {
        const double a = absorption[c];
        if (a > 0.0) { // 2 E_3 = e^-a (1 - a) + a^2 E_1, which cancels to nothing for large a
            left[c] = std::max(0.0, std::exp(-a) * (1.0 - a) - a * a * std::expint(-a));
        }
    }
    return left;
}

} // namespace clshade
