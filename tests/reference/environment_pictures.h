// Environments made by formula.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/reference/picture.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cstdint>
#include <memory>
#include <random>

namespace clshade::reference {

/// A lat-long picture of a function of the direction (image frame).
template <class F>
std::shared_ptr<const LatLong> picture_of(int height, const F& radiance) {
    auto image = std::make_shared<LatLong>();
    image->name = "formula";
    image->width = 2 * height;
    image->height = height;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < image->width; ++x) {
            const glm::dvec3 d = direction_of(polar_angle_of_row(y, height), azimuth_of_column(x, image->width));
            const glm::dvec3 rgb = radiance(d);
            for (int i = 0; i < 3; ++i) {
                image->rgb.push_back(static_cast<float>(rgb[i]));
            }
        }
    }
    return image;
}

inline std::shared_ptr<const LatLong> constant_picture(const glm::dvec3& radiance, int height = 64) {
    return picture_of(height, [&](const glm::dvec3&) { return radiance; });
}

/// Every texel on its own, 0..1.
inline std::shared_ptr<const LatLong> random_picture(int height, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto value = [&] { return static_cast<double>(random()) / 4294967296.0; };
    return picture_of(height, [&](const glm::dvec3&) { return glm::dvec3(value(), value(), value()); });
}

/// Smooth, coloured, positive: bands 0 to 2 and a little more.
inline glm::dvec3 smooth_radiance(const glm::dvec3& d) {
    return {1.0 + 0.5 * d.z + 0.3 * d.x * d.y, 0.8 - 0.4 * d.x + 0.2 * d.z * d.z, 0.6 + 0.3 * d.y + 0.2 * d.x * d.z};
}

inline BoundEnvironment environment_of(const std::shared_ptr<const LatLong>& image) {
    BoundEnvironment environment;
    environment.image = image;
    return environment;
}

inline glm::dmat3 rotation_about(const glm::dvec3& axis, double angle) {
    return glm::dmat3(glm::rotate(glm::dmat4(1.0), angle, glm::normalize(axis)));
}

} // namespace clshade::reference
