// The mark of a finished output: what is in the file agrees with what its writer put there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace clshade {

/// Attribute (PNG: tEXt keyword) with the identity of the job that made the file; OutputImage::attributes has it.
inline constexpr const char* job_attribute = "clshade/job";
/// Attribute (PNG: tEXt keyword, the last chunk before IEND) of the stamp: "bytes=<20 digits> head=<20 digits> xxh3=<16
/// hex digits>", a string of fixed length. `bytes` is the length of the file. `head` is where its first chunk of pixels
/// lies (PNG: 0); everything before goes to the file last, so that an unfinished file begins with zeros. The hash is
/// XXH3, 64 bits, over bytes [head, end) and then [0, head), with the character 0 in place of the hash's own digits
/// (PNG: and zero bytes in place of the checksum of the stamp's chunk).
inline constexpr const char* completion_attribute = "clshade/complete";

struct CompletionStamp {
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0; ///< XXH3, 64 bits
    std::string job;        ///< empty if the file names none
};

/// The stamp of an EXR or PNG that clshade wrote, if length and bytes agree with it. Empty for anything else: missing,
/// of another program, cut, damaged; or with a header so long that the stamp does not lie in the file's first MiB.
/// Reads the whole file once, in pieces of 1 MiB. Never throws.
[[nodiscard]] std::optional<CompletionStamp> read_completion_stamp(const std::filesystem::path& file) noexcept;

} // namespace clshade
