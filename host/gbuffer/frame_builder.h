// Joins a layout, its roles and a scene into a plan for reading, and the planes read into a Frame.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/gbuffer/image_layout.h"
#include "host/gbuffer/roles.h"
#include "host/gbuffer/visit_rows.h"
#include "host/scene/scene.h"

#include <string>
#include <vector>

namespace clshade {

/// The channels a scene needs of a file, each once, and how the frame will use them. Pixels are read into
/// frame.planes, once allocated: plane i takes layout.channels[channels[i]], over frame.data_window (the union of the
/// data windows of the parts used; what a part does not cover stays 0).
struct FramePlan {
    std::vector<int> channels;
    std::vector<int> keep;       ///< indices into `channels` of those passed through (--keep), used for shading or not
    Frame frame;                 ///< complete but for planes (none yet) and for a camera recovered from positions
    bool recover_camera = false; ///< neither scene nor header gave a whole camera: finish_frame recovers it
    bool pose_known = false;     ///< the header gave an eye but no lens: kept if the recovery fails
};

/// Binds every parameter of every material, the roles and the camera. `keep` lists layers to pass through.
/// Throws UsageError when a needed role is empty or ambiguous (naming the candidates), when shapes do not fit, when
/// the windows of the parts do not overlap, or when no camera can be had (naming the [camera] keys).
[[nodiscard]] FramePlan plan_frame(const ImageLayout& layout, const RoleAssignment& roles, const Scene& scene,
                                   const std::vector<std::string>& keep = {});

/// Gives plan.frame planes of zeros for the whole picture. Throws RuntimeFailure when memory is short.
void allocate_planes(FramePlan& plan);

/// After the planes are read: recovers the camera from the Position plane if the plan asks for it, turns camera-space
/// lights into world space, checks the camera against the positions and adds warnings. Moves the frame out.
[[nodiscard]] Frame finish_frame(FramePlan plan);

/// The planes that finish_frame looks at, as indices into plan.channels, each once: position, depth and coverage. Empty
/// if it looks at none.
[[nodiscard]] std::vector<int> camera_planes(const FramePlan& plan);

/// A frame with windows, names and roles for these planes alone, in that order: plane i is plan.channels[camera_planes
/// [i]]. Its other roles are absent and it has no planes: give it some, set first_row, and show it.
[[nodiscard]] Frame camera_frame(const FramePlan& plan);

/// As finish_frame(plan) for a picture that is not in memory as a whole; bit-identical results. `rows` show frames such
/// as camera_frame(plan); where camera_planes(plan) is empty they are not asked. The frame returned has no planes but
/// those of the plan.
[[nodiscard]] Frame finish_frame(FramePlan plan, const VisitRows& rows);

} // namespace clshade
