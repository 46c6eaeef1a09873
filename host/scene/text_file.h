// Small text files read whole: scenes and tables of metals.
#pragma once

#include "host/scene/scene.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace clshade {

/// How messages speak of a file.
struct TextFileWords {
    std::string_view subject;     ///< "the scene"
    std::string_view name_a_file; ///< "name a TOML file"
    std::string_view check_path;  ///< "check the path of --scene"
};

/// The content of a file of at most `largest` MiB. Throws UsageError that starts with `where` and says why it cannot
/// be read.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file, std::size_t largest,
                                         const TextFileWords& words, const SourceLocation& where);

} // namespace clshade
