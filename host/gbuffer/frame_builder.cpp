#include "host/gbuffer/frame_builder.h"

#include "host/base/error.h"
#include "host/gbuffer/camera.h"
#include "host/gbuffer/channel_layers.h"
#include "host/gbuffer/cryptomatte.h"
#include "host/gbuffer/find_named.h"
#include "host/gbuffer/parameter_binding.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace clshade {

namespace {

/// "room.exr: " before every message about a file.
[[noreturn]] void fail(const ImageLayout& layout, const std::string& message) {
    throw UsageError(fmt::format("{}: {}", layout.file, message));
}

void refuse_ambiguous(const ImageLayout& layout, const RoleChoice& choice) {
    if (!choice.ambiguous.empty()) {
        fail(layout,
             fmt::format("{} may be {}; say which: {} = \"{}\" in [gbuffer] of the scene file", name_of(choice.role),
                         list_names(choice.ambiguous), name_of(choice.role), choice.ambiguous.front()));
    }
}

/// A role without which shading makes no sense.
void require(const ImageLayout& layout, const RoleAssignment& roles, Role role, std::string_view why) {
    const RoleChoice& choice = roles[role];
    refuse_ambiguous(layout, choice);
    if (choice.channels.empty()) {
        fail(layout, fmt::format("no {}{} ({}); the file has {}; write {} = \"LAYER\" in [gbuffer] of the scene file",
                                 name_of(role), why, choice.rule,
                                 list_names(layer_names(visible_layers(layout, roles.view))), name_of(role)));
    }
}

std::array<PlaneIndex, 3> add_three(PlaneTable& table, const RoleChoice& choice) {
    refuse_ambiguous(table.layout(), choice);
    if (choice.channels.size() != 3) {
        return {no_plane, no_plane, no_plane};
    }
    return {table.add(choice.channels[0]), table.add(choice.channels[1]), table.add(choice.channels[2])};
}

PlaneIndex add_one(PlaneTable& table, const RoleChoice& choice) {
    refuse_ambiguous(table.layout(), choice);
    return choice.channels.empty() ? no_plane : table.add(choice.channels.front());
}

bool overlap(const Window& a, const Window& b) {
    return a.x_min <= b.x_max && b.x_min <= a.x_max && a.y_min <= b.y_max && b.y_min <= a.y_max;
}

std::string window_text(const Window& w) {
    return fmt::format("({}, {})-({}, {})", w.x_min, w.y_min, w.x_max, w.y_max);
}

/// The union of the data windows of the parts that channels are read from.
Window union_of_windows(const ImageLayout& layout, const std::vector<int>& channels) {
    std::set<int> parts;
    for (const int channel : channels) {
        parts.insert(layout.channels[static_cast<std::size_t>(channel)].part);
    }
    const auto part_of = [&](int index) -> const PartInfo& { return layout.parts[static_cast<std::size_t>(index)]; };
    Window all = part_of(*parts.begin()).data_window;
    for (const int a : parts) {
        const Window& window = part_of(a).data_window;
        for (const int b : parts) {
            if (!overlap(window, part_of(b).data_window)) {
                fail(layout, fmt::format("the data windows of part '{}' {} and part '{}' {} do not overlap; map roles "
                                         "of one of them in [gbuffer]",
                                         part_of(a).name, window_text(window), part_of(b).name,
                                         window_text(part_of(b).data_window)));
            }
        }
        all = {std::min(all.x_min, window.x_min), std::min(all.y_min, window.y_min), std::max(all.x_max, window.x_max),
               std::max(all.y_max, window.y_max)};
    }
    return all;
}

bool any_material_has_ids(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& material) { return !material.ids.empty(); });
}

