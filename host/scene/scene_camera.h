// [camera] and [gbuffer].
#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_reader.h"
#include "host/scene/toml_value.h"

#include <optional>
#include <span>
#include <string_view>

namespace clshade {

/// matrix_world, fov_x_degrees, fov_y_degrees, orthographic_height.
[[nodiscard]] std::span<const std::string_view> camera_key_names();

/// Reads these keys, each of which may be missing; the table may have others. Throws for a matrix that is singular,
/// sheared, scaled, mirrored or not affine, naming which, and for more than one lens.
[[nodiscard]] CameraKeys read_camera_keys(const TableReader& table);

/// `own`, completed from `shared`. Empty without a matrix_world in either.
[[nodiscard]] std::optional<Camera> join_camera(const CameraKeys& own, const CameraKeys& shared);

/// Reads [camera] into scene.camera and scene.frame_cameras. Throws like read_camera_keys, for a missing matrix_world,
/// and for cameras of frames that make no sense. Side files are not looked for.
void read_camera(const TomlEntry& entry, Scene& scene);

/// Reads [gbuffer]: role overrides, spaces and kinds.
[[nodiscard]] GBufferSettings read_gbuffer(const TomlEntry& entry);

} // namespace clshade
