// From a shaded frame to an image file.
#pragma once

#include "host/batch/frame_input.h"
#include "host/batch/run_scene.h"
#include "host/environment/environment_input.h"
#include "host/images/image_writer.h"
#include "host/shading/shader.h"

#include <cstdint>
#include <filesystem>

namespace clshade {

/// Everything shaded, everything kept, and attributes that tell how it was made, the identity of the job among them.
/// `environment` may be null. Refers to the first two arguments' planes.
[[nodiscard]] OutputImage make_output(const LoadedFrame& loaded, const ShadedImage& shaded, const RunScene& scene,
                                      const EnvironmentInput* environment, const DeviceInfo& device,
                                      const std::string& job);

/// True for .png in any case.
[[nodiscard]] bool is_png(const std::filesystem::path& file);

/// Writes EXR or PNG, by the extension. Throws like write_exr and write_png.
WrittenFile write_output(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings,
                         Replace replace);

/// Throws UsageError if output and source are one file, whatever their names.
void refuse_same_file(const std::filesystem::path& output, const std::filesystem::path& source);

/// The standard header matrix worldToCamera (row vectors; left-handed, +z forward) of a camera-to-world rotation
/// (right- handed, looks along -Z) at `eye`.
[[nodiscard]] glm::dmat4 world_to_camera(const glm::dmat3& camera_to_world, const glm::dvec3& eye);

} // namespace clshade
