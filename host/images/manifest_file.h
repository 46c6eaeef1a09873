// Private to host/images: Cryptomatte manifests that lie in a file of their own.
#pragma once

#include "host/gbuffer/image_layout.h"

#include <cstdint>
#include <filesystem>

namespace clshade {

/// Longer manifest files are not read.
inline constexpr std::uint64_t most_manifest_bytes = std::uint64_t{64} << 20U;

/// For every attribute cryptomatte/<key>/manif_file without a manifest beside it, reads the file of that name, relative
/// to the image's folder and inside it, into layout.strings as cryptomatte/<key>/manifest. What cannot be read, is too
/// long or lies outside the folder is said in layout.warnings.
void read_manifest_files(const std::filesystem::path& image, ImageLayout& layout);

} // namespace clshade
