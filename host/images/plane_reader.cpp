#include "host/base/error.h"
#include "host/images/image_reader.h"
#include "host/images/part_decoder.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <new>
#include <numeric>
#include <vector>

namespace clshade {

namespace {

/// The file may have been written anew since its header was read.
void check_unchanged(const ExrFile& file, const ImageLayout& layout, int part) {
    const PartInfo& known = layout.parts.at(static_cast<std::size_t>(part));
    exr_attr_box2i_t window{};
    const exr_attr_chlist_t* channels = nullptr;
    exr_get_data_window(file.context(), part, &window);
    exr_get_channels(file.context(), part, &channels);
    const Window now{window.min.x, window.min.y, window.max.x, window.max.y};
    bool same = now == known.data_window;
    for (const ChannelInfo& channel : layout.channels) {
        if (channel.part != part) {
            continue;
        }
        const auto* end = channels->entries + channels->num_channels;
        same = same && std::any_of(channels->entries, end, [&](const exr_attr_chlist_entry_t& entry) {
                   return channel.file_name == entry.name.str;
               });
    }
    if (!same) {
        file.fail("changed while it was being read; run again when its writer has finished");
    }
}

bool contains(const Window& outer, const Window& inner) {
    return outer.x_min <= inner.x_min && outer.y_min <= inner.y_min && outer.x_max >= inner.x_max &&
           outer.y_max >= inner.y_max;
}

/// Zeros where a part has no pixels: all of a plane's rows of the band but the inside of `covered`.
void clear_around(const Window& covered, int plane, const Band& band) {
    for (int y = band.area.y_min; y <= band.area.y_max; ++y) {
        float* row = band.at(plane, band.area.x_min, y);
        float* end = row + band.area.width();
        if (y < covered.y_min || y > covered.y_max) {
            std::fill(row, end, 0.0F);
        } else {
            std::fill(row, row + (covered.x_min - band.area.x_min), 0.0F);
            std::fill(row + (covered.x_max - band.area.x_min) + 1, end, 0.0F);
        }
    }
}

/// A part with its decoder.
struct PartReader {
    PartSource source;
    std::unique_ptr<PartDecoder> decoder;
};

/// A piece of work: chunks of a part.
struct ChunkGroup {
    PartReader* part = nullptr;
    std::size_t first = 0;
    std::size_t last = 0;
};

/// Small chunks are handed out together, up to about this many bytes unpacked.
constexpr std::size_t group_bytes = std::size_t{1} << 20U;
/// Bands higher than this are no help to anybody who chooses them to save memory.
constexpr int most_band_rows = 256;

/// The least height that is a whole number of chunks of every part; if that is too high, that of the highest chunk.
int common_rows(const std::vector<std::unique_ptr<PartReader>>& parts, int picture_height) {
    int highest = 1;
    std::int64_t common = 1;
    for (const auto& part : parts) {
        const int rows = std::min(part->source.grid.chunk_height, picture_height);
        highest = std::max(highest, rows);
        common = common <= most_band_rows ? std::lcm<std::int64_t>(common, rows) : common;
    }
    return std::min(common <= most_band_rows ? static_cast<int>(common) : highest, picture_height);
}

} // namespace

struct PlaneReader::State {
    explicit State(const std::filesystem::path& path) : file(path) {}

    ExrFile file;
    Window window;
    int channels = 0;
    std::vector<std::unique_ptr<PartReader>> parts;
    int band_rows = 1;
    std::atomic<std::int64_t> busy_nanoseconds{0};

    /// Runs work(0) to work(count - 1) on the threads of the arena; rethrows the first exception.
    template <typename Work>
    void spread(std::size_t count, const Work& work) {
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(
                tbb::blocked_range<std::size_t>(0, count),
                [&](const tbb::blocked_range<std::size_t>& range) {
                    const auto start = std::chrono::steady_clock::now();
                    for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        work(i);
                    }
                    busy_nanoseconds += std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count();
                },
                tbb::simple_partitioner());
        });
    }

    void clear_uncovered(const Band& band);
    [[nodiscard]] std::vector<ChunkGroup> groups_in(const Band& band) const;
};

