#include "host/device/whole_file.h"

#include <array>
#include <fstream>
#include <system_error>

namespace clshade {

std::optional<std::string> read_whole_file(const std::filesystem::path& path) {
    std::error_code absent;
    if (!std::filesystem::is_regular_file(path, absent)) { // a pipe would block for ever
        return std::nullopt;
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return std::nullopt;
    }
    std::string text;
    std::array<char, 65536> piece{};
    while (file.read(piece.data(), piece.size()) || file.gcount() > 0) {
        text.append(piece.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (file.bad()) {
        return std::nullopt;
    }
    return text;
}

} // namespace clshade
