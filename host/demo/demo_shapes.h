// Signed distances of the demo's shapes. Units: scene units; points are in the shape's own frame.
#pragma once

#include <glm/glm.hpp>

#include <span>

namespace clshade::demo {

/// A stroke of a letter in its plane: a straight line or an arc of a circle.
struct Stroke {
    bool is_arc = false;
    glm::vec2 a{0.0F};       ///< line: start; arc: centre
    glm::vec2 b{0.0F};       ///< line: end
    float radius = 0.0F;     ///< arc
    float middle = 0.0F;     ///< arc: angle of its middle, counter-clockwise from +X, radians
    float half_angle = 0.0F; ///< arc: half of what it spans, up to pi
};

/// A line from a to b.
[[nodiscard]] Stroke line(glm::vec2 a, glm::vec2 b);
/// An arc about `centre` from one angle counter-clockwise to another, degrees.
[[nodiscard]] Stroke arc(glm::vec2 centre, float radius, float from_degrees, float to_degrees);

/// Distance to the nearest centre line of the strokes; at least one stroke.
[[nodiscard]] float distance_to_strokes(glm::vec2 p, std::span<const Stroke> strokes);

/// A box of half sizes `half`, edges rounded by `radius` (the rounding lies inside).
[[nodiscard]] float rounded_box(glm::vec3 p, glm::vec3 half, float radius);

/// An upright cylinder about Z, edges rounded by `radius`.
[[nodiscard]] float rounded_cylinder(glm::vec3 p, float cylinder_radius, float half_height, float radius);

/// A flat shape of signed distance `flat`, drawn out to +-half_depth, with edges rounded by `radius`.
[[nodiscard]] float extruded(float flat, float depth, float half_depth, float radius);

} // namespace clshade::demo
