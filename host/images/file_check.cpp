#include "host/images/file_check.h"

#include "host/base/error.h"
#include "host/images/image_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <vector>

namespace clshade {

void check_stored(const std::string& target, const std::filesystem::path& stored, std::span<const std::byte> head,
                  std::uint64_t bytes) {
    const auto refuse = [&](std::string_view why) {
        throw RuntimeFailure(fmt::format("{}: was not stored as it was written ({}); check the medium", target, why));
    };
    std::error_code error;
    if (std::filesystem::file_size(stored, error) != bytes || error) {
        refuse("another length");
    }
    std::vector<char> found(head.size());
    std::ifstream stream(stored, std::ios::binary);
    stream.read(found.data(), static_cast<std::streamsize>(found.size()));
    if (!stream || !std::ranges::equal(std::as_bytes(std::span(found)), head)) {
        refuse("another header");
    }
    try {
        static_cast<void>(read_layout(stored));
    } catch (const Error& failure) {
        refuse(failure.what());
    }
}

} // namespace clshade
