// Integration of smooth functions of one variable.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace clshade::reference {

/// Nodes and weights of the Gauss-Legendre rule on [-1, 1]: exact for polynomials up to degree 2 Count - 1.
template <std::size_t Count>
struct GaussLegendre {
    std::array<double, Count> nodes{};
    std::array<double, Count> weights{};

    /// Roots of the Legendre polynomial by Newton's method from Tricomi's estimate.
    GaussLegendre() {
        constexpr auto n = static_cast<double>(Count);
        for (std::size_t i = 0; i < Count; ++i) {
            double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (n + 0.5));
            double slope = 1.0;
            for (int step = 0; step < 8; ++step) {
                double before = 1.0;
                double p = x;
                for (std::size_t k = 2; k <= Count; ++k) {
                    const auto degree = static_cast<double>(k);
                    const double next = ((2.0 * degree - 1.0) * x * p - (degree - 1.0) * before) / degree;
                    before = p;
                    p = next;
                }
                slope = n * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            nodes[i] = x;
            weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
        }
    }

    /// Integral of f from a to b, added up in a V (which starts as V(0)).
    template <class V, class F>
    [[nodiscard]] V integrate(double a, double b, const F& f) const {
        V sum(0.0);
        const double half = 0.5 * (b - a);
        for (std::size_t i = 0; i < Count; ++i) {
            sum += f(a + half * (1.0 + nodes[i])) * (weights[i] * half);
        }
        return sum;
    }
};

} // namespace clshade::reference