/// Materials, and the claims of those with Cryptomatte names.
void bind_materials(PlaneTable& table, const RoleAssignment& roles, const Scene& scene, Frame& frame) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const AutomaticParameters automatic = i == 0 ? scene.automatic : AutomaticParameters{};
        frame.materials.push_back(bind_material(table, roles, scene.materials[i], automatic));
    }
    const bool any_names = std::any_of(scene.materials.begin(), scene.materials.end(),
                                       [](const Material& material) { return !material.names.empty(); });
    if (!any_names) {
        return;
    }
    const CryptomatteSet cryptomattes(table.layout(), roles.view);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        frame.materials[i].cryptomatte = bind_claims(table, cryptomattes, scene.materials[i]);
    }
    refuse_shared_claims(frame.materials, scene.materials);
    const std::vector<std::string> warnings = cryptomattes.warnings();
    frame.warnings.insert(frame.warnings.end(), warnings.begin(), warnings.end());
}

constexpr std::string_view camera_keys = "write [camera] with matrix_world and fov_y_degrees (or fov_x_degrees, "
                                         "orthographic_height) in the scene file";

/// Scene camera, else header camera, else one to be recovered; an error if there is none.
void plan_camera(FramePlan& plan, const ImageLayout& layout, const Scene& scene) {
    Frame& frame = plan.frame;
    const bool has_position = frame.roles.position[0] != no_plane;
    if (scene.camera) {
        frame.view = view_from_camera(*scene.camera, frame.data_window, frame.display_window, frame.pixel_aspect);
        if (!frame.view.has_rays && !has_position) {
            fail(layout, "[camera] gives no field of view and the file has no position; write fov_y_degrees, "
                         "fov_x_degrees or orthographic_height in [camera]");
        }
        return;
    }
    if (const auto view = view_from_header(layout, frame.data_window)) {
        frame.view = *view;
        if (!view->has_rays && !has_position) {
            fail(layout, fmt::format("the header's worldToCamera comes without a usable field of view and there is no "
                                     "position; {}",
                                     camera_keys));
        }
        plan.recover_camera = !view->has_rays;
        plan.pose_known = true;
        return;
    }
    if (!has_position) {
        fail(layout, fmt::format("no camera: the header carries none and there is no position to recover it from; {}",
                                 camera_keys));
    }
    plan.recover_camera = true;
}

/// Default-scene lights are given relative to the camera.
void turn_lights(Frame& frame) {
    for (Light& light : frame.lights) {
        if (light.in_camera_space) {
            light.direction = frame.view.camera_to_world * light.direction;
            light.position = frame.view.eye + frame.view.camera_to_world * light.position;
            light.in_camera_space = false;
        }
    }
}

void recover_camera(Frame& frame, bool pose_known, const VisitRows& rows) {
    try {
        const RecoveredView recovered = recover_view(frame, rows);
        frame.view = recovered.view;
        frame.notes.push_back(fmt::format(
            "camera recovered from Position: median error {:.2g} px, 99 % within {:.2g} px, {} of {} samples, {}",
            recovered.median_error_px, recovered.p99_error_px,
            std::lround(recovered.inlier_fraction * recovered.samples), recovered.samples,
            recovered.view.orthographic ? "orthographic" : "perspective"));
    } catch (const UsageError& error) {
        if (!pose_known) {
            throw;
        }
        frame.warnings.push_back(fmt::format("only the eye is known, from the header: {}", error.what()));
    }
}

void check_camera(Frame& frame, const VisitRows& rows) {
    const double error = reprojection_error(frame, rows);
    if (error > 1.0) {
        frame.warnings.push_back(fmt::format("camera and Position disagree: median distance {:.2f} px; check [camera], "
                                             "or the space and unit of the position",
                                             error));
    }
}

void finish(FramePlan& plan, const VisitRows& rows) {
    if (plan.recover_camera) {
        recover_camera(plan.frame, plan.pose_known, rows);
    } else {
        check_camera(plan.frame, rows);
    }
    turn_lights(plan.frame);
}

} // namespace

