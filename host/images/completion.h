// The mark of a finished output: what is in the file agrees with what its writer put there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace clshade {

/// Attribute (PNG: tEXt keyword) with the identity of the job that made the file; OutputImage::attributes has it.
inline constexpr const char* job_attribute = "clshade/job";
/// Attribute (PNG: tEXt keyword) of the stamp: "bytes=<20 digits> xxh3=<16 hex digits>", written over zeros when
/// everything else lies in the file. The hash is over the whole file with zeros in the place of the digits.
inline constexpr const char* completion_attribute = "clshade/complete";

struct CompletionStamp {
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0; ///< XXH3, 64 bits
    std::string job;        ///< empty if the file names none
};

/// The stamp of an EXR or PNG that clshade wrote, if length and bytes agree with it. Empty for anything else: missing,
/// of another program, cut, damaged. Reads the whole file. Never throws.
[[nodiscard]] std::optional<CompletionStamp> read_completion_stamp(const std::filesystem::path& file) noexcept;

} // namespace clshade
