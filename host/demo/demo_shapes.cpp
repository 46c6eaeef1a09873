#include "host/demo/demo_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clshade::demo {

namespace {

float distance_to_line(glm::vec2 p, const Stroke& stroke) {
    const glm::vec2 along = stroke.b - stroke.a;
    const float t = std::clamp(glm::dot(p - stroke.a, along) / glm::dot(along, along), 0.0F, 1.0F);
    return glm::length(p - stroke.a - t * along);
}

float distance_to_arc(glm::vec2 p, const Stroke& stroke) {
    const glm::vec2 q = p - stroke.a;
    const glm::vec2 axis(std::cos(stroke.middle), std::sin(stroke.middle));
    // The arc is symmetric about its middle: fold the lower half up.
    const glm::vec2 folded(glm::dot(q, axis), std::abs(axis.x * q.y - axis.y * q.x));
    const glm::vec2 end(std::cos(stroke.half_angle), std::sin(stroke.half_angle));
    const bool inside = end.x * folded.y - end.y * folded.x <= 0.0F; // at an angle below half_angle
    return inside ? std::abs(glm::length(folded) - stroke.radius) : glm::length(folded - stroke.radius * end);
}

/// Outside distance plus (negative) inside distance of an axis-aligned corner.
template <class Vector>
float corner(Vector d) {
    float inside = d[0];
    for (int i = 1; i < Vector::length(); ++i) {
        inside = std::max(inside, d[i]);
    }
    return std::min(inside, 0.0F) + glm::length(glm::max(d, Vector(0.0F)));
}

} // namespace

Stroke line(glm::vec2 a, glm::vec2 b) {
    return {false, a, b};
}

Stroke arc(glm::vec2 centre, float radius, float from_degrees, float to_degrees) {
    return {true,
            centre,
            centre,
            radius,
            glm::radians(0.5F * (from_degrees + to_degrees)),
            glm::radians(0.5F * (to_degrees - from_degrees))};
}

float distance_to_strokes(glm::vec2 p, std::span<const Stroke> strokes) {
    float nearest = std::numeric_limits<float>::max();
    for (const Stroke& stroke : strokes) {
        nearest = std::min(nearest, stroke.is_arc ? distance_to_arc(p, stroke) : distance_to_line(p, stroke));
    }
    return nearest;
}

float rounded_box(glm::vec3 p, glm::vec3 half, float radius) {
    return corner(glm::abs(p) - half + radius) - radius;
}

float rounded_cylinder(glm::vec3 p, float cylinder_radius, float half_height, float radius) {
    const glm::vec2 d(glm::length(glm::vec2(p)) - cylinder_radius, std::abs(p.z) - half_height);
    return corner(d + radius) - radius;
}

float extruded(float flat, float depth, float half_depth, float radius) {
    return corner(glm::vec2(flat, std::abs(depth) - half_depth) + radius) - radius;
}

} // namespace clshade::demo
