#include "host/images/chunk_encoder.h"

#include "host/images/exr_header.h"
#include "host/images/pack.h"
#include "host/images/unpack.h"

#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace clshade {

namespace {

constexpr std::size_t chunk_prefix = 8; ///< y and the number of bytes

void put_prefix(int y, std::size_t bytes, std::byte* out) {
    const auto size = static_cast<std::int32_t>(bytes); // OpenEXR refuses rows for which a chunk is longer
    std::memcpy(out, &y, sizeof(std::int32_t));
    std::memcpy(out + sizeof(std::int32_t), &size, sizeof(size));
}

/// The samples of one row of a channel, in memory of 2 or 4 bytes a sample. Returns how many were clamped.
std::uint64_t pack_row(std::span<const float> row, bool half, std::uint16_t* out) {
    if (half) {
        return pack_halves(row, out);
    }
    std::memcpy(out, row.data(), row.size_bytes());
    return 0;
}

/// Rows as they lie in a chunk without compression. `scratch` holds a row of floats.
EncodedChunk store(const ChunkShape& shape, const ChunkRows& rows, std::vector<std::uint16_t>& scratch,
                   std::byte* out) {
    EncodedChunk stored;
    stored.bytes = chunk_prefix + static_cast<std::size_t>(rows.rows) * shape.row_bytes;
    put_prefix(rows.y, stored.bytes - chunk_prefix, out);
    out += chunk_prefix;
    for (int row = 0; row < rows.rows; ++row) {
        for (const ChunkShape::Channel& channel : shape.channels) {
            const OutputChannel& source = rows.channels[channel.index];
            const std::span<const float> values = source.slab->row(source.plane, rows.slab_row + row);
            if (channel.half) {
                stored.clamped += pack_row(values, true, scratch.data());
                std::memcpy(out, scratch.data(), values.size() * sizeof(std::uint16_t));
                out += values.size() * sizeof(std::uint16_t);
            } else {
                std::memcpy(out, values.data(), values.size_bytes());
                out += values.size_bytes();
            }
        }
    }
    return stored;
}

class PlainEncoder final : public ChunkEncoder {
  public:
    explicit PlainEncoder(ChunkShape shape)
        : shape_(std::move(shape)), scratch_(2 * static_cast<std::size_t>(shape_.width)) {}
    EncodedChunk encode(const ChunkRows& rows, std::byte* out) override { return store(shape_, rows, scratch_, out); }

  private:
    ChunkShape shape_;
    std::vector<std::uint16_t> scratch_;
};

/// RLE and ZIP: even bytes, then odd ones, as differences, packed.
class ShuffledEncoder : public ChunkEncoder {
  public:
    explicit ShuffledEncoder(ChunkShape shape)
        : shape_(std::move(shape)), scratch_(2 * static_cast<std::size_t>(shape_.width)),
          split_(static_cast<std::size_t>(shape_.rows) * shape_.row_bytes), differences_(split_.size()) {}

    EncodedChunk encode(const ChunkRows& rows, std::byte* out) final {
        const std::size_t bytes = static_cast<std::size_t>(rows.rows) * shape_.row_bytes;
        EncodedChunk encoded;
        std::byte* even = split_.data();
        std::byte* odd = even + bytes / 2; // every sample has two or four bytes
        for (int row = 0; row < rows.rows; ++row) {
            for (const ChunkShape::Channel& channel : shape_.channels) {
                const OutputChannel& source = rows.channels[channel.index];
                const std::span<const float> values = source.slab->row(source.plane, rows.slab_row + row);
                encoded.clamped += pack_row(values, channel.half, scratch_.data());
                const std::size_t pairs = values.size() * (channel.half ? 1 : 2);
                split_bytes(std::span(scratch_).first(pairs), even, odd);
                even += pairs;
                odd += pairs;
            }
        }
        make_differences(std::span(split_).first(bytes), differences_.data());
        const std::size_t packed = pack(std::span(differences_).first(bytes), out + chunk_prefix);
        if (packed == 0) { // the values clamped are counted already
            encoded.bytes = store(shape_, rows, scratch_, out).bytes;
            return encoded;
        }
        put_prefix(rows.y, packed, out);
        encoded.bytes = chunk_prefix + packed;
        return encoded;
    }

