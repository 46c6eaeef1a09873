// Private to host/images: where the samples of the wanted channels lie in an unpacked chunk.
#pragma once

#include "host/images/part_decoder.h"

#include <cstddef>
#include <string>
#include <vector>

namespace clshade {

/// The library's name of a sample's type in ours.
[[nodiscard]] SampleType sample_type_of(exr_pixel_type_t type);

/// A wanted channel. Samples lie in the file line by line, and within a line channel by channel in the header's order.
struct ChunkSlice {
    SampleType type = SampleType::half;
    std::size_t sample_offset = 0; ///< bytes per pixel of the channels before it
    std::size_t pxr24_offset = 0;  ///< the same as PXR24 keeps them
    int plane = 0;
};

struct ChunkSlices {
    std::vector<ChunkSlice> slices; ///< in the file's order
    std::size_t pixel_bytes = 0;    ///< of all channels of the part
    std::size_t pxr24_pixel_bytes = 0;
};

/// Throws RuntimeFailure for a channel that the part does not have.
[[nodiscard]] ChunkSlices find_slices(const PartSource& source);

/// Unpacked bytes of a whole chunk.
[[nodiscard]] std::size_t bytes_of_chunk(const ChunkGrid& grid, const ChunkSlices& layout);

/// Throws RuntimeFailure: the chunk's pixels are damaged.
[[noreturn]] void fail_chunk(const PartSource& source, std::size_t chunk, const std::string& why = "");

/// The lines of a chunk that lie in the band, counted from the chunk's first.
struct LineRange {
    int first = 0;
    int last = -1;
};
[[nodiscard]] LineRange lines_in_band(const Window& chunk, const Band& band);

} // namespace clshade
