#include "host/images/chunk_slices.h"
#include "host/images/part_decoder.h"
#include "host/images/unpack.h"

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

/// What was done to the bytes of a chunk.
enum class Packing { none, rle, zip, pxr24 };

Packing packing_of(exr_compression_t compression) {
    switch (compression) {
    case EXR_COMPRESSION_RLE:
        return Packing::rle;
    case EXR_COMPRESSION_PXR24:
        return Packing::pxr24;
    default:
        return Packing::zip;
    }
}

class ChunkDecoder : public PartDecoder {
  public:
    explicit ChunkDecoder(const PartSource& source)
        : source_(source), layout_(find_slices(source)), packing_(packing_of(source.compression)) {}

    [[nodiscard]] std::size_t chunk_bytes() const override { return bytes_of_chunk(source_.grid, layout_); }

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
        const std::size_t pixels = width * static_cast<std::size_t>(area.height());
        // Data that would grow is stored as it is, whatever the method.
        const Packing packing = packed.size() == pixels * layout_.pixel_bytes ? Packing::none : packing_;
        const std::size_t pixel_bytes = packing == Packing::pxr24 ? layout_.pxr24_pixel_bytes : layout_.pixel_bytes;
        const std::size_t size = pixels * pixel_bytes;
        if (packing != Packing::none &&
            (packed.size() > pixels * layout_.pixel_bytes || !decompress(packed, packing, size, scratch))) {
            fail_chunk(source_, chunk);
        }
        const std::byte* bytes = packing == Packing::none ? packed.data() : scratch.inflated.data();
        const LineRange lines = lines_in_band(area, band);
        for (int line = lines.first; line <= lines.last; ++line) {
            for (const ChunkSlice& slice : layout_.slices) {
                const std::size_t offset = packing == Packing::pxr24 ? slice.pxr24_offset : slice.sample_offset;
                const std::size_t start = width * (static_cast<std::size_t>(line) * pixel_bytes + offset);
                float* out = band.at(slice.plane, area.x_min, area.y_min + line);
                switch (packing) {
                case Packing::none:
                    unpack_row(slice.type, bytes + start, width, out);
                    break;
                case Packing::pxr24:
                    undo_pxr24_row(slice.type, bytes + start, width, out);
                    break;
                default: // the even bytes of the data lie before the odd ones
                    merge_row(slice.type, bytes + start / 2, bytes + (size + 1) / 2 + start / 2, width, out);
                    break;
                }
            }
        }
    }

    /// Into scratch.inflated, which must come to `size` bytes. False: damaged.
    [[nodiscard]] static bool decompress(std::span<const std::byte> packed, Packing packing, std::size_t size,
                                         Scratch& scratch) {
        scratch.inflated.resize(size);
        if (packing == Packing::rle) {
            if (!undo_runs(packed, scratch.inflated)) {
                return false;
            }
        } else {
            std::size_t got = 0;
            if (libdeflate_zlib_decompress(scratch.inflater.get(), packed.data(), packed.size(),
                                           scratch.inflated.data(), size, &got) != LIBDEFLATE_SUCCESS ||
                got != size) {
                return false;
            }
        }
        if (packing != Packing::pxr24) {
            undo_differences(scratch.inflated);
        }
        return true;
    }

    const PartSource& source_;
    ChunkSlices layout_;
    Packing packing_;
    tbb::enumerable_thread_specific<Scratch> scratch_;
};

} // namespace

std::unique_ptr<PartDecoder> make_chunk_decoder(const PartSource& source) {
    return std::make_unique<ChunkDecoder>(source);
}

std::unique_ptr<PartDecoder> make_decoder(const PartSource& source) {
    switch (source.compression) {
    case EXR_COMPRESSION_NONE:
        return make_stored_decoder(source);
    case EXR_COMPRESSION_RLE:
    case EXR_COMPRESSION_ZIPS:
    case EXR_COMPRESSION_ZIP:
    case EXR_COMPRESSION_PXR24:
        return make_chunk_decoder(source);
    default:
        return make_library_decoder(source);
    }
}

} // namespace clshade
