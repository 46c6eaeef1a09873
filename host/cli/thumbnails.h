// `models --thumbnails DIR`: a picture of every preset, shaded by clshade itself.
#pragma once

#include "host/cli/session.h"
#include "host/scene/model_catalog.h"

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace clshade::cli {

/// Side of a thumbnail in pixels.
inline constexpr int thumbnail_size = 256;

/// Where a preset's thumbnail lies in a folder: NAME.png.
[[nodiscard]] inline std::filesystem::path thumbnail_file(const std::filesystem::path& folder,
                                                          const PresetInfo& preset) {
    return folder / (std::string(preset.name) + ".png");
}

/// Makes the folder and writes a PNG for every preset. `told` hears of each file before it is made. Throws DeviceError,
/// RuntimeFailure; UsageError in builds without image files.
void write_thumbnails(const std::filesystem::path& folder, std::span<const PresetInfo> presets, Session& session,
                      int threads, const std::function<void(const std::filesystem::path&)>& told);

} // namespace clshade::cli
