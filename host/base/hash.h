// 128-bit content hashes (xxHash XXH3), printed as 32 hexadecimal digits.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace clshade {

/// Hash of a byte string.
[[nodiscard]] std::string hash_hex(std::span<const std::byte> bytes);
[[nodiscard]] std::string hash_hex(std::string_view text);

/// Hash of a file's bytes, read in pieces. Throws RuntimeFailure if it cannot be read.
[[nodiscard]] std::string file_hash_hex(const std::filesystem::path& file);

} // namespace clshade
