// One open EXR file: header parsed by OpenEXRCore, which checks every size against the length of the file before it
// allocates; chunk tables checked the same way. Nothing here trusts what the file claims.
#pragma once

#include <openexr.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace clshade {

/// Read-only; move and copy are not needed. Safe to read from several threads.
class ExrFile {
  public:
    /// Throws RuntimeFailure: missing, unreadable, not a regular file, empty, not an EXR, broken header.
    explicit ExrFile(const std::filesystem::path& file);
    ~ExrFile();
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;
    ExrFile(ExrFile&&) = delete;
    ExrFile& operator=(ExrFile&&) = delete;

    [[nodiscard]] exr_const_context_t context() const;
    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] std::uint64_t size() const;
    /// Taken from the file so far, the header included.
    [[nodiscard]] std::uint64_t bytes_read() const;
    [[nodiscard]] int part_count() const;
    /// "" for the part of a single-part file, else "part 'name'" or "part 2".
    [[nodiscard]] std::string part_label(int part) const;

    /// Fills `bytes` from `offset`; throws RuntimeFailure when the file ends before.
    void read_at(std::uint64_t offset, std::span<std::byte> bytes) const;
    /// The same for pieces of memory that take, one after the other, what lies together in the file; at most
    /// most_pieces.
    void read_pieces(std::uint64_t offset, std::span<const std::span<std::byte>> pieces) const;
    static constexpr std::size_t most_pieces = 512;
    /// Throws RuntimeFailure "FILE: what".
    [[noreturn]] void fail(std::string_view what) const;
    /// What OpenEXRCore said last, for messages.
    [[nodiscard]] std::string last_message() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Refuses what cannot be shaded or honestly lie in the file: deep parts, subsampled channels, absurd tiles.
void check_part(const ExrFile& file, int part);

/// "none", "zip", "dwaa", ...
[[nodiscard]] std::string_view compression_name(exr_compression_t compression);

} // namespace clshade
