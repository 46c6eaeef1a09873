// Private to host/images: the text of a completion stamp and its hash. completion.h says what they mean.
#pragma once

#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace clshade {

struct Stamp {
    std::uint64_t bytes = 0; ///< of the file
    std::uint64_t head = 0;  ///< bytes at the beginning of the file that are hashed last
    std::uint64_t hash = 0;
};

/// "bytes=<20 digits> head=<20 digits> xxh3=<16 hex digits>"
inline constexpr std::size_t stamp_length = 74;
/// The digits of the hash are the last ones of the text.
inline constexpr std::size_t stamp_hash_digits = 16;

[[nodiscard]] std::string stamp_text(const Stamp& stamp);
/// Accepts what stamp_text writes and nothing else.
[[nodiscard]] std::optional<Stamp> parse_stamp(std::string_view text);

/// XXH3 (64 bits) of bytes that come in pieces.
class StreamHash {
  public:
    StreamHash(); ///< throws std::bad_alloc
    void add(std::span<const std::byte> bytes);
    [[nodiscard]] std::uint64_t value() const;

  private:
    struct Free {
        void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
    };
    std::unique_ptr<XXH3_state_t, Free> state_;
};

/// What the header of an EXR says about its completion.
struct ExrStampPlace {
    std::size_t offset = 0; ///< of the stamp's text
    std::string job;
};

/// Walks the attributes of a single-part EXR whose first bytes are given. Empty if it is none, or has no attribute
/// `clshade/complete` of the right type and length inside these bytes.
[[nodiscard]] std::optional<ExrStampPlace> find_exr_stamp(std::span<const std::byte> first_bytes);

/// A PNG's last chunks: the stamp's, then IEND. Everything is counted from the end of the file.
struct PngStampPlace {
    static constexpr std::size_t crc = 16; ///< of the stamp's chunk; IEND follows, 12 bytes
    static constexpr std::size_t text = 16 + stamp_length;
    static constexpr std::size_t chunk = text + 17 + 8; ///< keyword with its zero, name and length
};

/// A tEXt chunk.
[[nodiscard]] std::string png_text_chunk(std::string_view keyword, std::string_view text);
/// CRC-32 of PNG (and zlib).
[[nodiscard]] std::uint32_t png_crc(std::span<const std::byte> bytes);

} // namespace clshade
