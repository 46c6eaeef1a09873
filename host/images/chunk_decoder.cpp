#include "host/base/error.h"
#include "host/images/part_decoder.h"
#include "host/images/unpack.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>

namespace clshade {

namespace {

struct FreeDecompressor {
    void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};

/// Where the samples of a channel lie in a chunk's row, and where they go.
struct RowSlice {
    SampleType type = SampleType::half;
    std::size_t sample_offset = 0; ///< bytes per pixel of the channels before it
    float* plane = nullptr;
};

/// What all chunks of a part share.
struct PartPlan {
    std::vector<RowSlice> slices;
    std::size_t pixel_bytes = 0;
    int tile_width = 0; ///< 0: scan lines
    int tile_height = 0;
    exr_attr_box2i_t window{};
    PlaneGeometry geometry;
};

/// Samples lie in the file line by line, and within a line channel by channel in the header's order.
PartPlan plan_part(const ExrFile& file, int part, const std::vector<PlaneTarget>& targets,
                   const PlaneGeometry& geometry) {
    PartPlan plan;
    plan.geometry = geometry;
    exr_get_data_window(file.context(), part, &plan.window);
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    exr_get_storage(file.context(), part, &storage);
    if (storage == EXR_STORAGE_TILED) {
        exr_get_tile_sizes(file.context(), part, 0, 0, &plan.tile_width, &plan.tile_height);
    }
    const exr_attr_chlist_t* channels = nullptr;
    exr_get_channels(file.context(), part, &channels);
    std::vector<bool> found(targets.size(), false);
    for (int i = 0; i < channels->num_channels; ++i) {
        const exr_attr_chlist_entry_t& channel = channels->entries[i];
        const SampleType type = channel.pixel_type == EXR_PIXEL_HALF   ? SampleType::half
                                : channel.pixel_type == EXR_PIXEL_UINT ? SampleType::uint32
                                                                       : SampleType::float32;
        for (std::size_t t = 0; t < targets.size(); ++t) {
            if (!found[t] && targets[t].channel == channel.name.str) {
                plan.slices.push_back({type, plan.pixel_bytes, targets[t].plane});
                found[t] = true;
            }
        }
        plan.pixel_bytes += bytes_of(type);
    }
    return plan;
}

/// One worker: owns the scratch memory and decodes chunk after chunk.
class ChunkDecoder {
  public:
    ChunkDecoder(const ExrFile& file, const PartPlan& plan)
        : file_(file), plan_(plan), inflater_(libdeflate_alloc_decompressor()) {
        if (inflater_ == nullptr) {
            throw std::bad_alloc();
        }
    }

    /// False: the chunk's data is damaged.
    [[nodiscard]] bool decode(const exr_chunk_info_t& chunk) {
        const auto rows = static_cast<std::size_t>(chunk.height);
        const auto width = static_cast<std::size_t>(chunk.width);
        const std::size_t unpacked = rows * width * plan_.pixel_bytes;
        const std::size_t packed = chunk.packed_size;
        packed_.resize(packed);
        file_.read_at(chunk.data_offset, packed_);
        const bool stored = packed == unpacked; // data that would grow is stored as it is, whatever the compression
        if (!stored && !decompress(static_cast<exr_compression_t>(chunk.compression), unpacked)) {
            return false;
        }
        const int x = plan_.tile_width > 0 ? plan_.window.min.x + chunk.start_x * plan_.tile_width : chunk.start_x;
        const int y = plan_.tile_height > 0 ? plan_.window.min.y + chunk.start_y * plan_.tile_height : chunk.start_y;
        for (std::size_t row = 0; row < rows; ++row) {
            for (const RowSlice& slice : plan_.slices) {
                const std::size_t start = width * (row * plan_.pixel_bytes + slice.sample_offset);
                float* out = slice.plane +
                             (std::int64_t{y} + static_cast<std::int64_t>(row) - plan_.geometry.window.y_min) *
                                 plan_.geometry.pitch +
                             (std::int64_t{x} - plan_.geometry.window.x_min);
                if (stored) {
                    unpack_row(slice.type, packed_.data() + start, width, out);
                } else {
                    merge_row(slice.type, inflated_.data() + start / 2,
                              inflated_.data() + (unpacked + 1) / 2 + start / 2, width, out, row_);
                }
            }
        }
        return true;
    }

  private:
    /// Undoes RLE or ZIP. What comes out holds differences of bytes, the even bytes of the data before the odd ones.
    [[nodiscard]] bool decompress(exr_compression_t compression, std::size_t unpacked) {
        if (compression == EXR_COMPRESSION_NONE || packed_.size() > unpacked) {
            return false;
        }
        inflated_.resize(unpacked);
        if (compression == EXR_COMPRESSION_RLE) {
            if (!undo_runs(packed_, inflated_)) {
                return false;
            }
        } else {
            std::size_t got = 0;
            if (libdeflate_zlib_decompress(inflater_.get(), packed_.data(), packed_.size(), inflated_.data(), unpacked,
                                           &got) != LIBDEFLATE_SUCCESS ||
                got != unpacked) {
                return false;
            }
        }
        undo_differences(inflated_);
        return true;
    }

    const ExrFile& file_;
    const PartPlan& plan_;
    std::unique_ptr<libdeflate_decompressor, FreeDecompressor> inflater_;
    std::vector<std::byte> packed_, inflated_, row_;
};

/// Runs `work` on `threads` threads (fewer if the system has none left); rethrows the first exception.
template <typename Work>
void run_on_threads(int threads, const Work& work) {
    std::mutex mutex;
    std::exception_ptr failure;
    const auto guarded = [&] {
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) {
                failure = std::current_exception();
            }
        }
    };
    std::vector<std::jthread> helpers;
    try {
        for (int i = 1; i < threads; ++i) {
            helpers.emplace_back(guarded);
        }
    } catch (const std::system_error&) { // NOLINT(bugprone-empty-catch): fewer helpers do the same work
    }
    guarded();
    helpers.clear();
    if (failure) {
        std::rethrow_exception(failure);
    }
}

} // namespace

bool has_own_decoder(exr_compression_t compression) {
    return compression == EXR_COMPRESSION_NONE || compression == EXR_COMPRESSION_RLE ||
           compression == EXR_COMPRESSION_ZIPS || compression == EXR_COMPRESSION_ZIP;
}

void decode_chunks(const ExrFile& file, int part, const std::vector<PlaneTarget>& targets,
                   const PlaneGeometry& geometry, int threads) {
    const std::vector<exr_chunk_info_t> chunks = full_resolution_chunks(file, part);
    const PartPlan plan = plan_part(file, part, targets, geometry);
    std::atomic<std::size_t> next{0};
    try {
        run_on_threads(std::min<int>(threads, static_cast<int>(std::min<std::size_t>(chunks.size(), 1024))), [&] {
            ChunkDecoder decoder(file, plan);
            for (std::size_t i = next++; i < chunks.size(); i = next++) {
                if (!decoder.decode(chunks[i])) {
                    next = chunks.size();
                    const std::string label = file.part_label(part);
                    file.fail(fmt::format("{}pixels of chunk {} are damaged; render or copy the file again",
                                          label.empty() ? "" : label + ": ", chunks[i].idx));
                }
            }
        });
    } catch (const std::bad_alloc&) {
        file.fail("not enough memory to decode the pixels; free memory or use fewer threads");
    }
}

} // namespace clshade
