// Private to host/images: does a file hold what was written to it?
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace clshade {

/// Opens `stored` again: it must begin with `head`, have the given length, and be an EXR whose header and table of
/// chunks read_layout accepts. Throws RuntimeFailure that names `target`.
void check_stored(const std::string& target, const std::filesystem::path& stored, std::span<const std::byte> head,
                  std::uint64_t bytes);

} // namespace clshade
