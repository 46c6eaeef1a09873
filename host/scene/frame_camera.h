// Cameras by frame: [camera.frames.N] and side files.
//
//   [camera]                        # the camera of every frame without one of its own; matrix_world may be left out
//   fov_y_degrees = 39.6
//   file = "camera.%04d.json"       # a side file for each frame (.json or .toml), relative to the scene file
//   [camera.frames.101]             # keys of [camera] for frame 101; these win over its side file
//   matrix_world = [[1,0,0,0],[0,1,0,0],[0,0,1,5],[0,0,0,1]]
//
// Keys that neither a side file nor [camera.frames.N] writes come from [camera]; a lens written there (fov_x_degrees,
// fov_y_degrees or orthographic_height) takes the place of any lens of [camera].
//
// Side files hold matrix_world, fov_x_degrees, fov_y_degrees and orthographic_height at top level or under `camera`.
// Unknown keys are errors, except beside and inside the "camera" object of a JSON file: exporters write more there.
// JSON may call the angles fov_x_deg and fov_y_deg. A "camera" object may hold both, which describe one lens: fov_y
// counts. Its "type" may be PERSP or ORTHO; an orthographic camera needs orthographic_height.
#pragma once

#include "host/scene/scene.h"

#include <filesystem>
#include <optional>
#include <string>

namespace clshade {

/// Whether any frame may have a camera of its own.
[[nodiscard]] bool has_frame_cameras(const Scene& scene);

/// [camera.frames.N], else the side file's, else [camera] itself; empty: the G-buffer's own camera. Throws UsageError
/// for a frame that has none though others have (there is no interpolation), and for a run without frame numbers where
/// frames have cameras of their own; RuntimeFailure for a side file that is missing, cannot be read or is wrong.
[[nodiscard]] std::optional<Camera> camera_of_frame(const Scene& scene, std::optional<int> frame);

/// The side file that the frame's camera is in; empty if it is not in one.
[[nodiscard]] std::filesystem::path camera_file_of_frame(const Scene& scene, std::optional<int> frame);

/// Where camera_of_frame finds it, in words: "[camera] of x.toml", "[camera.frames.7] of x.toml", "camera.0007.json",
/// "--set camera"; empty: in the G-buffer.
[[nodiscard]] std::string camera_place(const Scene& scene, std::optional<int> frame);

} // namespace clshade
