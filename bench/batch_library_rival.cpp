#include "bench/batch_library_rival.h"

#include "host/base/error.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <half.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <openexr.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>

namespace clshade {

namespace {

constexpr std::array<const char*, 4> picture_channels{"R", "G", "B", "A"};

Imf::Compression compression_of(const std::string& name) {
    constexpr std::array<std::pair<std::string_view, Imf::Compression>, 5> known{{{"none", Imf::NO_COMPRESSION},
                                                                                  {"zip", Imf::ZIP_COMPRESSION},
                                                                                  {"zips", Imf::ZIPS_COMPRESSION},
                                                                                  {"piz", Imf::PIZ_COMPRESSION},
                                                                                  {"dwaa", Imf::DWAA_COMPRESSION}}};
    for (const auto& [text, compression] : known) {
        if (text == name) {
            return compression;
        }
    }
    throw RuntimeFailure(fmt::format("compression {}: the rivals write none, zip, zips, piz and dwaa", name));
}

std::size_t sample_bytes(bool half) {
    return half ? 2 : 4;
}

/// A file with its data window at the origin, as the sequences have it.
void decode_cpp(const std::filesystem::path& file, std::span<const std::string> channels, PlaneSlab& planes) {
    Imf::InputFile input(file.c_str(), Imf::globalThreadCount());
    const std::size_t row_bytes = static_cast<std::size_t>(planes.pitch()) * sizeof(float);
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        auto* const plane = reinterpret_cast<char*>(planes.row(static_cast<int>(i), 0).data());
        buffer.insert(channels[i], Imf::Slice(Imf::FLOAT, plane, sizeof(float), row_bytes));
    }
    input.setFrameBuffer(buffer);
    const Imath::Box2i& window = input.header().dataWindow();
    input.readPixels(window.min.y, window.max.y);
}

/// OpenEXR's C API: every chunk unpacked straight into the planes.
class CoreDecoder {
  public:
    CoreDecoder(const std::filesystem::path& file, std::span<const std::string> channels, PlaneSlab& planes)
        : name_(file.string()), channels_(channels), planes_(planes) {
        exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
        settings.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
        require(exr_start_read(&context_, name_.c_str(), &settings));
    }
    ~CoreDecoder() {
        if (started_) {
            exr_decoding_destroy(context_, &pipeline_);
        }
        exr_finish(&context_);
    }
    CoreDecoder(const CoreDecoder&) = delete;
    CoreDecoder& operator=(const CoreDecoder&) = delete;
    CoreDecoder(CoreDecoder&&) = delete;
    CoreDecoder& operator=(CoreDecoder&&) = delete;

    void run() {
        std::int32_t lines = 1;
        require(exr_get_scanlines_per_chunk(context_, 0, &lines));
        for (int y = 0; y < planes_.height(); y += lines) {
            exr_chunk_info_t chunk{};
            require(exr_read_scanline_chunk_info(context_, 0, y, &chunk));
            require(started_ ? exr_decoding_update(context_, 0, &chunk, &pipeline_)
                             : exr_decoding_initialize(context_, 0, &chunk, &pipeline_));
            aim(y);
            if (!started_) {
                started_ = true;
                require(exr_decoding_choose_default_routines(context_, 0, &pipeline_));
            }
            require(exr_decoding_run(context_, 0, &pipeline_));
        }
    }

  private:
    /// Each wanted channel of the chunk to its rows.
    void aim(int y) {
        for (int c = 0; c < pipeline_.channel_count; ++c) {
            exr_coding_channel_info_t& channel = pipeline_.channels[c];
            const auto found = std::find(channels_.begin(), channels_.end(), channel.channel_name);
            channel.decode_to_ptr = nullptr;
            if (found != channels_.end()) {
                const int plane = static_cast<int>(found - channels_.begin());
                channel.decode_to_ptr = reinterpret_cast<std::uint8_t*>(planes_.row(plane, y).data());
                channel.user_bytes_per_element = sizeof(float);
                channel.user_data_type = EXR_PIXEL_FLOAT;
                channel.user_pixel_stride = sizeof(float);
                channel.user_line_stride = planes_.pitch() * static_cast<int>(sizeof(float));
            }
        }
    }

    void require(exr_result_t result) const {
        if (result != EXR_ERR_SUCCESS) {
            throw RuntimeFailure(fmt::format("{}: OpenEXRCore: {}", name_, exr_get_default_error_message(result)));
        }
    }

    std::string name_;
    std::span<const std::string> channels_;
    PlaneSlab& planes_;
    exr_context_t context_ = nullptr;
    exr_decode_pipeline_t pipeline_{}; ///< zeros, as EXR_DECODE_PIPELINE_INITIALIZER has it
    bool started_ = false;
};

void encode(const std::filesystem::path& file, const BareWork& work) {
    const StoredPicture& picture = *work.picture;
    const Imf::PixelType type = picture.half ? Imf::HALF : Imf::FLOAT;
    const std::size_t sample = sample_bytes(picture.half);
    const std::size_t row = sample * static_cast<std::size_t>(picture.width);
    const std::size_t plane = row * static_cast<std::size_t>(picture.height);
    Imf::Header header(picture.width, picture.height);
    header.compression() = compression_of(work.compression);
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < picture_channels.size(); ++c) {
        header.channels().insert(picture_channels[c], Imf::Channel(type));
        // The library's slices are not const; it does not write to them.
        auto* const samples = const_cast<char*>(reinterpret_cast<const char*>(picture.samples.data() + c * plane));
        buffer.insert(picture_channels[c], Imf::Slice(type, samples, sample, row));
    }
    Imf::OutputFile output(file.c_str(), header, Imf::globalThreadCount());
    output.setFrameBuffer(buffer);
    output.writePixels(picture.height);
}

