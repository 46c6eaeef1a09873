// Filtering a picture with a lobe, one direction at a time: direct summation over its texels (models.md section 6).
#pragma once

#include "host/reference/picture.h"

#include <glm/glm.hpp>

#include <array>
#include <vector>

namespace clshade::reference {

/// The lobe of the filtered radiance, p_n(c) = (n+2)/(8 pi) ((1+c)/2)^(n/2), c = R.w.
[[nodiscard]] double radiance_lobe(double n, double c);

/// Level between which a shininess is looked up: clamp(log2(n_max/max(n, 1))/octaves, 0, mip_max), where n falls by
/// 2^octaves a level. Levels of filter_layout.h: octaves = 1; models.md sketches 2.
[[nodiscard]] double mip_of_shininess(double n, double n_max, double mip_max, double octaves);

/// A picture laid out for summation.
class FilterSource {
  public:
    explicit FilterSource(const Picture& picture);

    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int width() const { return width_; }
    /// Mean of the picture under the lobe p_n about a unit vector, n = 2^(squarings + 1); squarings = -1: n = 1. Texels
    /// beyond n theta^2/8 = 21 are left out.
    [[nodiscard]] glm::dvec3 radiance(const glm::dvec3& direction, int squarings) const;
    /// E/pi: the mean under max(0, N.w).
    [[nodiscard]] glm::dvec3 irradiance_over_pi(const glm::dvec3& normal) const;

  private:
    template <class Kernel>
    [[nodiscard]] glm::dvec3 mean_under(const glm::dvec3& direction, double reach, const Kernel& kernel) const;

    int width_;
    int height_;
    std::array<std::vector<double>, 3> rgb_;
    std::vector<double> cos_phi_;
    std::vector<double> sin_phi_;
};

/// The pictures that filter_layout.h has the levels filtered from, and the irradiance map.
[[nodiscard]] Picture enlarged(Picture picture);
/// May (and must) the picture be halved for a lobe of this shininess?
[[nodiscard]] bool halves_for(const Picture& picture, double shininess);

} // namespace clshade::reference
