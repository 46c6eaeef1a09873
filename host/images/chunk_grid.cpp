#include "host/images/chunk_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace clshade {

namespace {

constexpr std::string_view again = "render or copy the file again";

/// The most unpacked bytes that one packed byte can stand for. Deflate reaches 1032 (zlib's documentation); PXR24 packs
/// 4 bytes into 3 before it; PIZ codes runs of 255 two-byte values in about 10 bits; RLE packs 127 bytes into 2; B44A
/// 32 bytes into 3; DWA keeps at least one deflated two-byte value of 64 pixels, up to 4 bytes each.
double largest_ratio(exr_compression_t compression) {
    switch (compression) {
    case EXR_COMPRESSION_NONE:
        return 1.0;
    case EXR_COMPRESSION_RLE:
        return 64.0;
    case EXR_COMPRESSION_ZIPS:
    case EXR_COMPRESSION_ZIP:
        return 1032.0;
    case EXR_COMPRESSION_PXR24:
        return 2 * 1032.0;
    case EXR_COMPRESSION_PIZ:
        return 1024.0;
    case EXR_COMPRESSION_B44:
    case EXR_COMPRESSION_B44A:
        return 11.0;
    default:
        return 128 * 1032.0;
    }
}
/// Headers inside a chunk make small ones look better than the ratio; nothing this small can hurt.
constexpr double ratio_slack = 65536.0;

/// A table of chunks that does not fit into the file fails with the first chunk, before any memory is taken for it, and
/// every further chunk would fail the same way: no need to try millions of them.
constexpr std::size_t give_up = 64;

std::string prefix(const ExrFile& file, int part) {
    const std::string label = file.part_label(part);
    return label.empty() ? "" : label + ": ";
}

void check_plausible(const ExrFile& file, int part, const exr_chunk_info_t& chunk) {
    const auto compression = static_cast<exr_compression_t>(chunk.compression);
    const double limit = static_cast<double>(chunk.packed_size) * largest_ratio(compression) +
                         (compression == EXR_COMPRESSION_NONE ? 0.0 : ratio_slack);
    if (static_cast<double>(chunk.unpacked_size) > limit) {
        file.fail(fmt::format("{}chunk {} claims {} bytes of pixels but holds {}; {}", prefix(file, part), chunk.idx,
                              chunk.unpacked_size, chunk.packed_size, again));
    }
}

/// What OpenEXRCore says of a chunk, without throwing.
exr_result_t look_up(const ExrFile& file, int part, const ChunkGrid& grid, std::size_t chunk, exr_chunk_info_t& info) {
    const auto column = static_cast<int>(chunk % grid.across);
    const auto row = static_cast<std::int64_t>(chunk / grid.across);
    if (grid.tiled) {
        return exr_read_tile_chunk_info(file.context(), part, column, static_cast<int>(row), 0, 0, &info);
    }
    return exr_read_scanline_chunk_info(file.context(), part,
                                        static_cast<int>(grid.window.y_min + row * grid.chunk_height), &info);
}

std::string reason(const ExrFile& file, exr_result_t result) {
    const std::string said = file.last_message();
    return said.empty() ? exr_get_default_error_message(result) : said;
}

} // namespace

Window ChunkGrid::area(std::size_t chunk) const {
    // In 64 bits: a tile may reach beyond the largest integer before it is cut to the window.
    const std::int64_t x = window.x_min + static_cast<std::int64_t>(chunk % across) * chunk_width;
    const std::int64_t y = window.y_min + static_cast<std::int64_t>(chunk / across) * chunk_height;
    return {static_cast<int>(x), static_cast<int>(y),
            static_cast<int>(std::min<std::int64_t>(window.x_max, x + chunk_width - 1)),
            static_cast<int>(std::min<std::int64_t>(window.y_max, y + chunk_height - 1))};
}

std::pair<std::size_t, std::size_t> ChunkGrid::overlapping(int y_first, int y_last) const {
    const std::int64_t first = std::max(y_first, window.y_min);
    const std::int64_t last = std::min(y_last, window.y_max);
    if (first > last) {
        return {0, 0};
    }
    const auto row_of = [&](std::int64_t y) { return static_cast<std::size_t>((y - window.y_min) / chunk_height); };
    return {row_of(first) * across, (row_of(last) + 1) * across};
}

ChunkGrid chunk_grid(const ExrFile& file, int part) {
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    exr_attr_box2i_t window{};
    exr_get_storage(file.context(), part, &storage);
    exr_get_data_window(file.context(), part, &window);
    ChunkGrid grid;
    grid.window = {window.min.x, window.min.y, window.max.x, window.max.y};
    grid.tiled = storage == EXR_STORAGE_TILED;
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    constexpr std::int64_t most = std::numeric_limits<int>::max();
    if (width < 1 || height < 1 || width > most || height > most) {
        file.fail(fmt::format("{}impossible data window; {}", prefix(file, part), again));
    }
    if (grid.tiled) {
        if (exr_get_tile_sizes(file.context(), part, 0, 0, &grid.chunk_width, &grid.chunk_height) != EXR_ERR_SUCCESS ||
            grid.chunk_width < 1 || grid.chunk_height < 1) {
            file.fail(fmt::format("the tile description is damaged ({}); {}", file.last_message(), again));
        }
    } else {
        if (exr_get_scanlines_per_chunk(file.context(), part, &grid.chunk_height) != EXR_ERR_SUCCESS ||
            grid.chunk_height < 1) {
            file.fail(fmt::format("the header is damaged ({}); {}", file.last_message(), again));
        }
        grid.chunk_width = static_cast<int>(width);
    }
    grid.across = static_cast<std::size_t>((width - 1) / grid.chunk_width + 1);
    grid.down = static_cast<std::size_t>((height - 1) / grid.chunk_height + 1);
    return grid;
}

exr_chunk_info_t find_chunk(const ExrFile& file, int part, const ChunkGrid& grid, std::size_t chunk) {
    exr_chunk_info_t info{};
    if (const exr_result_t result = look_up(file, part, grid, chunk, info); result != EXR_ERR_SUCCESS) {
        file.fail(fmt::format("incomplete: {}chunk {} of the pixels is missing or damaged ({}); {}", prefix(file, part),
                              chunk, reason(file, result), again));
    }
    check_plausible(file, part, info);
    const Window area = grid.area(chunk);
    if (info.width != area.width() || info.height != area.height()) {
        file.fail(fmt::format("{}chunk {} has the wrong size; {}", prefix(file, part), chunk, again));
    }
    return info;
}

void check_chunks(const ExrFile& file, int part) {
    const ChunkGrid grid = chunk_grid(file, part);
    std::size_t missing = 0;
    std::string why;
    for (std::size_t chunk = 0; chunk < grid.count() && missing < give_up; ++chunk) {
        exr_chunk_info_t info{};
        if (const exr_result_t result = look_up(file, part, grid, chunk, info); result == EXR_ERR_SUCCESS) {
            check_plausible(file, part, info);
        } else if (missing++ == 0) {
            why = reason(file, result);
        }
    }
    if (missing == 0) {
        return;
    }
    if (grid.count() > file.size() / sizeof(std::uint64_t)) {
        file.fail(fmt::format("{}claims {} chunks of pixels, more than its {} bytes can hold; {}", prefix(file, part),
                              grid.count(), file.size(), again));
    }
    file.fail(fmt::format("incomplete: {}{}{} of {} chunks of pixels missing or damaged ({}); {}", prefix(file, part),
                          missing < give_up ? "" : "at least ", missing, grid.count(), why, again));
}

} // namespace clshade
