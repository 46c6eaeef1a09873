// Uncompressed parts: only the rows of the wanted channels are read, floats straight into their planes.
#include "host/images/chunk_slices.h"
#include "host/images/part_decoder.h"
#include "host/images/unpack.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace clshade {

namespace {

/// Rows are read in one call with what lies between them, unless that is more than this; a page costs as much as a
/// call.
constexpr std::uint64_t most_gap = 4096;
/// One call reads about this much, so that what must be widened is still in the cache.
constexpr std::size_t most_at_once = std::size_t{1} << 18U;

/// Collects rows that follow one another in the file and reads them together.
class RowGatherer {
  public:
    /// The row `count` samples long at `offset` of the file.
    void add(const ExrFile& file, std::uint64_t offset, SampleType type, std::size_t count, float* out) {
        const std::size_t size = count * bytes_of(type);
        const bool widened = type != SampleType::float32;
        if (!pieces_.empty() &&
            (offset < end_ || offset - end_ > most_gap || end_ - start_ > most_at_once ||
             pieces_.size() + 2 > ExrFile::most_pieces || (widened && used_ + size > samples_.size()))) {
            flush(file);
        }
        if (pieces_.empty()) {
            start_ = end_ = offset;
            if (widened && size > samples_.size()) {
                samples_.resize(std::max(size, most_at_once));
            }
        }
        if (offset > end_) {
            pieces_.push_back(std::span(gap_).first(offset - end_));
        }
        if (widened) {
            const std::span<std::byte> place = std::span(samples_).subspan(used_, size);
            pieces_.push_back(place);
            rows_.push_back({type, place.data(), count, out});
            used_ += size;
        } else {
            pieces_.push_back(std::as_writable_bytes(std::span(out, count)));
        }
        end_ = offset + size;
    }

    void flush(const ExrFile& file) {
        if (!pieces_.empty()) {
            file.read_pieces(start_, pieces_);
        }
        for (const Row& row : rows_) {
            unpack_row(row.type, row.samples, row.count, row.out);
        }
        drop();
    }

    /// Forgets what was collected.
    void drop() {
        pieces_.clear();
        rows_.clear();
        used_ = 0;
    }

  private:
    /// Samples that are not floats, to be widened.
    struct Row {
        SampleType type = SampleType::half;
        const std::byte* samples = nullptr;
        std::size_t count = 0;
        float* out = nullptr;
    };

    std::uint64_t start_ = 0; ///< of the pieces in the file
    std::uint64_t end_ = 0;
    std::vector<std::span<std::byte>> pieces_;
    std::vector<Row> rows_;
    std::vector<std::byte> samples_;
    std::size_t used_ = 0;
    std::vector<std::byte> gap_ = std::vector<std::byte>(most_gap);
};

class StoredDecoder : public PartDecoder {
  public:
    explicit StoredDecoder(const PartSource& source) : source_(source), layout_(find_slices(source)) {}

    [[nodiscard]] std::size_t chunk_bytes() const override { return bytes_of_chunk(source_.grid, layout_); }

    void decode(std::size_t first, std::size_t last, const Band& band) override {
        RowGatherer& gatherer = gatherers_.local();
        gatherer.drop(); // after a failure
        for (std::size_t chunk = first; chunk < last; ++chunk) {
            const exr_chunk_info_t place = find_chunk(*source_.file, source_.part, source_.grid, chunk);
            const Window area = source_.grid.area(chunk);
            const auto width = static_cast<std::size_t>(area.width());
            if (place.packed_size != width * static_cast<std::size_t>(area.height()) * layout_.pixel_bytes) {
                fail_chunk(source_, chunk);
            }
            const LineRange lines = lines_in_band(area, band);
            for (int line = lines.first; line <= lines.last; ++line) {
                for (const ChunkSlice& slice : layout_.slices) {
                    const std::size_t start =
                        width * (static_cast<std::size_t>(line) * layout_.pixel_bytes + slice.sample_offset);
                    gatherer.add(*source_.file, place.data_offset + start, slice.type, width,
                                 band.at(slice.plane, area.x_min, area.y_min + line));
                }
            }
        }
        gatherer.flush(*source_.file);
    }

  private:
    const PartSource& source_;
    ChunkSlices layout_;
    tbb::enumerable_thread_specific<RowGatherer> gatherers_;
};

} // namespace

std::unique_ptr<PartDecoder> make_stored_decoder(const PartSource& source) {
    return std::make_unique<StoredDecoder>(source);
}

} // namespace clshade
