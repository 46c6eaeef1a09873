// Private to host/scene: the camera of one frame, written in a file of its own (frame_camera.h says how).
#pragma once

#include "host/scene/scene.h"

#include <filesystem>

namespace clshade {

/// Reads a .json or .toml side file. Throws UsageError "FILE:LINE:COL: ..." (JSON: "FILE: ...") for a file that is
/// missing, cannot be read, has bad syntax, unknown keys or values out of range.
[[nodiscard]] CameraKeys read_camera_side_file(const std::filesystem::path& file);

} // namespace clshade
