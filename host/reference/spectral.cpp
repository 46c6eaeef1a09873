#include "host/reference/spectral.h"

#include "host/reference/fresnel.h"

#include <algorithm>
#include <cmath>

namespace clshade::reference {

namespace {

/// g(x; m, s1, s2) = exp(-((x - m) s)^2 / 2), s = s1 below m and s2 from m upwards.
double skewed_gaussian(double x, double m, double s1, double s2) {
    const double scaled = (x - m) * (x < m ? s1 : s2);
    return std::exp(-0.5 * scaled * scaled);
}

} // namespace

double wavelength(std::size_t i) {
    return 380.0 + 5.0 * static_cast<double>(i);
}

glm::dvec3 cmf_fit_xyz(double nanometres) {
    const auto g = [&](double m, double s1, double s2) { return skewed_gaussian(nanometres, m, s1, s2); };
    return {0.362 * g(442.0, 0.0624, 0.0374) + 1.056 * g(599.8, 0.0264, 0.0323) - 0.065 * g(501.1, 0.0490, 0.0382),
            0.821 * g(568.8, 0.0213, 0.0247) + 0.286 * g(530.9, 0.0613, 0.0322),
            1.217 * g(437.0, 0.0845, 0.0278) + 0.681 * g(459.0, 0.0385, 0.0725)};
}

glm::dvec3 srgb_of_xyz(const glm::dvec3& xyz) {
    return {glm::dot(glm::dvec3(3.2406, -1.5372, -0.4986), xyz), glm::dot(glm::dvec3(-0.9689, 1.8758, 0.0415), xyz),
            glm::dot(glm::dvec3(0.0557, -0.2040, 1.0570), xyz)};
}

ComplexIndex index_at(const Metal& metal, double nanometres) {
    const auto& samples = metal.samples;
    const auto after =
        std::upper_bound(samples.begin(), samples.end(), nanometres,
                         [](double value, const ComplexIndex& sample) { return value < sample.wavelength; });
    if (after == samples.begin() || after == samples.end()) {
        const ComplexIndex& end = after == samples.begin() ? samples.front() : samples.back();
        return {nanometres, end.n, end.k};
    }
    const ComplexIndex& left = *(after - 1);
    const double t = (nanometres - left.wavelength) / (after->wavelength - left.wavelength);
    return {nanometres, left.n + t * (after->n - left.n), left.k + t * (after->k - left.k)};
}

SpectralMetal::SpectralMetal(const Metal& metal) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < wavelength_count; ++i) {
        const ComplexIndex index = index_at(metal, wavelength(i));
        n_[i] = index.n;
        k_[i] = index.k;
        weights_[i] = srgb_of_xyz(cmf_fit_xyz(wavelength(i)));
        sum += weights_[i];
    }
    for (glm::dvec3& weight : weights_) {
        weight /= sum;
    }
    f0_ = reflectance(1.0);
}

glm::dvec3 SpectralMetal::reflectance(const glm::dvec3& medium, const glm::dvec3& cosine) const {
    glm::dvec3 sum(0.0);
    if (medium == glm::dvec3(medium.x) && cosine == glm::dvec3(cosine.x)) {
        for (std::size_t i = 0; i < wavelength_count; ++i) {
            sum += weights_[i] * fresnel_conductor(n_[i] / medium.x, k_[i] / medium.x, cosine.x);
        }
    } else {
        for (int j = 0; j < 3; ++j) {
            for (std::size_t i = 0; i < wavelength_count; ++i) {
                sum[j] += weights_[i][j] * fresnel_conductor(n_[i] / medium[j], k_[i] / medium[j], cosine[j]);
            }
        }
    }
    return glm::clamp(sum, 0.0, 1.0);
}

} // namespace clshade::reference
