// 128-bit content hashes (xxHash XXH3), printed as 32 hexadecimal digits.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace clshade {

/// Hash of a byte string.
[[nodiscard]] std::string hash_hex(std::span<const std::byte> bytes);
[[nodiscard]] std::string hash_hex(std::string_view text);

} // namespace clshade
