// How the pixels of a part are cut into chunks (blocks of scan lines, or tiles of the full-resolution level), and where
// they lie in the file.
#pragma once

#include "host/gbuffer/image_layout.h"
#include "host/images/exr_file.h"

#include <openexr.h>

#include <cstddef>
#include <utility>

namespace clshade {

/// Chunk i is the (i % across)-th of the (i / across)-th row of chunks, from the top left of the part's window.
struct ChunkGrid {
    Window window; ///< data window of the part
    bool tiled = false;
    int chunk_width = 1; ///< of a whole chunk; those on the right and bottom edges may be smaller
    int chunk_height = 1;
    std::size_t across = 0;
    std::size_t down = 0;

    [[nodiscard]] std::size_t count() const { return across * down; }
    /// The pixels of a chunk, in the file's coordinates.
    [[nodiscard]] Window area(std::size_t chunk) const;
    /// First and one past the last of the chunks that hold any of the lines y_first to y_last; equal if none does.
    [[nodiscard]] std::pair<std::size_t, std::size_t> overlapping(int y_first, int y_last) const;
};

/// Throws RuntimeFailure for a damaged description of lines or tiles. Call after check_part.
[[nodiscard]] ChunkGrid chunk_grid(const ExrFile& file, int part);

/// Where a chunk lies. Throws RuntimeFailure when it is missing, lies outside the file, or claims more pixels than its
/// bytes can hold under its compression. Safe to call from several threads.
[[nodiscard]] exr_chunk_info_t find_chunk(const ExrFile& file, int part, const ChunkGrid& grid, std::size_t chunk);

/// Finds every chunk of a part; throws as find_chunk does, with the number of chunks that are missing.
void check_chunks(const ExrFile& file, int part);

} // namespace clshade
