// The kernel sources built into the program.
#pragma once

#include "host/device/program.h"

#include <filesystem>

namespace clshade {

/// All files of kernels/, embedded at build time; those found in `kernel_dir` (may be empty) replace them.
[[nodiscard]] SourceSet kernel_sources(const std::filesystem::path& kernel_dir = {});

} // namespace clshade
