// Private to host/gbuffer: small pure functions on views.
#pragma once

#include "host/gbuffer/frame.h"

#include <glm/glm.hpp>

#include <optional>

namespace clshade {

/// Where the camera stands and how it is turned: columns right, up, backwards, orthonormal.
struct CameraPose {
    glm::dvec3 eye{0.0};
    glm::dmat3 axes{1.0};
};

/// What the lens shows: screen coordinates (-1..1 over the display window, y up) of the camera-space direction
/// (x, y, 1) (x right, y up, z forward), or of the point (x, y) for orthographic lenses:
///   screen = scale * (x, y) + offset.
struct ScreenMap {
    bool orthographic = false;
    glm::dmat2 scale{1.0};
    glm::dvec2 offset{0.0};
};

/// Joins pose and lens into rays for the pixels of the data window.
[[nodiscard]] View make_view(const CameraPose& pose, const ScreenMap& map, const Window& data_window,
                             const Window& display_window);

/// A view of which only the pose is known: no rays.
[[nodiscard]] View make_view(const CameraPose& pose);

/// Pixel coordinates (pixel centres at + 0.5, from the data window's corner) where the view sees a world position;
/// empty behind the camera or without rays.
[[nodiscard]] std::optional<glm::dvec2> project(const View& view, const glm::dvec3& position);

} // namespace clshade