  private:
    /// Returns the number of bytes, fewer than are given; 0 if they do not shrink.
    virtual std::size_t pack(std::span<const std::byte> bytes, std::byte* out) = 0;

    ChunkShape shape_;
    std::vector<std::uint16_t> scratch_; ///< a row of a channel
    std::vector<std::byte> split_;
    std::vector<std::byte> differences_;
};

class RunEncoder final : public ShuffledEncoder {
  public:
    using ShuffledEncoder::ShuffledEncoder;

  private:
    std::size_t pack(std::span<const std::byte> bytes, std::byte* out) override { return pack_runs(bytes, out); }
};

class ZipEncoder final : public ShuffledEncoder {
  public:
    ZipEncoder(ChunkShape shape, int level)
        : ShuffledEncoder(std::move(shape)), compressor_(libdeflate_alloc_compressor(level)) {
        if (compressor_ == nullptr) {
            throw std::bad_alloc();
        }
    }

  private:
    struct Free {
        void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
    };

    std::size_t pack(std::span<const std::byte> bytes, std::byte* out) override {
        return libdeflate_zlib_compress(compressor_.get(), bytes.data(), bytes.size(), out, bytes.size() - 1);
    }

    std::unique_ptr<libdeflate_compressor, Free> compressor_;
};

/// OpenEXR's own default.
constexpr int default_level = 4;

} // namespace

ChunkShape chunk_shape(const OutputImage& image, const ExrSettings& settings) {
    ChunkShape shape;
    shape.width = image.data_window.width();
    shape.rows = chunk_rows(compression_of(settings));
    for (std::size_t i = 0; i < image.channels.size(); ++i) {
        const bool half = is_half(image.channels[i], settings);
        shape.channels.push_back({i, half});
        shape.row_bytes += static_cast<std::size_t>(shape.width) * (half ? sizeof(std::uint16_t) : sizeof(float));
    }
    std::sort(shape.channels.begin(), shape.channels.end(),
              [&](const ChunkShape::Channel& a, const ChunkShape::Channel& b) {
                  return image.channels[a.index].name < image.channels[b.index].name;
              });
    return shape;
}

std::size_t pack_runs(std::span<const std::byte> bytes, std::byte* out) {
    constexpr std::size_t shortest_run = 3;
    constexpr std::size_t longest = 127;
    const std::size_t size = bytes.size();
    std::size_t written = 0;
    std::size_t start = 0;
    while (start < size) {
        std::size_t end = start + 1;
        while (end < size && bytes[end] == bytes[start] && end - start <= longest) {
            ++end;
        }
        if (end - start >= shortest_run) {
            if (written + 2 >= size) {
                return 0;
            }
            out[written++] = static_cast<std::byte>(end - start - 1);
            out[written++] = bytes[start];
        } else {
            // Up to the next run of three.
            while (end < size && end - start < longest &&
                   (end + 1 >= size || bytes[end] != bytes[end + 1] || end + 2 >= size ||
                    bytes[end + 1] != bytes[end + 2])) {
                ++end;
            }
            if (written + 1 + (end - start) >= size) {
                return 0;
            }
            out[written++] = static_cast<std::byte>(-static_cast<int>(end - start));
            std::memcpy(out + written, bytes.data() + start, end - start);
            written += end - start;
        }
        start = end;
    }
    return written;
}

std::unique_ptr<ChunkEncoder> make_chunk_encoder(const OutputImage& image, const ExrSettings& settings) {
    const Imf::Compression compression = compression_of(settings);
    if (compression == Imf::NO_COMPRESSION) {
        return std::make_unique<PlainEncoder>(chunk_shape(image, settings));
    }
    if (compression == Imf::RLE_COMPRESSION) {
        return std::make_unique<RunEncoder>(chunk_shape(image, settings));
    }
    if (is_zip(compression)) {
        const int level = settings.level ? static_cast<int>(*settings.level) : default_level;
        return std::make_unique<ZipEncoder>(chunk_shape(image, settings), level);
    }
    return make_library_encoder(image, settings);
}

} // namespace clshade
