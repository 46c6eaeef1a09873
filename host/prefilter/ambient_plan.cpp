#include "host/prefilter/ambient_plan.h"

#include "host/environment/filter_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace clshade {

namespace {

constexpr double pi = std::numbers::pi;
/// As in kernels/ambient_brdf.cl.
constexpr int polar_nodes = 32;
constexpr int azimuth_nodes = 16;
/// Half vectors with NH^n below e^-32 are left out: 2e-8 of the bias even where all of it comes from wide angles.
constexpr double reach_exponent = 32.0;
constexpr double smallest_cosine = 1e-4;
static_assert(ambient_pitch > ambient_cosines && ambient_pitch % 16 == 0);

void append(std::vector<float>& out, const Nodes& nodes) {
    for (std::size_t i = 0; i < nodes.positions.size(); ++i) {
        out.push_back(static_cast<float>(nodes.positions[i]));
        out.push_back(static_cast<float>(nodes.weights[i]));
    }
}

struct LegendreValue {
    double value;
    double slope;
};

LegendreValue legendre(int degree, double x) {
    double before = 1.0;
    double value = x;
    for (int k = 2; k <= degree; ++k) {
        const double next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k;
        before = value;
        value = next;
    }
    return {value, degree * (x * value - before) / (x * x - 1.0)};
}

} // namespace

Nodes gauss_legendre(int count) {
    Nodes nodes;
    for (int i = 0; i < count; ++i) {
        double x = -std::cos(pi * (i + 0.75) / (count + 0.5)); // near the i-th root; Newton's steps do the rest
        for (int step = 0; step < 8; ++step) {
            const LegendreValue p = legendre(count, x);
            x -= p.value / p.slope;
        }
        const double slope = legendre(count, x).slope;
        nodes.positions.push_back(0.5 + 0.5 * x);
        nodes.weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
    }
    return nodes;
}

Nodes crowded_nodes(int count) {
    Nodes nodes = gauss_legendre(count);
    for (std::size_t i = 0; i < nodes.positions.size(); ++i) {
        const double t = nodes.positions[i];
        nodes.positions[i] = std::pow(std::sin(pi * t / 2.0), 2.0);
        nodes.weights[i] *= pi / 2.0 * std::sin(pi * t);
    }
    return nodes;
}

std::vector<float> ambient_nodes() {
    std::vector<float> values;
    append(values, crowded_nodes(polar_nodes));
    append(values, gauss_legendre(azimuth_nodes));
    return values;
}

std::vector<float> ambient_eyes() {
    std::vector<float> values(3 * std::size_t{ambient_pitch});
    for (std::size_t i = 0; i < ambient_pitch; ++i) {
        const double share = static_cast<double>(std::min<std::size_t>(i, ambient_cosines)) / ambient_cosines;
        const double cosine = std::max(share, smallest_cosine);
        values[i] = static_cast<float>(cosine);
        values[ambient_pitch + i] = static_cast<float>(std::sqrt((1.0 - cosine) * (1.0 + cosine)));
        values[2 * std::size_t{ambient_pitch} + i] = static_cast<float>(std::acos(cosine));
    }
    return values;
}

double ambient_shininess(int j) {
    return std::exp2(ambient_octaves * j / ambient_exponents) - 1.0;
}

double exact_normaliser(double shininess) {
    return (shininess + 2.0) / (4.0 * pi * (2.0 - std::exp2(-0.5 * shininess)));
}

double linear_normaliser(double shininess) {
    return 0.0397436 * shininess + 0.0856832;
}

std::vector<AmbientRow> ambient_rows(bool linear) {
    std::vector<AmbientRow> rows;
    for (int j = 0; j <= ambient_exponents; ++j) {
        const double n = ambient_shininess(j);
        const double reach = n > 0.0 ? std::min(pi, std::sqrt(2.0 * reach_exponent / n)) : pi;
        // dw_L = 4 EH dw_H, and both signs of the azimuth.
        const double factor = 8.0 * (linear ? linear_normaliser(n) : exact_normaliser(n));
        rows.push_back({static_cast<float>(n / 2.0), static_cast<float>(reach), static_cast<float>(factor)});
    }
    return rows;
}

} // namespace clshade
