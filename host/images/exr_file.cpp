#include "host/images/exr_file.h"

#include "host/base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>

namespace clshade {

struct ExrFile::State {
    std::string name;
    int descriptor = -1;
    std::uint64_t size = 0;
    mutable std::atomic<std::uint64_t> bytes_read{0};
    exr_context_t context = nullptr;
    int parts = 0;
    mutable std::mutex mutex;
    std::string message;

    State() = default;
    ~State() {
        if (context != nullptr) {
            exr_finish(&context);
        }
        if (descriptor >= 0) {
            ::close(descriptor);
        }
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    State(State&&) = delete;
    State& operator=(State&&) = delete;

    /// Bytes read (fewer at the end of the file), or -1.
    std::int64_t read(void* buffer, std::uint64_t count, std::uint64_t offset) const {
        std::uint64_t done = 0;
        while (done < count) {
            const ssize_t got = ::pread(descriptor, static_cast<std::byte*>(buffer) + done, count - done,
                                        static_cast<off_t>(offset + done));
            if (got < 0 && errno == EINTR) {
                continue;
            }
            if (got < 0) {
                return -1;
            }
            if (got == 0) {
                break;
            }
            done += static_cast<std::uint64_t>(got);
        }
        bytes_read.fetch_add(done, std::memory_order_relaxed);
        return static_cast<std::int64_t>(done);
    }

    static State* of(exr_const_context_t context) {
        void* data = nullptr;
        if (context == nullptr || exr_get_user_data(context, &data) != EXR_ERR_SUCCESS) {
            return nullptr;
        }
        return static_cast<State*>(data);
    }
    static std::int64_t read_callback(exr_const_context_t /*context*/, void* data, void* buffer, std::uint64_t count,
                                      std::uint64_t offset, exr_stream_error_func_ptr_t /*error*/) {
        return static_cast<const State*>(data)->read(buffer, count, offset);
    }
    static std::int64_t size_callback(exr_const_context_t /*context*/, void* data) {
        return static_cast<std::int64_t>(static_cast<const State*>(data)->size);
    }
    static void error_callback(exr_const_context_t context, exr_result_t /*code*/, const char* text) {
        if (State* state = of(context); state != nullptr && text != nullptr) {
            const std::lock_guard lock(state->mutex);
            state->message = text;
        }
    }
};

namespace {

constexpr std::array<std::uint8_t, 4> magic{0x76, 0x2f, 0x31, 0x01};
constexpr std::string_view again = "render or copy the file again";

/// Tiles up to this many bytes are taken whatever the size of the image.
constexpr double harmless_tile_bytes = 64.0 * 1024 * 1024;

} // namespace

std::string_view compression_name(exr_compression_t compression) {
    switch (compression) {
    case EXR_COMPRESSION_NONE:
        return "none";
    case EXR_COMPRESSION_RLE:
        return "rle";
    case EXR_COMPRESSION_ZIPS:
        return "zips";
    case EXR_COMPRESSION_ZIP:
        return "zip";
    case EXR_COMPRESSION_PIZ:
        return "piz";
    case EXR_COMPRESSION_PXR24:
        return "pxr24";
    case EXR_COMPRESSION_B44:
        return "b44";
    case EXR_COMPRESSION_B44A:
        return "b44a";
    case EXR_COMPRESSION_DWAA:
        return "dwaa";
    case EXR_COMPRESSION_DWAB:
        return "dwab";
    default:
        return "unknown";
    }
}

ExrFile::ExrFile(const std::filesystem::path& file) : state_(std::make_unique<State>()) {
    state_->name = file.string();
    struct stat info {};
    if (::stat(file.c_str(), &info) != 0) {
        fail(errno == ENOENT ? std::string("no such file; check the path")
                             : fmt::format("cannot be read: {}; check the path", std::strerror(errno)));
    }
    if (S_ISDIR(info.st_mode)) {
        fail("is a folder; name an .exr file in it");
    }
    if (!S_ISREG(info.st_mode)) {
        fail("is not a regular file; name an .exr file");
    }
    state_->descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (state_->descriptor < 0) {
        fail(fmt::format("cannot be read: {}; check the permissions", std::strerror(errno)));
    }
    if (::fstat(state_->descriptor, &info) != 0) {
        fail(fmt::format("cannot be read: {}", std::strerror(errno)));
    }
    state_->size = static_cast<std::uint64_t>(info.st_size);
    if (state_->size == 0) {
        fail(fmt::format("is empty; {}", again));
    }
    std::array<std::uint8_t, 4> start{};
    if (state_->read(start.data(), start.size(), 0) < 0) {
        fail(fmt::format("cannot be read: {}", std::strerror(errno)));
    }
    if (start != magic) {
        fail("is not an OpenEXR file; give an .exr image");
    }

    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = &State::error_callback;
    setup.user_data = state_.get();
    setup.read_fn = &State::read_callback;
    setup.size_fn = &State::size_callback;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    const exr_result_t result = exr_start_read(&state_->context, state_->name.c_str(), &setup);
    if (result != EXR_ERR_SUCCESS) {
        const std::string said = last_message();
        fail(fmt::format("the header is damaged or incomplete ({}); {}",
                         said.empty() ? exr_get_default_error_message(result) : said.c_str(), again));
    }
    exr_get_count(state_->context, &state_->parts);
    if (state_->parts < 1) {
        fail("holds no image; give another file");
    }
}

ExrFile::~ExrFile() = default;

exr_const_context_t ExrFile::context() const {
    return state_->context;
}

const std::string& ExrFile::name() const {
    return state_->name;
}

std::uint64_t ExrFile::size() const {
    return state_->size;
}

std::uint64_t ExrFile::bytes_read() const {
    return state_->bytes_read.load(std::memory_order_relaxed);
}

int ExrFile::part_count() const {
    return state_->parts;
}

std::string ExrFile::part_label(int part) const {
    if (state_->parts == 1) {
        return "";
    }
    const char* part_name = nullptr;
    if (exr_get_name(state_->context, part, &part_name) == EXR_ERR_SUCCESS && part_name != nullptr &&
        *part_name != '\0') {
        return fmt::format("part '{}'", part_name);
    }
    return fmt::format("part {}", part);
}

void ExrFile::read_at(std::uint64_t offset, std::span<std::byte> bytes) const {
    const std::int64_t got = state_->read(bytes.data(), bytes.size(), offset);
    if (got < 0) {
        fail(fmt::format("cannot be read: {}", std::strerror(errno)));
    }
    if (static_cast<std::size_t>(got) != bytes.size()) {
        fail(fmt::format("ends before its pixels do; {}", again));
    }
}

void ExrFile::read_pieces(std::uint64_t offset, std::span<const std::span<std::byte>> pieces) const {
    std::array<iovec, most_pieces> vectors; // NOLINT(cppcoreguidelines-pro-type-member-init): filled as far as used
    std::size_t size = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        vectors.at(i) = {pieces[i].data(), pieces[i].size()};
        size += pieces[i].size();
    }
    const ssize_t got =
        ::preadv(state_->descriptor, vectors.data(), static_cast<int>(pieces.size()), static_cast<off_t>(offset));
    if (got >= 0 && static_cast<std::size_t>(got) == size) {
        state_->bytes_read.fetch_add(size, std::memory_order_relaxed);
        return;
    }
    // Interrupted, or the file has ended: the long way says which.
    for (const std::span<std::byte> piece : pieces) {
        read_at(offset, piece);
        offset += piece.size();
    }
}

void ExrFile::fail(std::string_view what) const {
    throw RuntimeFailure(fmt::format("{}: {}", state_->name, what));
}

std::string ExrFile::last_message() const {
    const std::lock_guard lock(state_->mutex);
    return state_->message;
}

void check_part(const ExrFile& file, int part) {
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    const exr_attr_chlist_t* channels = nullptr;
    exr_attr_box2i_t window{};
    if (exr_get_storage(file.context(), part, &storage) != EXR_ERR_SUCCESS ||
        exr_get_channels(file.context(), part, &channels) != EXR_ERR_SUCCESS ||
        exr_get_data_window(file.context(), part, &window) != EXR_ERR_SUCCESS) {
        file.fail(fmt::format("the header is damaged ({}); {}", file.last_message(), again));
    }
    const std::string label = file.part_label(part);
    const std::string where = label.empty() ? "" : label + ": ";
    if (storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED) {
        file.fail(fmt::format("{}deep image: several samples a pixel cannot be shaded; flatten it first", where));
    }
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) {
        file.fail(fmt::format("{}unknown kind of image part; write it as scan lines or tiles", where));
    }
    double pixel_bytes = 0.0;
    for (int i = 0; i < channels->num_channels; ++i) {
        const exr_attr_chlist_entry_t& channel = channels->entries[i];
        if (channel.x_sampling != 1 || channel.y_sampling != 1) {
            file.fail(fmt::format("{}channel '{}' is subsampled {}x{} (luminance and chroma); convert the file to "
                                  "RGB at full resolution",
                                  where, channel.name.str, channel.x_sampling, channel.y_sampling));
        }
        pixel_bytes += channel.pixel_type == EXR_PIXEL_HALF ? 2.0 : 4.0;
    }
    if (storage == EXR_STORAGE_TILED) {
        std::int32_t tile_width = 0;
        std::int32_t tile_height = 0;
        exr_get_tile_sizes(file.context(), part, 0, 0, &tile_width, &tile_height);
        const double tile = static_cast<double>(tile_width) * tile_height;
        const double image = (static_cast<double>(window.max.x) - window.min.x + 1) *
                             (static_cast<double>(window.max.y) - window.min.y + 1);
        if (tile * pixel_bytes > harmless_tile_bytes && tile > 4 * image) {
            file.fail(fmt::format("{}tiles of {}x{} pixels in an image of {}x{}; {}", where, tile_width, tile_height,
                                  window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, again));
        }
    }
}

} // namespace clshade