/// Threads of OpenEXR's own, for a while.
class Pool {
  public:
    explicit Pool(int threads) { Imf::setGlobalThreadCount(threads); }
    ~Pool() { Imf::setGlobalThreadCount(0); }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;
    Pool(Pool&&) = delete;
    Pool& operator=(Pool&&) = delete;
};

struct Shape {
    int at_once;
    int pool;
};

Shape shape_of(LibraryPath path, int threads) {
    switch (path) {
    case LibraryPath::pool:
        return {1, threads};
    case LibraryPath::pool_frames:
        return {2, threads};
    case LibraryPath::frames:
    case LibraryPath::core:
        break;
    }
    return {threads, 0};
}

double sample_of(const StoredPicture& picture, std::size_t index) {
    if (!picture.half) {
        float value = 0.0F;
        std::memcpy(&value, picture.samples.data() + index * sizeof(float), sizeof(float));
        return static_cast<double>(value);
    }
    half value;
    std::memcpy(&value, picture.samples.data() + index * sizeof(half), sizeof(half));
    return static_cast<double>(static_cast<float>(value));
}

} // namespace

std::string_view description_of(LibraryPath path) {
    switch (path) {
    case LibraryPath::pool:
        return "OpenEXR C++, pool of threads";
    case LibraryPath::pool_frames:
        return "OpenEXR C++, pool of threads, two frames at once";
    case LibraryPath::frames:
        return "OpenEXR C++, a frame per thread";
    case LibraryPath::core:
        return "OpenEXRCore decoding, a frame per thread";
    }
    return {};
}

std::span<const LibraryPath> library_paths(std::string_view input_compression) {
    static constexpr std::array all{LibraryPath::pool, LibraryPath::pool_frames, LibraryPath::frames,
                                    LibraryPath::core};
    const bool dwa = input_compression.starts_with("dwa");
    return std::span(all).first(dwa ? all.size() - 1 : all.size());
}

void decode_with(const std::filesystem::path& file, std::span<const std::string> channels, LibraryPath path,
                 PlaneSlab& planes) {
    if (path == LibraryPath::core) {
        CoreDecoder(file, channels, planes).run();
    } else {
        decode_cpp(file, channels, planes);
    }
}

double decode_and_encode(const BareWork& work, LibraryPath path) {
    const Shape shape = shape_of(path, work.threads);
    const Pool pool(shape.pool);
    // Planes are allocated and touched before the clock starts: the least work, not the least program.
    std::vector<PlaneSlab> planes;
    planes.reserve(static_cast<std::size_t>(shape.at_once));
    for (int i = 0; i < shape.at_once; ++i) {
        planes.emplace_back(work.picture->width, work.picture->height, static_cast<int>(work.channels.size()));
    }
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(work.threads));
    std::atomic<std::size_t> next{0};
    const auto start = std::chrono::steady_clock::now();
    try {
        tbb::parallel_for(
            0, shape.at_once,
            [&](int lane) {
                for (std::size_t i = next++; i < work.inputs.size(); i = next++) {
                    decode_with(work.inputs[i], work.channels, path, planes[static_cast<std::size_t>(lane)]);
                    encode(work.outputs[i], work);
                }
            },
            tbb::simple_partitioner());
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw RuntimeFailure(fmt::format("{}: {}", description_of(path), error.what()));
    }
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

StoredPicture read_stored_picture(const std::filesystem::path& file) {
    try {
        Imf::InputFile input(file.c_str(), 0);
        const Imath::Box2i& window = input.header().dataWindow();
        const Imf::Channel* const red = input.header().channels().findChannel("R");
        if (red == nullptr) {
            throw RuntimeFailure(fmt::format("{}: no channel R", file.string()));
        }
        StoredPicture picture;
        picture.width = window.max.x - window.min.x + 1;
        picture.height = window.max.y - window.min.y + 1;
        picture.half = red->type == Imf::HALF;
        const std::size_t sample = sample_bytes(picture.half);
        const std::size_t row = sample * static_cast<std::size_t>(picture.width);
        const std::size_t plane = row * static_cast<std::size_t>(picture.height);
        picture.samples.resize(picture_channels.size() * plane);
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < picture_channels.size(); ++c) {
            buffer.insert(picture_channels[c],
                          Imf::Slice::Make(picture.half ? Imf::HALF : Imf::FLOAT, picture.samples.data() + c * plane,
                                           window, sample, row));
        }
        input.setFrameBuffer(buffer);
        input.readPixels(window.min.y, window.max.y);
        return picture;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw RuntimeFailure(fmt::format("{}: cannot be read back: {}", file.string(), error.what()));
    }
}

double stored_difference(const StoredPicture& a, const StoredPicture& b) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    if (a.width != b.width || a.height != b.height) {
        return infinite;
    }
    const std::size_t count =
        picture_channels.size() * static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
    double worst = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double ours = sample_of(a, i);
        const double theirs = sample_of(b, i);
        const double difference = std::abs(ours - theirs) / (1e-3 + std::abs(theirs));
        if (std::isnan(difference)) {
            return infinite;
        }
        worst = std::max(worst, difference);
    }
    return worst;
}

} // namespace clshade
