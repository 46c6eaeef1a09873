// Plans of small scenes, and what went wrong with them.
#pragma once

#include "host/base/error.h"
#include "host/gbuffer/frame_builder.h"
#include "tests/gbuffer/views.h"

#include <string>
#include <vector>

namespace clshade::testing {

/// A scene of one material, without anything automatic, with a camera.
inline Scene plain_scene() {
    Scene scene;
    scene.materials.emplace_back();
    scene.camera = camera_at({0, -5, 0}, {0, 0, 0}, Lens::fov_y, 0.7);
    return scene;
}

inline Scene automatic_scene() {
    Scene scene = plain_scene();
    scene.automatic_material = true;
    scene.automatic = {true, true, true};
    return scene;
}

inline FramePlan plan_of(const ImageLayout& layout, const Scene& scene, const std::vector<std::string>& keep = {}) {
    return plan_frame(layout, assign_roles(layout, scene.gbuffer, ""), scene, keep);
}

/// The message of the UsageError, or "no error".
inline std::string plan_error(const ImageLayout& layout, const Scene& scene,
                              const std::vector<std::string>& keep = {}) {
    try {
        (void)plan_of(layout, scene, keep);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "no error";
}

inline std::string plane_of(const FramePlan& plan, PlaneIndex plane) {
    return plane == no_plane ? "none" : plan.frame.plane_names[static_cast<std::size_t>(plane)];
}

} // namespace clshade::testing
