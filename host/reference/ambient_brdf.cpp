#include "host/reference/ambient_brdf.h"

#include "host/environment/filter_layout.h"
#include "host/reference/blinn_phong.h"
#include "host/reference/quadrature.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace clshade::reference {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double smallest_cosine = 1e-4; // rule 11
constexpr std::size_t columns = ambient_cosines + 1;
constexpr std::size_t rows = ambient_exponents + 1;

const GaussLegendre<20>& rule_of_theta() {
    static const GaussLegendre<20> rule;
    return rule;
}

/// Over the azimuth integrands are trigonometric polynomials of degree 7 or little more: 16 nodes leave 1e-11.
const GaussLegendre<16>& rule_of_phi() {
    static const GaussLegendre<16> rule;
    return rule;
}

/// The view that an integral over half vectors is for. H stands at polar angle theta and azimuth phi from E:
/// EH = NE cos(theta) + sin(te) sin(theta) cos(phi), NL = 2 EH cos(theta) - NE, dw_L = 4 EH dw_H.
struct HalfVectors {
    double ne = 1.0;
    double sin_te = 0.0;
    double te = 0.0;

    explicit HalfVectors(double cosine)
        : ne(cosine), sin_te(std::sqrt(std::max(1.0 - cosine * cosine, 0.0))), te(std::acos(cosine)) {}

    /// Up to here some light is above the surface.
    [[nodiscard]] double largest_theta() const { return 0.5 * (0.5 * pi + te); }
    /// Up to here all of it is.
    [[nodiscard]] double full_circle() const { return 0.5 * (0.5 * pi - te); }
    /// Azimuth at which N.L = N.E; larger N.L below it.
    [[nodiscard]] double equal_azimuth(double theta) const {
        return theta < te ? std::acos(std::min(std::tan(theta) * ne / sin_te, 1.0)) : 0.0;
    }
    /// Azimuth at which N.L = 0.
    [[nodiscard]] double horizon_azimuth(double theta) const {
        if (theta <= full_circle()) {
            return pi;
        }
        const double c = std::cos(theta);
        const double sines = std::max(sin_te * std::sin(theta), 1e-300); // 0 where E = N
        return std::acos(std::clamp((0.5 * ne / c - ne * c) / sines, -1.0, 1.0));
    }
};

/// Where the integrand over theta bends: the ends of the azimuth's cases, distances growing by three from where the
/// full circle and the light end (at grazing view they are measured in small angles), and the lobe's width.
std::vector<double> bends(const HalfVectors& view, double n) {
    // cos^n below e^-45 counts for nothing.
    const double end = n > 0.0 ? std::min(view.largest_theta(), std::acos(std::exp(-45.0 / n))) : view.largest_theta();
    std::vector<double> at{0.0, view.full_circle(), view.te, end};
    for (double distance = 3.0 * view.full_circle(); distance < end; distance *= 3.0) {
        at.push_back(distance);
        at.push_back(view.largest_theta() - distance);
    }
    for (const double widths : {1.5, 3.0, 5.0}) {
        at.push_back(widths / std::sqrt(n + 1.0));
    }
    const auto out = [&](double theta) { return theta < 0.0 || theta > end; };
    at.erase(std::remove_if(at.begin(), at.end(), out), at.end());
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    return at;
}

/// Norm int NH^n min(1, NL/NE) f(EH) dw_L with the exact normaliser.
template <class V, class F>
V integrate_lobe(double n, double ne, const F& f) {
    const HalfVectors view(ne);
    const auto ring = [&](double theta) {
        const double c = std::cos(theta);
        const double s = std::sin(theta);
        const auto half_cosine = [&](double phi) { return ne * c + view.sin_te * s * std::cos(phi); };
        const auto unbounded = [&](double phi) {
            const double eh = half_cosine(phi);
            return f(eh) * eh;
        };
        const auto shadowed = [&](double phi) {
            const double eh = half_cosine(phi);
            return f(eh) * (eh * (2.0 * eh * c - ne) / ne);
        };
        const double equal = view.equal_azimuth(theta);
        const V sum = rule_of_phi().integrate<V>(0.0, equal, unbounded) +
                      rule_of_phi().integrate<V>(equal, view.horizon_azimuth(theta), shadowed);
        const double lobe_at = std::exp(0.5 * n * std::log1p(-s * s));
        return sum * (8.0 * lobe_at * s); // 4 EH dw_H; both halves of the circle
    };
    V sum(0.0);
    const std::vector<double> at = bends(view, n);
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
        // The azimuth's limits end in square roots: theta = a + (b - a) sin^2(t) makes them smooth.
        const double a = at[i];
        const double width = at[i + 1] - at[i];
        const auto smoothed = [&](double t) {
            const double s = std::sin(t);
            return ring(a + width * s * s) * (2.0 * width * s * std::cos(t));
        };
        sum += rule_of_theta().integrate<V>(0.0, 0.5 * pi, smoothed);
    }
    return sum * normaliser_exact(n);
}

