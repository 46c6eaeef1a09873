#include "host/images/chunk_slices.h"
#include "host/images/part_decoder.h"
#include "host/images/unpack.h"

#include <fmt/format.h>
#include <libdeflate.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>

namespace clshade {

namespace {

struct FreeDecompressor {
    void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};

/// Chunks that follow one another in the file are read together up to this many bytes: far fewer calls for files of one
/// line a chunk, and what was read is still in the cache when it is unpacked.
constexpr std::uint64_t most_read_together = std::uint64_t{1} << 19U;

/// What a thread keeps from chunk to chunk.
struct Scratch {
    std::unique_ptr<libdeflate_decompressor, FreeDecompressor> inflater{libdeflate_alloc_decompressor()};
    std::vector<exr_chunk_info_t> chunks;
    std::vector<std::byte> packed, inflated;
};

/// Some chunks as they lie in the file, which may hold the last first.
struct FileRange {
    std::size_t chunks = 0;
    std::uint64_t first = 0;
    std::uint64_t last = 0;
};

/// How many of the chunks to read in one piece: not too much, and not much more than the chunks themselves.
FileRange next_range(std::span<const exr_chunk_info_t> chunks) {
    FileRange range;
    std::uint64_t wanted = 0;
    for (const exr_chunk_info_t& chunk : chunks) {
        const std::uint64_t first = range.chunks == 0 ? chunk.data_offset : std::min(range.first, chunk.data_offset);
        const std::uint64_t last = std::max(range.last, chunk.data_offset + chunk.packed_size);
        wanted += chunk.packed_size;
        if (range.chunks > 0 && (last - first > most_read_together || last - first > wanted + wanted / 8)) {
            break;
        }
        range = {range.chunks + 1, first, last};
    }
    return range;
}

class ChunkDecoder : public PartDecoder {
  public:
    explicit ChunkDecoder(const PartSource& source) : source_(source), layout_(find_slices(source)) {}

    [[nodiscard]] std::size_t chunk_bytes() const override {
        return layout_.pixel_bytes * static_cast<std::size_t>(source_.grid.chunk_width) *
               static_cast<std::size_t>(source_.grid.chunk_height);
    }

    void decode(std::size_t first, std::size_t last, const Band& band) override {
        Scratch& scratch = scratch_.local();
        if (scratch.inflater == nullptr) {
            throw std::bad_alloc();
        }
        scratch.chunks.clear();
        for (std::size_t i = first; i < last; ++i) {
            scratch.chunks.push_back(find_chunk(*source_.file, source_.part, source_.grid, i));
        }
        for (std::size_t done = 0; done < scratch.chunks.size();) {
            const FileRange range = next_range(std::span(scratch.chunks).subspan(done));
            scratch.packed.resize(range.last - range.first);
            source_.file->read_at(range.first, scratch.packed);
            for (std::size_t i = done; i < done + range.chunks; ++i) {
                const exr_chunk_info_t& chunk = scratch.chunks[i];
                decode_chunk(first + i,
                             std::span(scratch.packed).subspan(chunk.data_offset - range.first, chunk.packed_size),
                             scratch, band);
            }
            done += range.chunks;
        }
    }

  private:
    void decode_chunk(std::size_t chunk, std::span<const std::byte> packed, Scratch& scratch, const Band& band) const {
        const Window area = source_.grid.area(chunk);
        const auto width = static_cast<std::size_t>(area.width());
        const std::size_t unpacked = width * static_cast<std::size_t>(area.height()) * layout_.pixel_bytes;
        const bool stored = packed.size() == unpacked; // data that would grow is stored as it is, whatever the method
        if (!stored && !decompress(packed, unpacked, scratch)) {
            const std::string label = source_.file->part_label(source_.part);
            source_.file->fail(fmt::format("{}pixels of chunk {} are damaged; render or copy the file again",
                                           label.empty() ? "" : label + ": ", chunk));
        }
        const LineRange lines = lines_in_band(area, band);
        for (int line = lines.first; line <= lines.last; ++line) {
            for (const ChunkSlice& slice : layout_.slices) {
                const std::size_t start =
                    width * (static_cast<std::size_t>(line) * layout_.pixel_bytes + slice.sample_offset);
                float* out = band.at(slice.plane, area.x_min, area.y_min + line);
                if (stored) {
                    unpack_row(slice.type, packed.data() + start, width, out);
                } else {
                    merge_row(slice.type, scratch.inflated.data() + start / 2,
                              scratch.inflated.data() + (unpacked + 1) / 2 + start / 2, width, out);
                }
            }
        }
    }

    /// Undoes RLE or ZIP into scratch.inflated: the even bytes of the data before the odd ones. False: damaged.
    [[nodiscard]] bool decompress(std::span<const std::byte> packed, std::size_t unpacked, Scratch& scratch) const {
        if (source_.compression == EXR_COMPRESSION_NONE || packed.size() > unpacked) {
            return false;
        }
        scratch.inflated.resize(unpacked);
        if (source_.compression == EXR_COMPRESSION_RLE) {
            if (!undo_runs(packed, scratch.inflated)) {
                return false;
            }
        } else {
            std::size_t got = 0;
            if (libdeflate_zlib_decompress(scratch.inflater.get(), packed.data(), packed.size(),
                                           scratch.inflated.data(), unpacked, &got) != LIBDEFLATE_SUCCESS ||
                got != unpacked) {
                return false;
            }
        }
        undo_differences(scratch.inflated);
        return true;
    }

    const PartSource& source_;
    ChunkSlices layout_;
    tbb::enumerable_thread_specific<Scratch> scratch_;
};

} // namespace

std::unique_ptr<PartDecoder> make_chunk_decoder(const PartSource& source) {
    return std::make_unique<ChunkDecoder>(source);
}

std::unique_ptr<PartDecoder> make_decoder(const PartSource& source) {
    switch (source.compression) {
    case EXR_COMPRESSION_NONE:
    case EXR_COMPRESSION_RLE:
    case EXR_COMPRESSION_ZIPS:
    case EXR_COMPRESSION_ZIP:
        return make_chunk_decoder(source);
    default:
        return make_library_decoder(source);
    }
}

} // namespace clshade
