// The built-in studio: soft boxes in a room with a sweep of paper for a floor, all by formula.
#include "host/environment/lat_long.h"

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>

namespace clshade {

namespace {

// Directions here: +X right, +Y up, +Z from the object towards the camera.

/// 3 t^2 - 2 t^3 of where x lies between the edges.
double smoothstep(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// A flat panel of light at distance 1 that faces the object.
struct SoftBox {
    glm::dvec3 centre; ///< direction, any length
    double half_width; ///< horizontally
    double half_height;
    double edge;       ///< over which it fades out, inwards
    double falloff;    ///< part of the brightness that its corners lack
    glm::dvec3 colour; ///< radiance at its centre
};

/// Radiance of the box towards the object from direction d (unit).
glm::dvec3 radiance_of(const SoftBox& box, const glm::dvec3& d) {
    const glm::dvec3 axis = glm::normalize(box.centre);
    const double depth = glm::dot(d, axis);
    if (depth <= 0.0) {
        return glm::dvec3(0.0);
    }
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), axis));
    const double x = std::abs(glm::dot(d, right) / depth);
    const double y = std::abs(glm::dot(d, glm::cross(axis, right)) / depth);
    const double inside = smoothstep(box.half_width, box.half_width - box.edge, x) *
                          smoothstep(box.half_height, box.half_height - box.edge, y);
    const double from_centre =
        (x * x / (box.half_width * box.half_width) + y * y / (box.half_height * box.half_height));
    return box.colour * inside * (1.0 - 0.5 * box.falloff * std::min(from_centre, 2.0));
}

/// Grey walls, lighter towards the ceiling; a dark floor that runs up into them without an edge.
glm::dvec3 room(const glm::dvec3& d) {
    const glm::dvec3 floor = glm::dvec3(0.020, 0.019, 0.018);
    const glm::dvec3 wall = glm::dvec3(0.115, 0.120, 0.130);
    const glm::dvec3 ceiling = glm::dvec3(0.240, 0.245, 0.255);
    const glm::dvec3 above = glm::mix(wall, ceiling, smoothstep(0.0, 1.0, d.y));
    return glm::mix(floor, above, smoothstep(-0.45, 0.10, d.y));
}

const std::array<SoftBox, 4>& soft_boxes() {
    static const std::array<SoftBox, 4> boxes{{
        // Key: large, warm, over the camera's left shoulder.
        {{-0.62, 0.62, 0.66}, 0.29, 0.25, 0.06, 0.45, {20.0, 17.6, 14.6}},
        // Fill: broad, cool, from the right and a little behind the object, so that it edges it.
        {{0.96, 0.16, 0.16}, 0.30, 0.62, 0.10, 0.30, {1.9, 2.3, 2.9}},
        // Strip behind the object, upright, on the left: the rim light.
        {{-0.72, 0.26, -0.66}, 0.055, 0.75, 0.035, 0.25, {8.6, 8.8, 9.2}},
        // Panel overhead, long from left to right.
        {{0.10, 0.96, -0.34}, 0.62, 0.16, 0.08, 0.30, {3.0, 3.0, 3.0}},
    }};
    return boxes;
}

} // namespace

LatLong built_in_studio(int height) {
    if (height < 8) {
        throw std::invalid_argument(fmt::format("a studio of {} rows; at least 8", height));
    }
    LatLong image;
    image.name = "studio";
    image.width = 2 * height;
    image.height = height;
    image.up = UpAxis::y;
    image.rgb.reserve(static_cast<std::size_t>(height) * static_cast<std::size_t>(height) * 6);
    for (int y = 0; y < height; ++y) {
        const double theta = std::numbers::pi * (y + 0.5) / height;
        for (int x = 0; x < image.width; ++x) {
            const double phi = std::numbers::pi * (1.0 - 2.0 * (x + 0.5) / image.width);
            // Row 0 lies at +Y, and +Z stands in the picture's middle (conventions.md section 4).
            const glm::dvec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
            glm::dvec3 radiance = room(d);
            for (const SoftBox& box : soft_boxes()) {
                radiance += radiance_of(box, d);
            }
            image.rgb.insert(image.rgb.end(), {static_cast<float>(radiance.r), static_cast<float>(radiance.g),
                                               static_cast<float>(radiance.b)});
        }
    }
    return image;
}

} // namespace clshade
