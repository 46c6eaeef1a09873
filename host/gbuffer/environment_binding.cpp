#include "host/gbuffer/environment_binding.h"

#include "host/base/error.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

namespace clshade {

namespace {

/// The sentence about a background that cannot be shown, with the place of [environment] where a file has one.
[[noreturn]] void fail_background(const Frame& frame, const Environment& environment, const std::string& message) {
    const std::string where = message_prefix(environment.where);
    throw UsageError(where.empty() ? fmt::format("{}: {}", frame.file, message) : where + message);
}

void check_background(const Frame& frame, const Environment& environment, const LatLong* image) {
    if (image == nullptr) {
        fail_background(frame, environment,
                        fmt::format("'{}' is a pre-filtered set, which lacks the picture itself, and background = true "
                                    "shows that; name the picture as image of [environment], or set background = "
                                    "false in [output]",
                                    environment.image));
    }
    if (!frame.view.has_rays) {
        fail_background(frame, environment,
                        fmt::format("background = true needs the direction of every pixel, and the camera of {} has no "
                                    "field of view; write [camera] with matrix_world and fov_y_degrees (or "
                                    "fov_x_degrees, orthographic_height), or set background = false in [output]",
                                    frame.file));
    }
}

/// What the scene says, else what the picture says of itself, else z.
UpAxis up_axis(const Environment& environment, const LatLong* image, const FilteredSet* maps) {
    std::optional<UpAxis> of_picture;
    if (image != nullptr) {
        of_picture = image->up;
    } else if (maps != nullptr) {
        of_picture = maps->up;
    }
    return environment.up.value_or(of_picture.value_or(UpAxis::z));
}

} // namespace

glm::dmat3 world_to_image(UpAxis up, double rotation) {
    // conventions.md section 4. The image frame has z towards row 0 and the picture's centre at +X. Blender's pictures
    // stand so in its world; OpenEXR's have +Y up and +Z in the centre.
    const glm::dmat3 axes = up == UpAxis::z ? glm::dmat3(1.0)
                                            : glm::transpose(glm::dmat3(glm::dvec3(0.0, 0.0, 1.0),   // image x
                                                                        glm::dvec3(1.0, 0.0, 0.0),   // image y
                                                                        glm::dvec3(0.0, 1.0, 0.0))); // image z
    // What stands at azimuth a + rotation of the world is found at azimuth a of the picture.
    const double c = std::cos(rotation);
    const double s = std::sin(rotation);
    const glm::dmat3 back(glm::dvec3(c, -s, 0.0), glm::dvec3(s, c, 0.0), glm::dvec3(0.0, 0.0, 1.0)); // columns
    return back * axes;
}

void attach_environment(Frame& frame, const Scene& scene, std::shared_ptr<const LatLong> image,
                        std::shared_ptr<const FilteredSet> maps) {
    frame.environment.reset();
    if (!scene.environment) {
        return;
    }
    const Environment& environment = *scene.environment;
    if (scene.background) {
        check_background(frame, environment, image.get());
    }
    BoundEnvironment bound;
    if (environment.in_camera_space) {
        bound.world_to_image =
            world_to_image(UpAxis::y, environment.rotation) * glm::transpose(frame.view.camera_to_world);
    } else {
        bound.world_to_image = world_to_image(up_axis(environment, image.get(), maps.get()), environment.rotation);
    }
    bound.intensity = environment.intensity;
    bound.diffuse = environment.diffuse;
    bound.background = scene.background;
    bound.image = std::move(image);
    bound.maps = std::move(maps);
    frame.environment = std::move(bound);
}

} // namespace clshade
