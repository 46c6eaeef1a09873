// Private to host/images: what stands before the pixels of an EXR that we write.
#pragma once

#include "host/images/image_writer.h"

#include <ImfHeader.h>

#include <cstddef>
#include <vector>

namespace clshade {

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
