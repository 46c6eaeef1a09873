#include "host/scene/text_file.h"

#include "host/scene/toml_reader.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

namespace clshade {

std::string read_text_file(const std::filesystem::path& file, std::size_t largest, const TextFileWords& words,
                           const SourceLocation& where) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        fail(where, fmt::format("{} is a folder; {}", words.subject, words.name_a_file));
    }
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        fail(where, fmt::format("cannot open {} ({}); {}", words.subject, std::generic_category().message(errno),
                                words.check_path));
    }
    const std::size_t most_bytes = largest << 20U;
    std::string text;
    std::array<char, 65536> block{};
    while (stream && text.size() <= most_bytes) {
        stream.read(block.data(), block.size());
        text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (stream.bad()) {
        fail(where, fmt::format("reading {} failed; check the file", words.subject));
    }
    if (text.size() > most_bytes) {
        fail(where, fmt::format("{} is larger than {} MiB; {}", words.subject, largest, words.name_a_file));
    }
    return text;
}

} // namespace clshade