void PlaneReader::State::clear_uncovered(const Band& band) {
    std::vector<std::pair<const PartReader*, int>> work;
    for (const auto& part : parts) {
        if (contains(part->source.grid.window, band.area)) {
            continue;
        }
        for (const PlaneTarget& target : part->source.targets) {
            work.emplace_back(part.get(), target.plane);
        }
    }
    spread(work.size(), [&](std::size_t i) { clear_around(work[i].first->source.grid.window, work[i].second, band); });
}

std::vector<ChunkGroup> PlaneReader::State::groups_in(const Band& band) const {
    std::vector<ChunkGroup> groups;
    for (const auto& part : parts) {
        const auto [first, last] = part->source.grid.overlapping(band.area.y_min, band.area.y_max);
        const std::size_t together = std::max<std::size_t>(1, group_bytes / part->decoder->chunk_bytes());
        for (std::size_t chunk = first; chunk < last; chunk += together) {
            groups.push_back({part.get(), chunk, std::min(last, chunk + together)});
        }
    }
    return groups;
}

PlaneReader::PlaneReader(const std::filesystem::path& path, const ImageLayout& layout, std::span<const int> channels,
                         const Window& window) {
    try {
        state_ = std::make_unique<State>(path);
        State& state = *state_;
        state.window = window;
        state.channels = static_cast<int>(channels.size());
        std::map<int, std::vector<PlaneTarget>> targets; // by part
        for (int plane = 0; plane < state.channels; ++plane) {
            const ChannelInfo& channel =
                layout.channels.at(static_cast<std::size_t>(channels[static_cast<std::size_t>(plane)]));
            targets[channel.part].push_back({channel.file_name, plane});
        }
        if (state.file.part_count() != static_cast<int>(layout.parts.size())) {
            state.file.fail("changed while it was being read; run again when its writer has finished");
        }
        for (auto& [part, wanted] : targets) {
            check_part(state.file, part);
            check_unchanged(state.file, layout, part);
            if (!contains(window, layout.parts[static_cast<std::size_t>(part)].data_window)) {
                state.file.fail(fmt::format("internal: {} sticks out of the frame", state.file.part_label(part)));
            }
            auto reader = std::make_unique<PartReader>();
            reader->source = {&state.file, part, chunk_grid(state.file, part), EXR_COMPRESSION_NONE, std::move(wanted)};
            exr_get_compression(state.file.context(), part, &reader->source.compression);
            reader->decoder = make_decoder(reader->source);
            state.parts.push_back(std::move(reader));
        }
        state.band_rows = common_rows(state.parts, window.height());
    } catch (const std::bad_alloc&) {
        throw RuntimeFailure(fmt::format("{}: not enough memory to read the header; free memory", path.string()));
    }
}

PlaneReader::~PlaneReader() = default;
PlaneReader::PlaneReader(PlaneReader&&) noexcept = default;
PlaneReader& PlaneReader::operator=(PlaneReader&&) noexcept = default;

void PlaneReader::read(int first_row, PlaneSlab& planes) {
    State& state = *state_;
    if (planes.count() < state.channels || planes.width() != state.window.width() || first_row < 0 ||
        first_row > state.window.height() - planes.height()) {
        state.file.fail("internal: the planes do not fit the picture");
    }
    const int top = state.window.y_min + first_row;
    const Band band{{state.window.x_min, top, state.window.x_max, top + planes.height() - 1}, &planes};
    try {
        state.clear_uncovered(band);
        const std::vector<ChunkGroup> groups = state.groups_in(band);
        state.spread(groups.size(),
                     [&](std::size_t i) { groups[i].part->decoder->decode(groups[i].first, groups[i].last, band); });
    } catch (const std::bad_alloc&) {
        state.file.fail("not enough memory to decode the pixels; free memory or use fewer threads");
    }
}

int PlaneReader::band_rows() const {
    return state_->band_rows;
}

std::uint64_t PlaneReader::bytes_read() const {
    return state_->file.bytes_read();
}

double PlaneReader::busy_milliseconds() const {
    return static_cast<double>(state_->busy_nanoseconds.load()) * 1e-6;
}

} // namespace clshade
