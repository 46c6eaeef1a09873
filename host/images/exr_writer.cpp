// ExrWriter: chunks are encoded side by side and go to the file in order; header and table come last.
#include "host/base/error.h"
#include "host/images/chunk_encoder.h"
#include "host/images/exr_header.h"
#include "host/images/file_check.h"
#include "host/images/image_writer.h"
#include "host/images/stamp.h"
#include "host/images/temporary_file.h"

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <exception>
#include <new>
#include <set>
#include <utility>

namespace clshade {

namespace {

/// Chunks are handled in groups of about so many bytes before compression: one chunk of a row costs less than handing
/// it around, and a group should stay in a core's cache.
constexpr std::size_t group_bytes = std::size_t{256} << 10U;
constexpr std::size_t longest_name = 255; // OpenEXR cuts longer ones

void check_names(const std::string& file, std::span<const OutputChannel> channels) {
    std::set<std::string> names;
    for (const OutputChannel& channel : channels) {
        if (channel.name.empty() || !names.insert(channel.name).second) {
            throw RuntimeFailure(
                fmt::format("{}: two output channels are named '{}'; rename a light or a layer", file, channel.name));
        }
        if (channel.name.size() > longest_name || channel.name.find('\0') != std::string::npos) {
            throw RuntimeFailure(fmt::format("{}: EXR knows no channel names such as '{}'; use at most {} characters",
                                             file, channel.name, longest_name));
        }
    }
    if (channels.empty()) {
        throw RuntimeFailure(fmt::format("{}: no channels to write; choose some", file));
    }
}

/// Adds the time until its end.
class BusyTime {
  public:
    explicit BusyTime(std::atomic<std::int64_t>& nanoseconds) : nanoseconds_(nanoseconds) {}
    ~BusyTime() { nanoseconds_ += std::chrono::nanoseconds(std::chrono::steady_clock::now() - start_).count(); }
    BusyTime(const BusyTime&) = delete;
    BusyTime& operator=(const BusyTime&) = delete;
    BusyTime(BusyTime&&) = delete;
    BusyTime& operator=(BusyTime&&) = delete;

  private:
    std::atomic<std::int64_t>& nanoseconds_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Chunks on their way to the file, with the memory for it.
struct Group {
    std::unique_ptr<ChunkEncoder> encoder;
    std::unique_ptr<std::byte[]> bytes; // NOLINT(modernize-avoid-c-arrays): a vector would fill it with zeros
    std::size_t used = 0;
    std::vector<std::size_t> sizes; ///< of the chunks
    std::uint64_t clamped = 0;
    int slab_row = 0;
    int rows = 0;
    int y = 0;
};

/// Runs `action`; whatever it throws becomes one line that names the file.
template <typename Action>
auto with_clear_errors(const std::string& file, const Action& action) {
    try {
        return action();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw RuntimeFailure(fmt::format("{}: not enough memory to write it; free memory or use fewer threads", file));
    } catch (const std::exception& error) {
        throw RuntimeFailure(fmt::format("{}: cannot be written: {}; check the folder", file, error.what()));
    }
}

} // namespace

struct ExrWriter::State {
    State(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& chosen, Replace how)
        : name(file.string()), replace(how), settings(chosen), description(without_planes(image)),
          shape(chunk_shape(image, chosen)), head(make_head(image, chosen)), temporary(file) {
        table.reserve(static_cast<std::size_t>(head.chunks));
        temporary.seek(head.bytes.size());
        position = head.bytes.size();
        const std::size_t chunk = 8 + static_cast<std::size_t>(shape.rows) * shape.row_bytes;
        chunks_in_group = static_cast<int>(std::max<std::size_t>(1, group_bytes / chunk));
    }

    static OutputImage without_planes(const OutputImage& image) {
        OutputImage copy = image;
        for (OutputChannel& channel : copy.channels) {
            channel.slab = nullptr;
        }
        return copy;
    }

    void check_band(std::span<const OutputChannel> channels, int first, int rows) const;
    void write(std::span<const OutputChannel> channels, int first, int rows);
    void encode(std::span<const OutputChannel> channels, Group& group) const;
    void store(const Group& group);
    WrittenFile commit();