/// What turns the exact normaliser into the wanted one.
double normaliser_ratio(double n, Normaliser normaliser) {
    return normaliser == Normaliser::exact ? 1.0 : normaliser_linear(n) / normaliser_exact(n);
}

/// x: scale, y: bias.
glm::dvec2 schlick_integral(double n, double ne) {
    return integrate_lobe<glm::dvec2>(n, ne, [](double eh) {
        const double w = 1.0 - eh;
        const double fc = w * w * w * w * w;
        return glm::dvec2(1.0 - fc, fc);
    });
}

double vertex_shininess(std::size_t j) {
    return std::exp2(ambient_octaves * static_cast<double>(j) / ambient_exponents) - 1.0;
}

double vertex_cosine(std::size_t i) {
    return std::max(static_cast<double>(i) / ambient_cosines, smallest_cosine);
}

/// Bilinear among the vertices of filter_layout.h; `integral(n, ne)` is for the exact normaliser.
template <class V, class F>
V bilinear(const LazyTable<V>& vertices, double n, double ne, Normaliser normaliser, const F& integral) {
    const auto vertex = [&](std::size_t i, std::size_t j) {
        const double shininess = vertex_shininess(j);
        const auto make = [&] { return integral(shininess, vertex_cosine(i)); };
        return vertices.at(j * columns + i, make) * normaliser_ratio(shininess, normaliser);
    };
    const double highest = vertex_shininess(rows - 1);
    const double px = ne * ambient_cosines;
    const double py = std::log2(std::min(n, highest) + 1.0) / ambient_octaves * ambient_exponents;
    const auto i = std::min(static_cast<std::size_t>(px), columns - 2);
    const auto j = std::min(static_cast<std::size_t>(py), rows - 2);
    const double u = px - static_cast<double>(i);
    const double v = py - static_cast<double>(j);
    return (vertex(i, j) * (1.0 - u) + vertex(i + 1, j) * u) * (1.0 - v) +
           (vertex(i, j + 1) * (1.0 - u) + vertex(i + 1, j + 1) * u) * v;
}

constexpr std::size_t curve_cells = 2048;

} // namespace

AmbientBrdf ambient_brdf(double n, double ne, Normaliser normaliser) {
    const glm::dvec2 both = schlick_integral(n, ne) * normaliser_ratio(n, normaliser);
    return {both.x, both.y};
}

AmbientBrdf ambient_brdf_of_table(double n, double ne, Normaliser normaliser) {
    static const LazyTable<glm::dvec2> vertices(columns * rows);
    const glm::dvec2 both = bilinear(vertices, n, ne, normaliser, schlick_integral);
    return {both.x, both.y};
}

MetalAmbient::MetalAmbient(const SpectralMetal& metal) : vertices_(columns * rows) {
    for (std::size_t i = 0; i <= curve_cells; ++i) {
        curve_.push_back(metal.reflectance(static_cast<double>(i) / curve_cells));
    }
}

glm::dvec3 MetalAmbient::reflectance(double cosine) const {
    // Lagrange's cubic through four neighbours; at the ends the outermost four.
    const double p = std::clamp(cosine, 0.0, 1.0) * curve_cells;
    const auto i = std::clamp(static_cast<std::size_t>(p), std::size_t{1}, curve_cells - 2);
    const double t = p - static_cast<double>(i);
    return curve_[i - 1] * (-t * (t - 1.0) * (t - 2.0) / 6.0) + curve_[i] * ((t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0) +
           curve_[i + 1] * (-(t + 1.0) * t * (t - 2.0) / 2.0) + curve_[i + 2] * ((t + 1.0) * t * (t - 1.0) / 6.0);
}

glm::dvec3 MetalAmbient::integrated(double n, double ne, Normaliser normaliser) const {
    return integrate_lobe<glm::dvec3>(n, ne, [this](double eh) { return reflectance(eh); }) *
           normaliser_ratio(n, normaliser);
}

glm::dvec3 MetalAmbient::of_table(double n, double ne, Normaliser normaliser) const {
    const auto integral = [this](double shininess, double cosine) {
        return integrated(shininess, cosine, Normaliser::exact);
    };
    return bilinear(vertices_, n, ne, normaliser, integral);
}

} // namespace clshade::reference
