#include "host/gbuffer/camera.h"

#include "host/base/error.h"
#include "host/gbuffer/camera_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace clshade {

namespace {

bool is_finite(const glm::dmat4& m) {
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) {
            if (!std::isfinite(m[c][r])) {
                return false;
            }
        }
    }
    return true;
}

/// Finds a matrix attribute and refuses values nothing can be done with. `matrices` hold element [row][column] of
/// row-vector matrices; read as a GLM matrix (column-major) the same array multiplies column vectors, so that
/// `matrix * v` is the file's v M.
const glm::dmat4* find_matrix(const ImageLayout& layout, const std::string& name) {
    const auto found = layout.matrices.find(name);
    if (found == layout.matrices.end()) {
        return nullptr;
    }
    if (!is_finite(found->second)) {
        throw RuntimeFailure(fmt::format("{}: attribute {} holds values that are not finite; give the camera in the "
                                         "scene file ([camera])",
                                         layout.file, name));
    }
    return &found->second;
}

/// Tolerance for numbers that went through single precision and a renderer's own arithmetic.
constexpr double header_tolerance = 1e-3;

/// Pose behind worldToCamera: x right, y up, z forward in camera space.
CameraPose pose_of(const ImageLayout& layout, const glm::dmat4& world_to_camera) {
    const glm::dmat3 linear(world_to_camera);
    const double scale = std::cbrt(std::abs(glm::determinant(linear)));
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
        largest = std::max(largest, glm::length(linear[i]));
    }
    if (!(scale > 1e-6 * largest) || largest == 0.0) {
        throw RuntimeFailure(fmt::format("{}: attribute worldToCamera is singular; give the camera in the scene file "
                                         "([camera])",
                                         layout.file));
    }
    const glm::dmat4 camera_to_world = glm::inverse(world_to_camera);
    CameraPose pose;
    pose.eye = glm::dvec3(camera_to_world[3]);
    pose.axes =
        glm::dmat3(glm::normalize(glm::dvec3(camera_to_world[0])), glm::normalize(glm::dvec3(camera_to_world[1])),
                   -glm::normalize(glm::dvec3(camera_to_world[2])));
    const glm::dmat3 gram = glm::transpose(pose.axes) * pose.axes;
    if (std::abs(gram[0][1]) + std::abs(gram[0][2]) + std::abs(gram[1][2]) > header_tolerance) {
        throw RuntimeFailure(fmt::format("{}: attribute worldToCamera shears; give the camera in the scene file "
                                         "([camera])",
                                         layout.file));
    }
    return pose;
}

/// Are pixels square (up to the header's aspect) under this map? Tells full-range screens from isotropic ones.
bool fits_window(const ScreenMap& map, const Window& display, double pixel_aspect) {
    const double per_x = std::abs(map.scale[0][0]) * display.width() * pixel_aspect;
    const double per_y = std::abs(map.scale[1][1]) * display.height();
    return std::abs(per_x - per_y) <= 5e-3 * per_y;
}

/// The lens in a world-to-screen or world-to-NDC matrix, once the pose is divided out; empty if it is neither a
/// perspective along +z nor orthographic. Two conventions are in use, told apart by the sign of y:
/// the standard (0,0) upper left to (1,1) lower right, y down; and Arnold's -1..1, y up.
std::optional<ScreenMap> lens_of(const glm::dmat4& world_to_image, const glm::dmat4& camera_to_world, bool& flipped) {
    const glm::dmat4 image = world_to_image * camera_to_world; // camera space to homogeneous image
    const auto weight = [&](int axis) { return image[axis][3]; };
    const double size = std::abs(weight(2)) + std::abs(weight(3));
    if (!(size > 0.0) || std::abs(weight(0)) + std::abs(weight(1)) > header_tolerance * size) {
        return std::nullopt;
    }
    ScreenMap map;
    map.orthographic = std::abs(weight(2)) < 1e-6 * std::abs(weight(3));
    const double reach = 1.0 + glm::length(glm::dvec3(camera_to_world[3])); // errors grow with the eye's distance
    if (!map.orthographic && std::abs(weight(3)) > header_tolerance * reach * std::abs(weight(2))) {
        return std::nullopt; // the centre of projection is not the camera's place
    }
    const int carrier = map.orthographic ? 3 : 2; // what the offset is proportional to
    flipped = !map.orthographic && weight(2) < 0.0;
    const double w = weight(carrier);
    map.scale = glm::dmat2(image[0][0], image[0][1], image[1][0], image[1][1]) / w;
    map.offset = glm::dvec2(image[carrier][0], image[carrier][1]) / w;
    if (flipped) { // forward is -z: along it the direction is (x, y, -1)
        map.scale = -map.scale;
    }
    if (map.scale[1][1] < 0.0) { // 0..1, y down
        map.scale =
            glm::dmat2(2.0 * map.scale[0][0], -2.0 * map.scale[0][1], 2.0 * map.scale[1][0], -2.0 * map.scale[1][1]);
        map.offset = {2.0 * map.offset.x - 1.0, 1.0 - 2.0 * map.offset.y};
    }
    const bool usable = std::abs(glm::determinant(map.scale)) > 1e-12 && std::isfinite(map.offset.x + map.offset.y);
    return usable ? std::optional(map) : std::nullopt;
}

