// One frame to shade.
#pragma once

#include <filesystem>
#include <optional>

namespace clshade {

struct FrameJob {
    std::optional<int> number; ///< absent outside sequences
    std::filesystem::path input;
    std::filesystem::path output;
    std::filesystem::path preview; ///< a PNG written beside the output; empty: none
};

} // namespace clshade
