#include "host/images/radiance_header.h"

#include "host/base/error.h"

#include <fmt/format.h>

#include <array>
#include <fstream>

namespace clshade {

namespace {
constexpr int most_header_lines = 1000;
}

void check_radiance_header(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    std::array<char, 4096> line{};
    for (int i = 0; i < most_header_lines && stream.getline(line.data(), line.size()) && line[0] != '\0'; ++i) {
        if (std::string(line.data()).starts_with("FORMAT=32-bit_rle_xyze")) {
            throw RuntimeFailure(
                fmt::format("{0}: its colours are XYZ, not RGB; convert it with `ra_xyze -r {0} RGB.hdr`", file));
        }
    }
}

} // namespace clshade