    std::string name;
    Replace replace;
    ExrSettings settings;
    OutputImage description;
    ChunkShape shape;
    ExrHead head;
    TemporaryFile temporary;
    StreamHash hash;
    std::vector<std::uint64_t> table; ///< where the chunks lie
    std::uint64_t position = 0;       ///< end of the file
    std::uint64_t clamped = 0;
    int next_row = 0; ///< of the picture
    int chunks_in_group = 1;
    std::vector<Group> groups; ///< as many as may be on their way
    std::atomic<std::int64_t> busy{0};
};

void ExrWriter::State::check_band(std::span<const OutputChannel> channels, int first, int rows) const {
    const int height = description.data_window.height();
    if (channels.size() != description.channels.size() || rows < 1 || rows > height - next_row || first < 0 ||
        (rows % shape.rows != 0 && next_row + rows != height)) {
        throw RuntimeFailure(
            fmt::format("{}: internal: rows {} to {} do not fit the image", name, next_row, next_row + rows - 1));
    }
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const OutputChannel& channel = channels[i];
        if (channel.name != description.channels[i].name ||
            channel.force_float != description.channels[i].force_float || channel.slab == nullptr ||
            channel.plane < 0 || channel.plane >= channel.slab->count() || channel.slab->width() != shape.width ||
            rows > channel.slab->height() - first) {
            throw RuntimeFailure(
                fmt::format("{}: internal: channel '{}' has not the size of the image", name, channel.name));
        }
    }
}

void ExrWriter::State::encode(std::span<const OutputChannel> channels, Group& group) const {
    const std::size_t chunk_bytes = 8 + static_cast<std::size_t>(shape.rows) * shape.row_bytes;
    if (group.encoder == nullptr) {
        group.encoder = make_chunk_encoder(description, settings);
        group.bytes = std::make_unique_for_overwrite<std::byte[]>( // NOLINT(modernize-avoid-c-arrays): as above
            chunk_bytes * static_cast<std::size_t>(chunks_in_group));
    }
    group.used = 0;
    group.clamped = 0;
    group.sizes.clear();
    for (int done = 0; done < group.rows; done += shape.rows) {
        const ChunkRows rows{channels, group.slab_row + done, group.y + done, std::min(shape.rows, group.rows - done)};
        const EncodedChunk chunk = group.encoder->encode(rows, group.bytes.get() + group.used);
        group.used += chunk.bytes;
        group.clamped += chunk.clamped;
        group.sizes.push_back(chunk.bytes);
    }
}

void ExrWriter::State::store(const Group& group) {
    const std::span<const std::byte> bytes(group.bytes.get(), group.used);
    hash.add(bytes);
    temporary.write(bytes);
    for (const std::size_t size : group.sizes) {
        table.push_back(position);
        position += size;
    }
    clamped += group.clamped;
}

void ExrWriter::State::write(std::span<const OutputChannel> channels, int first, int rows) {
    check_band(channels, first, rows);
    // Groups leave the pipeline in the order in which they entered it, so that those on their way follow one another
    // and none of them has the place of another in the ring.
    const std::size_t ring = std::size_t{2} * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    if (groups.size() < ring) {
        groups.resize(ring);
    }
    const int group_rows = chunks_in_group * shape.rows;
    int entered = 0;
    const auto next = [&](tbb::flow_control& control) -> Group* {
        if (entered >= rows) {
            control.stop();
            return nullptr;
        }
        Group& group = groups[static_cast<std::size_t>(entered / group_rows) % ring];
        group.slab_row = first + entered;
        group.y = description.data_window.y_min + next_row + entered;
        group.rows = std::min(group_rows, rows - entered);
        entered += group.rows;
        return &group;
    };
    const auto pack = [&](Group* group) -> Group* {
        const BusyTime time(busy);
        encode(channels, *group);
        return group;
    };
    const auto put = [&](Group* group) {
        const BusyTime time(busy);
        store(*group);
    };
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_pipeline(ring, tbb::make_filter<void, Group*>(tbb::filter_mode::serial_in_order, next) &
                                         tbb::make_filter<Group*, Group*>(tbb::filter_mode::parallel, pack) &
                                         tbb::make_filter<Group*, void>(tbb::filter_mode::serial_in_order, put));
    });
    next_row += rows;
}

WrittenFile ExrWriter::State::commit() {
    WrittenFile written;
    {
        const BusyTime time(busy);
        if (next_row != description.data_window.height()) {
            throw RuntimeFailure(fmt::format("{}: internal: only {} rows were written", name, next_row));
        }
        std::memcpy(head.bytes.data() + head.table, table.data(), table.size() * sizeof(std::uint64_t));
        const auto stamp = [&](std::uint64_t value) {
            const std::string text = stamp_text({position, head.bytes.size(), value});
            std::memcpy(head.bytes.data() + head.stamp, text.data(), text.size());
        };
        stamp(0);
        hash.add(head.bytes);
        written.hash = hash.value();
        written.bytes = position;
        written.clamped = clamped;
        stamp(written.hash);
        temporary.seek(0);
        temporary.write(head.bytes);
        temporary.close();
        check_stored(name, temporary.path(), head.bytes, written.bytes);
        if (replace == Replace::yes) {
            temporary.commit();
        } else {
            written.existed = !temporary.commit_new();
        }
    }
    written.busy_milliseconds = static_cast<double>(busy.load()) * 1e-6;
    return written;
}

ExrWriter::ExrWriter(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings,
                     Replace replace) {
    const std::string name = file.string();
    check_names(name, image.channels);
    check_exr_settings(settings);
    state_ = with_clear_errors(name, [&] { return std::make_unique<State>(file, image, settings, replace); });
}

ExrWriter::~ExrWriter() = default;
ExrWriter::ExrWriter(ExrWriter&&) noexcept = default;
ExrWriter& ExrWriter::operator=(ExrWriter&&) noexcept = default;

void ExrWriter::write(std::span<const OutputChannel> channels, int first, int rows) {
    with_clear_errors(state_->name, [&] { state_->write(channels, first, rows); });
}

int ExrWriter::band_rows() const {
    return state_->shape.rows;
}

WrittenFile ExrWriter::commit() {
    return with_clear_errors(state_->name, [&] { return state_->commit(); });
}

} // namespace clshade
