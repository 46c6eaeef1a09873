#include "host/gbuffer/camera_geometry.h"

namespace clshade {

View make_view(const CameraPose& pose) {
    View view;
    view.eye = pose.eye;
    view.camera_to_world = pose.axes;
    view.view_axis = -pose.axes[2];
    return view;
}

View make_view(const CameraPose& pose, const ScreenMap& map, const Window& data_window, const Window& display_window) {
    View view = make_view(pose);
    view.orthographic = map.orthographic;
    view.has_rays = true;
    // A pixel's centre (px, py), counted from the data window, has the screen coordinates
    //   sx = 2 (data.x_min + px - display.x_min) / W - 1,   sy = 1 - 2 (data.y_min + py - display.y_min) / H.
    const glm::dvec2 step(2.0 / display_window.width(), -2.0 / display_window.height());
    const glm::dvec2 corner(data_window.x_min - display_window.x_min, data_window.y_min - display_window.y_min);
    const glm::dvec2 first = glm::dvec2(-1.0, 1.0) + step * corner;
    // (x, y) = scale^-1 (screen - offset) in camera space, then right and up in the world.
    const glm::dmat2 unscale = glm::inverse(map.scale);
    const auto across = [&](const glm::dvec2& screen) {
        const glm::dvec2 xy = unscale * screen;
        return pose.axes[0] * xy.x + pose.axes[1] * xy.y;
    };
    const glm::dvec3 at_corner = across(first - map.offset);
    const glm::dvec3 dx = across({step.x, 0.0});
    const glm::dvec3 dy = across({0.0, step.y});
    if (map.orthographic) {
        view.origin = pose.eye + at_corner;
        view.origin_dx = dx;
        view.origin_dy = dy;
        view.direction = view.view_axis;
    } else {
        view.origin = pose.eye;
        view.direction = view.view_axis + at_corner;
        view.direction_dx = dx;
        view.direction_dy = dy;
    }
    return view;
}

std::optional<glm::dvec2> project(const View& view, const glm::dvec3& position) {
    if (!view.has_rays) {
        return std::nullopt;
    }
    // Solve base + px dx + py dy = target in the plane across the view axis.
    glm::dvec3 target = position - view.origin;
    glm::dvec3 dx = view.origin_dx;
    glm::dvec3 dy = view.origin_dy;
    if (!view.orthographic) {
        const double distance = glm::dot(target, view.view_axis);
        if (!(distance > 0.0)) {
            return std::nullopt;
        }
        target = target / distance - view.direction;
        dx = view.direction_dx;
        dy = view.direction_dy;
    }
    target -= view.view_axis * glm::dot(target, view.view_axis);
    const glm::dmat2 gram(glm::dot(dx, dx), glm::dot(dx, dy), glm::dot(dx, dy), glm::dot(dy, dy));
    return glm::inverse(gram) * glm::dvec2(glm::dot(target, dx), glm::dot(target, dy));
}

} // namespace clshade
