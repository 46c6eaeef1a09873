// Private to host/images: pixels of one part into float planes, chunk by chunk. Our own ways in, which unpack the
// needed channels of a chunk straight into their planes, for uncompressed, RLE, ZIP and PXR24 data, and the OpenEXR
// library for every other compression.
#pragma once

#include "host/base/plane_slab.h"
#include "host/gbuffer/image_layout.h"
#include "host/images/chunk_grid.h"
#include "host/images/exr_file.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace clshade {

/// A channel of a part and the plane it goes to.
struct PlaneTarget {
    std::string channel; ///< its name inside the part
    int plane = 0;
};

/// One part of a file and what is wanted of it.
struct PartSource {
    const ExrFile* file = nullptr;
    int part = 0;
    ChunkGrid grid;
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    std::vector<PlaneTarget> targets;
};

/// The rows being filled: row 0 of the planes is line y_min of `area`, pixel 0 of a row is x_min.
struct Band {
    Window area;
    PlaneSlab* planes = nullptr;

    /// Pixel (x, y) of the file's coordinates, inside `area`.
    [[nodiscard]] float* at(int plane, int x, int y) const {
        return planes->row(plane, y - area.y_min).data() + (x - area.x_min);
    }
};

/// Decodes chunks of one part. Safe to call from several threads, each with chunks of its own; memory for a chunk or
/// two is kept for every thread.
class PartDecoder {
  public:
    PartDecoder() = default;
    virtual ~PartDecoder() = default;
    PartDecoder(const PartDecoder&) = delete;
    PartDecoder& operator=(const PartDecoder&) = delete;
    PartDecoder(PartDecoder&&) = delete;
    PartDecoder& operator=(PartDecoder&&) = delete;

    /// Chunks first to last - 1, of which the lines inside the band are stored. Throws RuntimeFailure naming the file,
    /// the part and the chunk that is damaged.
    virtual void decode(std::size_t first, std::size_t last, const Band& band) = 0;
    /// Unpacked bytes of a whole chunk.
    [[nodiscard]] virtual std::size_t chunk_bytes() const = 0;
};

/// The one for the part's compression. `source` must outlive the decoder.
[[nodiscard]] std::unique_ptr<PartDecoder> make_decoder(const PartSource& source);
/// Uncompressed.
[[nodiscard]] std::unique_ptr<PartDecoder> make_stored_decoder(const PartSource& source);
/// RLE, ZIPS, ZIP and PXR24.
[[nodiscard]] std::unique_ptr<PartDecoder> make_chunk_decoder(const PartSource& source);
/// Any compression.
[[nodiscard]] std::unique_ptr<PartDecoder> make_library_decoder(const PartSource& source);

} // namespace clshade
