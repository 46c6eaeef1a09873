#include "host/shading/metal_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace clshade {

namespace {

constexpr int first_wavelength = 380;
constexpr int last_wavelength = 780;
constexpr int wavelength_step = 5;
constexpr double wanted_error = 1e-6;
constexpr int test_points = 400;

/// Wyman, Sloan, Shirley 2013: a Gaussian with its own width on each side.
double two_sided_gaussian(double x, double mean, double below, double above) {
    const double t = (x - mean) * (x < mean ? below : above);
    return std::exp(-0.5 * t * t);
}

/// Colour-matching functions of linear sRGB at a wavelength in nm.
glm::dvec3 matching_rgb(double w) {
    const double x = 0.362 * two_sided_gaussian(w, 442.0, 0.0624, 0.0374) +
                     1.056 * two_sided_gaussian(w, 599.8, 0.0264, 0.0323) -
                     0.065 * two_sided_gaussian(w, 501.1, 0.0490, 0.0382);
    const double y =
        0.821 * two_sided_gaussian(w, 568.8, 0.0213, 0.0247) + 0.286 * two_sided_gaussian(w, 530.9, 0.0613, 0.0322);
    const double z =
        1.217 * two_sided_gaussian(w, 437.0, 0.0845, 0.0278) + 0.681 * two_sided_gaussian(w, 459.0, 0.0385, 0.0725);
    return {3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
            0.0557 * x - 0.2040 * y + 1.0570 * z};
}

/// n + i k at a wavelength: linear between samples, clamped outside.
std::complex<double> index_at(const Metal& metal, double wavelength) {
    const auto& samples = metal.samples;
    const auto above = std::lower_bound(samples.begin(), samples.end(), wavelength,
                                        [](const ComplexIndex& s, double w) { return s.wavelength < w; });
    if (above == samples.begin()) {
        return {above->n, above->k};
    }
    if (above == samples.end()) {
        return {samples.back().n, samples.back().k};
    }
    const ComplexIndex& low = *(above - 1);
    const double t = (wavelength - low.wavelength) / (above->wavelength - low.wavelength);
    return {low.n + t * (above->n - low.n), low.k + t * (above->k - low.k)};
}

/// Unpolarised reflectance between a dielectric and a conductor of relative index m, from the complex amplitudes
/// rs = (c - m c') / (c + m c') and rp = (m c - c') / (m c + c') with m c' = sqrt(m^2 - 1 + c^2); models.md section 4
/// has the same in real numbers.
double conductor_reflectance(std::complex<double> m, double c) {
    if (m == 1.0) {
        return 0.0; // no interface; c = 0 would be 0/0
    }
    const std::complex<double> mc = std::sqrt(m * m - 1.0 + c * c);
    const std::complex<double> m2 = m * m;
    const double rs = c == 0.0 ? 1.0 : std::norm((c - mc) / (c + mc));
    const double rp = c == 0.0 ? 1.0 : std::norm((m2 * c - mc) / (m2 * c + mc));
    return 0.5 * (rs + rp);
}

double refracted_cosine(double c, double index) {
    return std::sqrt(1.0 - (1.0 - c * c) / (index * index));
}

/// A candidate curve: Chebyshev interpolation in x, turned into powers of x.
MetalCurve interpolate(const Metal& metal, const MetalSurroundings& where, double bend, int count) {
    std::vector<glm::dvec3> values;
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) {
        angles.push_back(std::numbers::pi * (i + 0.5) / count);
        const double t = 0.5 * (std::cos(angles.back()) + 1.0);
        values.push_back(metal_reflectance(metal, where, bend * t / (1.0 + bend - t)));
    }
    MetalCurve curve;
    curve.bend = bend;
    curve.coefficients.assign(static_cast<std::size_t>(count), glm::dvec3(0.0));
    // T_0 = 1, T_1 = x, T_(k+1) = 2 x T_k - T_(k-1), as powers of x
    std::vector<double> before(static_cast<std::size_t>(count), 0.0);
    std::vector<double> now{1.0};
    now.resize(static_cast<std::size_t>(count), 0.0);
    for (int k = 0; k < count; ++k) {
        glm::dvec3 weight(0.0);
        for (std::size_t i = 0; i < values.size(); ++i) {
            weight += values[i] * std::cos(k * angles[i]);
        }
        weight *= (k == 0 ? 1.0 : 2.0) / count;
        std::vector<double> next(now.size(), 0.0);
        for (std::size_t p = 0; p < now.size(); ++p) {
            curve.coefficients[p] += weight * now[p];
            next[p] = (p > 0 ? (k == 0 ? 1.0 : 2.0) * now[p - 1] : 0.0) - before[p];
        }
        before = now;
        now = next;
    }
    return curve;
}

/// As the kernel evaluates it.
float evaluate(const MetalCurve& curve, double c, int channel) {
    const auto bend = static_cast<float>(curve.bend);
    const auto cosine = static_cast<float>(c);
    const float x = std::fma(cosine / (cosine + bend), 2.0F * (1.0F + bend), -1.0F);
    float value = 0.0F;
    for (std::size_t i = curve.coefficients.size(); i-- > 0;) {
        value = std::fma(value, x, static_cast<float>(curve.coefficients[i][channel]));
    }
    return value;
}

using Truth = std::array<glm::dvec3, test_points + 1>;

double largest_error(const MetalCurve& curve, const Truth& truth) {
    double largest = 0.0;
    for (int i = 0; i <= test_points; ++i) {
        const double c = static_cast<double>(i) / test_points;
        for (int channel = 0; channel < 3; ++channel) {
            largest = std::max(largest, std::abs(static_cast<double>(evaluate(curve, c, channel)) -
                                                 truth[static_cast<std::size_t>(i)][channel]));
        }
    }
    return largest;
}

} // namespace

glm::dvec3 metal_reflectance(const Metal& metal, const MetalSurroundings& where, double c) {
    glm::dvec3 weighted(0.0);
    glm::dvec3 weights(0.0);
    const bool same = where.index == glm::dvec3(where.index.x) && where.constant == glm::bvec3(where.constant.x);
    for (int w = first_wavelength; w <= last_wavelength; w += wavelength_step) {
        const glm::dvec3 matching = matching_rgb(w);
        const std::complex<double> index = index_at(metal, w);
        double reflectance = 0.0;
        for (int channel = 0; channel < 3; ++channel) {
            if (channel == 0 || !same) {
                const double medium = where.index[channel];
                const double inside = where.refracted ? refracted_cosine(c, medium) : c;
                reflectance = conductor_reflectance(index / medium, where.constant[channel] ? 1.0 : inside);
            }
            weighted[channel] += matching[channel] * reflectance;
        }
        weights += matching;
    }
    return weighted / weights;
}

MetalCurve fit_metal_curve(const Metal& metal, const MetalSurroundings& where) {
    Truth truth{};
    for (int i = 0; i <= test_points; ++i) {
        truth[static_cast<std::size_t>(i)] = metal_reflectance(metal, where, static_cast<double>(i) / test_points);
    }
    MetalCurve best;
    best.error = 1e30;
    for (const int count : {12, 16, 20, 24, 32, 40}) {
        for (const double bend : {0.1, 0.2, 0.35, 0.6, 1.0, 3.0}) {
            MetalCurve curve = interpolate(metal, where, bend, count);
            curve.error = largest_error(curve, truth);
            if (curve.error < best.error) {
                best = std::move(curve);
            }
        }
        if (best.error <= wanted_error) {
            break;
        }
    }
    return best;
}

} // namespace clshade