/// Does Arnold's CameraFov (degrees) agree with the lens, on one of the two axes?
bool agrees(const ScreenMap& map, double fov_degrees) {
    if (map.orthographic) {
        return true; // meaningless there
    }
    const double expected = 1.0 / std::tan(glm::radians(fov_degrees) / 2.0);
    return std::abs(map.scale[0][0] - expected) < 5e-3 * expected ||
           std::abs(map.scale[1][1] - expected) < 5e-3 * expected;
}

} // namespace

View view_from_camera(const Camera& camera, const Window& data_window, const Window& display_window,
                      double pixel_aspect) {
    CameraPose pose;
    pose.eye = glm::dvec3(camera.matrix_world[3]);
    for (int i = 0; i < 3; ++i) {
        pose.axes[i] = glm::normalize(glm::dvec3(camera.matrix_world[i]));
    }
    const double aspect = display_window.width() * pixel_aspect / display_window.height();
    ScreenMap map;
    glm::dvec2 half(1.0); // half extent of the display window at distance 1, or in scene units
    switch (camera.lens) {
    case Lens::unknown:
        return make_view(pose);
    case Lens::fov_x:
        half.x = std::tan(camera.lens_value / 2.0);
        half.y = half.x / aspect;
        break;
    case Lens::fov_y:
        half.y = std::tan(camera.lens_value / 2.0);
        half.x = half.y * aspect;
        break;
    case Lens::orthographic:
        map.orthographic = true;
        half.y = camera.lens_value / 2.0;
        half.x = half.y * aspect;
        break;
    }
    map.scale = glm::dmat2(1.0 / half.x, 0.0, 0.0, 1.0 / half.y);
    return make_view(pose, map, data_window, display_window);
}

std::optional<View> view_from_header(const ImageLayout& layout, const Window& data_window) {
    const glm::dmat4* world_to_camera = find_matrix(layout, "worldToCamera");
    if (world_to_camera == nullptr) {
        return std::nullopt;
    }
    CameraPose pose = pose_of(layout, *world_to_camera);
    const glm::dmat4 camera_to_world(glm::dvec4(pose.axes[0], 0.0), glm::dvec4(pose.axes[1], 0.0),
                                     glm::dvec4(-pose.axes[2], 0.0), glm::dvec4(pose.eye, 1.0));
    const auto fov = layout.numbers.find("CameraFov");
    const bool has_fov = fov != layout.numbers.end() && fov->second > 0.0 && fov->second < 180.0;
    for (const char* name : {"worldToNDC", "worldToScreen"}) {
        const glm::dmat4* world_to_image = find_matrix(layout, name);
        if (world_to_image == nullptr) {
            continue;
        }
        bool flipped = false;
        const auto map = lens_of(*world_to_image, camera_to_world, flipped);
        if (!map) {
            continue;
        }
        if (flipped) { // a writer whose camera looks along -z
            pose.axes[2] = -pose.axes[2];
        }
        if (fits_window(*map, layout.display_window, layout.pixel_aspect) && (!has_fov || agrees(*map, fov->second))) {
            return make_view(pose, *map, data_window, layout.display_window);
        }
        return make_view(pose);
    }
    const double aspect =
        layout.display_window.width() * layout.pixel_aspect / static_cast<double>(layout.display_window.height());
    if (has_fov && std::abs(aspect - 1.0) < 1e-6) { // else nothing tells which axis the angle spans
        ScreenMap map;
        map.scale = glm::dmat2(1.0 / std::tan(glm::radians(fov->second) / 2.0));
        return make_view(pose, map, data_window, layout.display_window);
    }
    return make_view(pose);
}

} // namespace clshade
