// Frames whose positions are known because a known camera made them.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/scene/scene.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace clshade::testing {

/// A camera at `eye` that looks at `target`, with +Z up.
inline Camera camera_at(const glm::dvec3& eye, const glm::dvec3& target, Lens lens, double lens_value) {
    Camera camera;
    camera.matrix_world = glm::inverse(glm::lookAt(eye, target, glm::dvec3(0.0, 0.0, 1.0)));
    camera.lens = lens;
    camera.lens_value = lens_value;
    return camera;
}

struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
};

/// Ray through the centre of pixel (x, y) of the data window.
inline Ray ray_of(const View& view, double x, double y) {
    return {view.origin + (x + 0.5) * view.origin_dx + (y + 0.5) * view.origin_dy,
            view.direction + (x + 0.5) * view.direction_dx + (y + 0.5) * view.direction_dy};
}

/// Largest angle in radians between the rays of two views over a data window, at its corners and middle.
inline double worst_angle(const View& a, const View& b, const Window& window) {
    double worst = 0.0;
    for (const double x : {0.0, 0.5, 1.0}) {
        for (const double y : {0.0, 0.5, 1.0}) {
            const glm::dvec3 da = glm::normalize(ray_of(a, x * window.width(), y * window.height()).direction);
            const glm::dvec3 db = glm::normalize(ray_of(b, x * window.width(), y * window.height()).direction);
            worst = std::max(worst, glm::length(da - db));
        }
    }
    return worst;
}

/// Planes of a frame made by make_frame.
inline constexpr int depth_plane = 3;
inline constexpr int coverage_plane = 4;

/// Position (0..2), depth (3) and coverage (4) for every pixel where `distance_along(x, y)` along the view axis is
/// positive; background (depth 1e10, all else 0) elsewhere. Planes are rounded to single precision as files are.
inline Frame make_frame(const View& view, const Window& data, const Window& display, double pixel_aspect,
                        const std::function<double(int, int)>& distance_along) {
    Frame frame;
    frame.file = "picture.exr";
    frame.data_window = data;
    frame.display_window = display;
    frame.pixel_aspect = pixel_aspect;
    frame.planes = PlaneSlab(data.width(), data.height(), 5);
    frame.plane_names = {"P.X", "P.Y", "P.Z", "Z", "A"};
    frame.roles.position = {0, 1, 2};
    frame.roles.depth = depth_plane;
    frame.roles.coverage = coverage_plane;
    frame.view = view;
    for (int y = 0; y < data.height(); ++y) {
        for (int x = 0; x < data.width(); ++x) {
            const double t = distance_along(x, y);
            frame.planes.at(depth_plane, x, y) = t > 0.0 ? static_cast<float>(t) : 1e10F;
            if (t > 0.0) {
                const Ray ray = ray_of(view, x, y);
                const glm::dvec3 p = ray.origin + t * ray.direction;
                for (int i = 0; i < 3; ++i) {
                    frame.planes.at(i, x, y) = static_cast<float>(p[i]);
                }
                frame.planes.at(coverage_plane, x, y) = 1.0F;
            }
        }
    }
    return frame;
}

/// Blocks at different depths with a slanted ground between them; a fifth of the pixels is background.
inline double blocks(int x, int y) {
    const int block = (x / 16) * 7 + (y / 16) * 13;
    if (block % 5 == 0) {
        return -1.0;
    }
    return block % 3 == 0 ? 6.0 + 0.02 * y : 5.0 + block % 7 + 0.01 * x;
}

/// The distance along the axis at which rays meet the plane normal . p = offset.
inline std::function<double(int, int)> plane_at(const View& view, const glm::dvec3& normal, double offset) {
    return [=](int x, int y) {
        const Ray ray = ray_of(view, x, y);
        return (offset - glm::dot(normal, ray.origin)) / glm::dot(normal, ray.direction);
    };
}

} // namespace clshade::testing
