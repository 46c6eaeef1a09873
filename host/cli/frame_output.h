// From a shaded frame to an image file.
#pragma once

#include "host/cli/environment_input.h"
#include "host/cli/frame_input.h"
#include "host/images/image_writer.h"
#include "host/shading/shader.h"

#include <cstdint>
#include <filesystem>

namespace clshade::cli {

/// Everything shaded, everything kept, and attributes that tell how it was made. `environment` may be null. Refers to
/// the first two arguments' planes.
[[nodiscard]] OutputImage make_output(const LoadedFrame& loaded, const ShadedImage& shaded, const ChosenScene& scene,
                                      const EnvironmentInput* environment, const DeviceInfo& device);

/// True for .png in any case.
[[nodiscard]] bool is_png(const std::filesystem::path& file);

/// Writes EXR or PNG, by the extension. Returns how many values did not fit in half and were stored as +-65504.
std::uint64_t write_output(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings);

/// True if the output is there, readable to its end, and no older than any of `sources` (empty names are left out).
[[nodiscard]] bool is_up_to_date(const std::filesystem::path& output,
                                 const std::vector<std::filesystem::path>& sources);

/// Throws UsageError if output and source are one file, whatever their names.
void refuse_same_file(const std::filesystem::path& output, const std::filesystem::path& source);

/// "NAME" or "NAME:LEVEL" of --compression. Throws UsageError for unknown names and levels out of range.
void parse_compression(const std::string& text, ExrSettings& settings);

/// The standard header matrix worldToCamera (row vectors; left-handed, +z forward) of a camera-to-world rotation
/// (right- handed, looks along -Z) at `eye`.
[[nodiscard]] glm::dmat4 world_to_camera(const glm::dmat3& camera_to_world, const glm::dvec3& eye);

} // namespace clshade::cli