FramePlan plan_frame(const ImageLayout& layout, const RoleAssignment& roles, const Scene& scene,
                     const std::vector<std::string>& keep) {
    FramePlan plan;
    Frame& frame = plan.frame;
    PlaneTable table(layout, plan.channels);

    require(layout, roles, Role::normal, "");
    frame.roles.normal = add_three(table, roles[Role::normal]);
    frame.roles.position = add_three(table, roles[Role::position]);
    frame.roles.depth = add_one(table, roles[Role::depth]);
    frame.roles.coverage = add_one(table, roles[Role::coverage]);
    if (any_material_has_ids(scene)) {
        require(layout, roles, Role::material_id, ", which the ids of the materials need");
        frame.roles.material_id = add_one(table, roles[Role::material_id]);
    }
    bind_materials(table, roles, scene, frame);
    frame.has_emission =
        scene.emission_mapped && (roles.has(Role::emission) || !roles[Role::emission].ambiguous.empty());
    if (frame.has_emission) {
        refuse_ambiguous(layout, roles[Role::emission]);
        frame.emission = bind_role(table, roles[Role::emission]);
    }
    if (!keep.empty()) {
        const std::vector<ChannelLayer> layers = visible_layers(layout, roles.view);
        for (const std::string& name : keep) {
            for (const int channel : find_kept(layout, layers, name)) {
                const PlaneIndex plane = table.add(channel);
                if (std::find(plan.keep.begin(), plan.keep.end(), plane) == plan.keep.end()) {
                    plan.keep.push_back(plane);
                }
            }
        }
    }

    frame.file = layout.file;
    frame.display_window = layout.display_window;
    frame.pixel_aspect = layout.pixel_aspect;
    frame.data_window = union_of_windows(layout, plan.channels);
    frame.normal_space = scene.gbuffer.normal_space;
    frame.normal_encoding = scene.gbuffer.normal_encoding;
    frame.depth_kind = scene.gbuffer.depth_kind;
    frame.lights = scene.lights;
    frame.warnings.insert(frame.warnings.begin(), layout.warnings.begin(), layout.warnings.end());
    frame.warnings.insert(frame.warnings.end(), roles.warnings.begin(), roles.warnings.end());
    for (const int channel : plan.channels) {
        frame.plane_names.push_back(layout.channels[static_cast<std::size_t>(channel)].name);
    }
    plan_camera(plan, layout, scene);
    return plan;
}

void allocate_planes(FramePlan& plan) {
    const Window& window = plan.frame.data_window;
    plan.frame.planes = PlaneSlab(window.width(), window.height(), static_cast<int>(plan.channels.size()));
}

std::vector<int> camera_planes(const FramePlan& plan) {
    const Frame& frame = plan.frame;
    const RolePlanes& roles = frame.roles;
    std::vector<int> planes;
    if (roles.position[0] == no_plane || (!plan.recover_camera && !frame.view.has_rays)) {
        return planes;
    }
    for (const PlaneIndex plane :
         {roles.position[0], roles.position[1], roles.position[2], roles.depth, roles.coverage}) {
        if (plane != no_plane && std::find(planes.begin(), planes.end(), plane) == planes.end()) {
            planes.push_back(plane);
        }
    }
    return planes;
}

Frame camera_frame(const FramePlan& plan) {
    const std::vector<int> planes = camera_planes(plan);
    const auto place_of = [&](PlaneIndex plane) {
        const auto found = std::find(planes.begin(), planes.end(), plane);
        return found == planes.end() ? no_plane : static_cast<PlaneIndex>(found - planes.begin());
    };
    Frame frame;
    frame.file = plan.frame.file;
    frame.data_window = plan.frame.data_window;
    frame.display_window = plan.frame.display_window;
    frame.pixel_aspect = plan.frame.pixel_aspect;
    for (const int plane : planes) {
        frame.plane_names.push_back(plan.frame.plane_names[static_cast<std::size_t>(plane)]);
    }
    const RolePlanes& roles = plan.frame.roles;
    std::transform(roles.position.begin(), roles.position.end(), frame.roles.position.begin(), place_of);
    frame.roles.depth = place_of(roles.depth);
    frame.roles.coverage = place_of(roles.coverage);
    return frame;
}

Frame finish_frame(FramePlan plan) {
    finish(plan, whole_picture(plan.frame));
    return std::move(plan.frame);
}

Frame finish_frame(FramePlan plan, const VisitRows& rows) {
    finish(plan, rows);
    return std::move(plan.frame);
}

} // namespace clshade
