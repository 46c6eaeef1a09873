// Chunks by the OpenEXR library. A chunk depends on nothing outside it, so each is a picture of its own, in memory: the
// library's encoders run side by side, and without its pool of threads.
#include "host/base/error.h"
#include "host/images/chunk_encoder.h"
#include "host/images/exr_header.h"
#include "host/images/library_threads.h"
#include "host/images/pack.h"

#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace clshade {

namespace {

/// The base OpenEXR counts pixel (x, y) of the file from; outside the memory in general, so computed as a number.
char* base_of(const void* first, int x, int y, std::size_t sample, std::size_t row) {
    const auto address = reinterpret_cast<std::uintptr_t>(first) -
                         static_cast<std::uintptr_t>(std::int64_t{x} * static_cast<std::int64_t>(sample)) -
                         static_cast<std::uintptr_t>(std::int64_t{y} * static_cast<std::int64_t>(row));
    return reinterpret_cast<char*>(address); // NOLINT(performance-no-int-to-ptr): see above
}

/// Takes what comes after the header: the one chunk of the picture.
class ChunkStream final : public Imf::OStream {
  public:
    explicit ChunkStream(std::span<std::byte> out) : Imf::OStream("memory"), out_(out) {}

    /// The header ends here.
    void begin_chunk() { chunk_at_ = end_ = position_; }
    /// Of the chunk.
    [[nodiscard]] std::size_t size() const { return end_ - chunk_at_; }

    void write(const char* bytes, int count) override {
        const auto size = static_cast<std::size_t>(std::max(count, 0));
        if (chunk_at_ != 0 && position_ >= chunk_at_) { // else the header, or the table that is put in at the end
            if (size > out_.size() - std::min(out_.size(), position_ - chunk_at_)) {
                throw RuntimeFailure("internal: a chunk grew in compression");
            }
            std::memcpy(out_.data() + (position_ - chunk_at_), bytes, size);
        }
        position_ += size;
        end_ = std::max(end_, position_);
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t offset) override { position_ = static_cast<std::size_t>(offset); }

  private:
    std::span<std::byte> out_;
    std::size_t position_ = 0;
    std::size_t chunk_at_ = 0;
    std::size_t end_ = 0;
};

class LibraryEncoder final : public ChunkEncoder {
  public:
    LibraryEncoder(const OutputImage& image, const ExrSettings& settings)
        : shape_(chunk_shape(image, settings)), window_(image.data_window), channels_(image.channels),
          settings_(settings) {
        stop_library_threads();
    }

    EncodedChunk encode(const ChunkRows& rows, std::byte* out) override {
        const auto width = static_cast<std::size_t>(shape_.width);
        EncodedChunk encoded;
        Imf::FrameBuffer buffer;
        halves_.resize(shape_.channels.size());
        for (std::size_t i = 0; i < shape_.channels.size(); ++i) {
            const OutputChannel& channel = rows.channels[shape_.channels[i].index];
            if (shape_.channels[i].half) {
                halves_[i].resize(width * static_cast<std::size_t>(shape_.rows));
                for (int row = 0; row < rows.rows; ++row) {
                    encoded.clamped += pack_halves(channel.slab->row(channel.plane, rows.slab_row + row),
                                                   halves_[i].data() + static_cast<std::size_t>(row) * width);
                }
                buffer.insert(channel.name, slice(Imf::HALF, halves_[i].data(), sizeof(std::uint16_t), width, rows.y));
            } else {
                buffer.insert(channel.name,
                              slice(Imf::FLOAT, channel.slab->row(channel.plane, rows.slab_row).data(), sizeof(float),
                                    static_cast<std::size_t>(channel.slab->pitch()), rows.y));
            }
        }
        const Window window{window_.x_min, rows.y, window_.x_max, rows.y + rows.rows - 1};
        ChunkStream stream({out, 8 + static_cast<std::size_t>(rows.rows) * shape_.row_bytes});
        {
            Imf::OutputFile file(stream, plain_header(window, channels_, settings_), 0);
            stream.begin_chunk();
            file.setFrameBuffer(buffer);
            file.writePixels(rows.rows);
        }
        encoded.bytes = stream.size();
        return encoded;
    }

  private:
    [[nodiscard]] Imf::Slice slice(Imf::PixelType type, const void* first, std::size_t sample, std::size_t pitch,
                                   int y) const {
        return {type, base_of(first, window_.x_min, y, sample, pitch * sample), sample, pitch * sample};
    }

    ChunkShape shape_;
    Window window_;
    std::vector<OutputChannel> channels_; ///< names and types
    ExrSettings settings_;
    std::vector<std::vector<std::uint16_t>> halves_;
};

} // namespace

std::unique_ptr<ChunkEncoder> make_library_encoder(const OutputImage& image, const ExrSettings& settings) {
    return std::make_unique<LibraryEncoder>(image, settings);
}

} // namespace clshade
