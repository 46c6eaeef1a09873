// Private to host/images: rows of planes into the chunks of an EXR. Two ways: our own for uncompressed, RLE and ZIP
// data, and the OpenEXR library for every other compression.
#pragma once

#include "host/images/image_writer.h"

#include <ImfCompression.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace clshade {

/// What all chunks of a picture have in common.
struct ChunkShape {
    struct Channel {
        std::size_t index = 0; ///< among the caller's channels
        bool half = false;
    };
    std::vector<Channel> channels; ///< in the order of the file: by name
    int width = 0;
    int rows = 0;              ///< of a chunk
    std::size_t row_bytes = 0; ///< of all channels
};
[[nodiscard]] ChunkShape chunk_shape(const OutputImage& image, const ExrSettings& settings);

/// The rows of a chunk: slab_row and following of the slabs, y and following of the file.
struct ChunkRows {
    std::span<const OutputChannel> channels; ///< in the caller's order
    int slab_row = 0;
    int y = 0;
    int rows = 0;
};

struct EncodedChunk {
    std::size_t bytes = 0;
    std::uint64_t clamped = 0; ///< values too large for half
};

/// Keeps memory to work in: one for each thread.
class ChunkEncoder {
  public:
    ChunkEncoder() = default;
    virtual ~ChunkEncoder() = default;
    ChunkEncoder(const ChunkEncoder&) = delete;
    ChunkEncoder& operator=(const ChunkEncoder&) = delete;
    ChunkEncoder(ChunkEncoder&&) = delete;
    ChunkEncoder& operator=(ChunkEncoder&&) = delete;

    /// Writes the chunk to `out` as it lies in the file: y, size, data. It takes 8 + rows * row_bytes bytes at most;
    /// what does not shrink is stored as it is.
    [[nodiscard]] virtual EncodedChunk encode(const ChunkRows& rows, std::byte* out) = 0;
};

/// The image's channels need no slab.
[[nodiscard]] std::unique_ptr<ChunkEncoder> make_chunk_encoder(const OutputImage& image, const ExrSettings& settings);
/// By the OpenEXR library; for every compression. Its own pool of threads, which OpenImageIO starts when it opens an
/// EXR, is stopped: TBB alone spreads the work.
[[nodiscard]] std::unique_ptr<ChunkEncoder> make_library_encoder(const OutputImage& image, const ExrSettings& settings);

/// OpenEXR's run lengths (unpack.h has the way back). 0 unless the result is shorter than `bytes`; `out` has its size.
[[nodiscard]] std::size_t pack_runs(std::span<const std::byte> bytes, std::byte* out);

} // namespace clshade
