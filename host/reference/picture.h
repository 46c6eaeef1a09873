// A lat-long picture in double precision: where its texels lie, halving and doubling, and what lies between texels
// (host/environment/lat_long.h and filter_layout.h, written anew).
#pragma once

#include "host/environment/lat_long.h"

#include <glm/glm.hpp>

#include <array>
#include <vector>

namespace clshade::reference {

/// Angles of texel centres in the image frame: x to the azimuth, 2 pi (0.5 - u) [pi .. -pi]; y to the polar angle.
[[nodiscard]] double azimuth_of_column(double x, int width);
[[nodiscard]] double polar_angle_of_row(double y, int height);
/// Unit vector at a polar angle from z and an azimuth.
[[nodiscard]] glm::dvec3 direction_of(double theta, double phi);

/// Solid angle of a texel of row y.
[[nodiscard]] double solid_angle_of_texel(int width, int height, int y);

struct Picture {
    int width = 0;
    int height = 0;
    std::vector<glm::dvec3> texels; ///< row by row

    Picture() = default;
    Picture(int w, int h);
    explicit Picture(const LatLong& image);

    [[nodiscard]] glm::dvec3& at(int x, int y);
    [[nodiscard]] const glm::dvec3& at(int x, int y) const;
    [[nodiscard]] bool even() const { return width % 2 == 0 && height % 2 == 0; }
};

/// Each texel the mean of four, weighted by their solid angles. Needs even().
[[nodiscard]] Picture halved(const Picture& picture);
/// Each texel becomes four, bilinearly between texel centres.
[[nodiscard]] Picture doubled(const Picture& picture);

/// Radiance along a direction of any length: bilinear between texel centres. u wraps; beyond a pole the row nearest to
/// it stands opposite.
[[nodiscard]] glm::dvec3 radiance_along(const LatLong& image, const glm::dvec3& direction);
[[nodiscard]] glm::dvec3 radiance_along(const Picture& picture, const glm::dvec3& direction);

} // namespace clshade::reference
