// Chunks by the OpenEXR library. A chunk depends on nothing outside it, so each is a picture of its own, in memory: the
// library's encoders run side by side, and without its pool of threads.
#include "host/base/error.h"
#include "host/images/chunk_encoder.h"
#include "host/images/exr_header.h"
#include "host/images/pack.h"

#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>

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

class LibraryEncoder final : public ChunkEncoder {
  public:
    LibraryEncoder(const OutputImage& image, const ExrSettings& settings)
        : shape_(chunk_shape(image, settings)), window_(image.data_window), channels_(image.channels),
          settings_(settings) {}

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
        stream_.clear();
        std::size_t head = 0;
        {
            Imf::OutputFile file(stream_, plain_header(window, channels_, settings_), 0);
            head = stream_.bytes().size();
            file.setFrameBuffer(buffer);
            file.writePixels(rows.rows);
        }
        encoded.bytes = stream_.bytes().size() - head;
        if (encoded.bytes > 8 + static_cast<std::size_t>(rows.rows) * shape_.row_bytes) {
            throw RuntimeFailure("internal: a chunk grew in compression");
        }
        std::memcpy(out, stream_.bytes().data() + head, encoded.bytes);
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
    MemoryStream stream_;
};

} // namespace

std::unique_ptr<ChunkEncoder> make_library_encoder(const OutputImage& image, const ExrSettings& settings) {
    return std::make_unique<LibraryEncoder>(image, settings);
}

} // namespace clshade
