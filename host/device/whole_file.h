// Private to host/device: reading a file at once.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace clshade {

/// The content of a regular file; nothing if there is none or it cannot be read.
[[nodiscard]] std::optional<std::string> read_whole_file(const std::filesystem::path& path);

} // namespace clshade
