// Private to host/images: what stands before the pixels of an EXR that we write.
#pragma once

#include "host/images/image_writer.h"

#include <ImfHeader.h>
#include <ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace clshade {

/// A file in memory, for OpenEXR to write to.
class MemoryStream final : public Imf::OStream {
  public:
    MemoryStream() : Imf::OStream("memory") {}
    void write(const char* bytes, int count) override;
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t offset) override { position_ = static_cast<std::size_t>(offset); }
    [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }
    void clear();

  private:
    std::vector<std::byte> bytes_;
    std::size_t position_ = 0;
};

/// Throws UsageError as check_exr_settings does.
[[nodiscard]] Imf::Compression compression_of(const ExrSettings& settings);
[[nodiscard]] bool is_zip(Imf::Compression compression);
/// Rows of a chunk.
[[nodiscard]] int chunk_rows(Imf::Compression compression);
/// Stored as half?
[[nodiscard]] bool is_half(const OutputChannel& channel, const ExrSettings& settings);

/// Windows, channels, compression and its level; nothing else.
[[nodiscard]] Imf::Header plain_header(const Window& data_window, const std::vector<OutputChannel>& channels,
                                       const ExrSettings& settings);

/// What comes before the first chunk of pixels.
struct ExrHead {
    std::vector<std::byte> bytes; ///< header and an empty table of chunks
    std::size_t stamp = 0;        ///< where the completion stamp's text stands, zeros for now
    std::size_t table = 0;        ///< where the table of chunks begins, 8 bytes a chunk
    int chunks = 0;
};
/// The library's exceptions for attributes that it refuses.
[[nodiscard]] ExrHead make_head(const OutputImage& image, const ExrSettings& settings);

} // namespace clshade
