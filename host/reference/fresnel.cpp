#include "host/reference/fresnel.h"

#include <algorithm>
#include <cmath>

namespace clshade::reference {

glm::dvec3 schlick(const glm::dvec3& f0, double cosine) {
    // models.md section 1: F = F0 + (1 - F0) (1 - c)^5
    return f0 + (1.0 - f0) * std::pow(1.0 - cosine, 5.0);
}

glm::dvec3 schlick_gaussian(const glm::dvec3& f0, double cosine) {
    // models.md section 2: F = F0 + (1 - F0) 2^((-5.55473 c - 6.98316) c)
    return f0 + (1.0 - f0) * std::exp2((-5.55473 * cosine - 6.98316) * cosine);
}

double fresnel_dielectric(double n, double cosine) {
    // models.md section 5: g^2 = n^2 - 1 + c^2; rs = (c - g)/(c + g); rp = (n^2 c - g)/(n^2 c + g); F = (rs^2 + rp^2)/2
    if (n == 1.0) {
        return 0.0; // c = 0 would be 0/0
    }
    const double g2 = n * n - 1.0 + cosine * cosine;
    if (g2 <= 0.0 || std::isinf(g2)) {
        return 1.0; // total internal reflection; or a mirror
    }
    const double g = std::sqrt(g2);
    const double rs = (cosine - g) / (cosine + g);
    const double rp = (n * n * cosine - g) / (n * n * cosine + g);
    return 0.5 * (rs * rs + rp * rp);
}

double fresnel_conductor(double n, double k, double cosine) {
    // models.md section 4: with t = n^2 - k^2 - s2, q = sqrt(t^2 + 4 n^2 k^2) = a^2 + b^2, a^2 = (q + t)/2,
    //   Rs = (q - 2 a c + c^2)/(q + 2 a c + c^2),
    //   Rp = Rs (q c^2 - 2 a c s2 + s2^2)/(q c^2 + 2 a c s2 + s2^2), R = (Rs + Rp)/2,
    // written as squares of a -+ c and b, which do not cancel. Of a^2 and b^2 = (q - t)/2 the larger is a sum; the
    // other follows from a b = n k.
    if (n == 1.0 && k == 0.0) {
        return 0.0; // c = 0 would be 0/0
    }
    if (n == 0.0 && k == 0.0) {
        return 1.0; // seen from a medium of infinite index; c = 1 would be 0/0
    }
    const double c2 = cosine * cosine;
    const double s2 = 1.0 - c2;
    const double nk2 = n * n * k * k;
    const double t = n * n - k * k - s2;
    const double larger = 0.5 * (std::sqrt(t * t + 4.0 * nk2) + std::abs(t));
    const double smaller = larger > 0.0 ? nk2 / larger : 0.0;
    const double a = std::sqrt(t >= 0.0 ? larger : smaller);
    const double b2 = t >= 0.0 ? smaller : larger;
    const auto squared = [](double x) { return x * x; };
    const double rs = (squared(a - cosine) + b2) / (squared(a + cosine) + b2);
    const double rp = rs * (squared(a * cosine - s2) + b2 * c2) / (squared(a * cosine + s2) + b2 * c2);
    return 0.5 * (rs + rp);
}

double f0_between(double n1, double n2) {
    if (n1 == n2) {
        return 0.0;
    }
    if (std::isinf(n1) || std::isinf(n2)) {
        return 1.0;
    }
    const double r = (n2 - n1) / (n2 + n1);
    return r * r;
}

double index_of_f0(double f0) {
    // models.md section 5: "From an artist's F0 measured in air"
    return (1.0 + std::sqrt(f0)) / (1.0 - std::sqrt(f0));
}

double relative_index(double n1, double n2) {
    return n1 == n2 ? 1.0 : n2 / n1;
}

double refracted_cosine(double cosine, double m) {
    return m == 1.0 ? cosine : std::sqrt(1.0 - (1.0 - cosine * cosine) / (m * m));
}

double f_bottom_exact(double n1, double n2, double cosine) {
    const double inside = refracted_cosine(cosine, n1);
    return (1.0 - fresnel_dielectric(n1, cosine)) * fresnel_dielectric(n2 / n1, inside) *
           (1.0 - fresnel_dielectric(1.0 / n1, inside));
}

double f_bottom_constant(double n1, double n2) {
    return f0_between(n1, n2) * (1.0 - f0_between(n1, 1.0));
}

} // namespace clshade::reference
