// Pixels of one part into float planes. Two ways in: our own for uncompressed, RLE and ZIP data, which unpacks the
// needed channels of a chunk straight into their planes, and the OpenEXR library for every other compression.
#pragma once

#include "host/gbuffer/image_layout.h"
#include "host/images/exr_file.h"

#include <string>
#include <vector>

namespace clshade {

/// A channel of a part and the plane it goes to.
struct PlaneTarget {
    std::string channel;    ///< its name inside the part
    float* plane = nullptr; ///< sample of the frame's top left pixel
};

/// The planes cover `window`; rows are `pitch` floats apart.
struct PlaneGeometry {
    Window window;
    int pitch = 0;
};

/// Is this one for decode_chunks?
[[nodiscard]] bool has_own_decoder(exr_compression_t compression);

/// Uncompressed, RLE, ZIPS and ZIP. Throws RuntimeFailure naming the file, the part and the lines that are damaged.
void decode_chunks(const ExrFile& file, int part, const std::vector<PlaneTarget>& targets,
                   const PlaneGeometry& geometry, int threads);

/// Any compression, by the OpenEXR library. Sets its process-wide number of threads.
void decode_with_library(const ExrFile& file, int part, const std::vector<PlaneTarget>& targets,
                         const PlaneGeometry& geometry, int threads);

} // namespace clshade
