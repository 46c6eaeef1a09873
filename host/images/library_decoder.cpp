#include "host/base/error.h"
#include "host/images/chunk_slices.h"
#include "host/images/part_decoder.h"
#include "host/images/unpack.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfTileDescription.h>
#include <ImfTiledInputPart.h>
#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <span>

namespace clshade {

namespace {

/// The library's view of the file that is open already: what stands under its name may be another by now.
class LibraryStream : public Imf::IStream {
  public:
    explicit LibraryStream(const ExrFile& file) : Imf::IStream(file.name().c_str()), file_(file) {}

    bool read(char* bytes, int count) override {
        auto out = std::as_writable_bytes(std::span(bytes, static_cast<std::size_t>(std::max(count, 0))));
        while (!out.empty()) {
            const std::span<const std::byte> ready = buffered();
            if (ready.empty() && out.size() >= buffer_bytes) {
                file_.read_at(position_, out);
                position_ += out.size();
                break;
            }
            if (ready.empty()) {
                fill();
                continue;
            }
            const std::size_t taken = std::min(ready.size(), out.size());
            std::memcpy(out.data(), ready.data(), taken);
            out = out.subspan(taken);
            position_ += taken;
        }
        return position_ < file_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

  private:
    static constexpr std::size_t buffer_bytes = 8192; ///< the library reads headers byte by byte

    [[nodiscard]] std::span<const std::byte> buffered() const {
        if (position_ < start_ || position_ >= start_ + buffer_.size()) {
            return {};
        }
        return std::span(buffer_).subspan(position_ - start_);
    }
    void fill() {
        if (position_ >= file_.size()) {
            file_.fail("ends before its pixels do; render or copy the file again");
        }
        buffer_.resize(std::min<std::uint64_t>(buffer_bytes, file_.size() - position_));
        file_.read_at(position_, buffer_);
        start_ = position_;
    }

    const ExrFile& file_;
    std::uint64_t position_ = 0;
    std::uint64_t start_ = 0; ///< of buffer_ in the file
    std::vector<std::byte> buffer_;
};

/// Does the library see the part that OpenEXRCore saw? The file may be written to meanwhile, and the library would
/// store as many pixels as it then claims.
bool same_part(const Imf::Header& header, const PartSource& source) {
    const Imath::Box2i& window = header.dataWindow();
    if (Window{window.min.x, window.min.y, window.max.x, window.max.y} != source.grid.window ||
        header.hasTileDescription() != source.grid.tiled) {
        return false;
    }
    if (source.grid.tiled) {
        // OpenEXRCore cuts the tiles of small pictures to the picture.
        const Imf::TileDescription& tile = header.tileDescription();
        const auto side = [](unsigned size, int picture) {
            return static_cast<int>(std::min(size, static_cast<unsigned>(picture)));
        };
        if (side(tile.xSize, source.grid.window.width()) != source.grid.chunk_width ||
            side(tile.ySize, source.grid.window.height()) != source.grid.chunk_height) {
            return false;
        }
    }
    return std::all_of(source.targets.begin(), source.targets.end(), [&](const PlaneTarget& target) {
        const Imf::Channel* channel = header.channels().findChannel(target.channel);
        return channel != nullptr && channel->xSampling == 1 && channel->ySampling == 1;
    });
}

Imf::PixelType pixel_type(SampleType type) {
    switch (type) {
    case SampleType::half:
        return Imf::HALF;
    case SampleType::uint32:
        return Imf::UINT;
    default:
        return Imf::FLOAT;
    }
}

/// The library's reader of one thread. It keeps a chunk of its own, which only one thread at a time can use.
class LibraryReader {
  public:
    explicit LibraryReader(const PartSource& source)
        : source_(source), stream_(*source.file), input_(stream_, 0, false) {
        if (source.part >= input_.parts() || !same_part(input_.header(source.part), source)) {
            source.file->fail("changed while it was being read; run again when its writer has finished");
        }
        if (source.grid.tiled) {
            tiles_ = std::make_unique<Imf::TiledInputPart>(input_, source.part);
        } else {
            lines_ = std::make_unique<Imf::InputPart>(input_, source.part);
        }
    }

    /// Samples of lines first to last of a chunk, in their own types: plane after plane, line after line.
    void read(std::size_t chunk, const LineRange& lines, const ChunkSlices& layout) {
        const Window area = source_.grid.area(chunk);
        const auto width = static_cast<std::size_t>(area.width());
        // Of tiles, all lines arrive.
        const int first = tiles_ ? 0 : lines.first;
        const int last = tiles_ ? area.height() - 1 : lines.last;
        first_line_ = first;
        width_ = width;
        samples_per_channel_ = width * static_cast<std::size_t>(last - first + 1);
        samples_.resize(samples_per_channel_ * layout.slices.size());
        Imf::FrameBuffer buffer;
        for (std::size_t i = 0; i < layout.slices.size(); ++i) {
            const ChunkSlice& slice = layout.slices[i];
            const std::size_t bytes = bytes_of(slice.type);
            // The library addresses sample (x, y) as base + x * bytes + y * width * bytes; of tiles from their corner,
            // of lines in the file's coordinates: the base may lie outside the memory, so that it is reckoned as a
            // number.
            const std::int64_t corner =
                tiles_ ? 0 : std::int64_t{area.y_min + first} * area.width() + std::int64_t{area.x_min};
            const std::uintptr_t base = reinterpret_cast<std::uintptr_t>(plane(i)) -
                                        static_cast<std::uintptr_t>(corner * static_cast<std::int64_t>(bytes));
            buffer.insert(source_.targets[slice.target].channel,
                          Imf::Slice(pixel_type(slice.type),
                                     reinterpret_cast<char*>(base), // NOLINT(performance-no-int-to-ptr): see above
                                     bytes, width * bytes, 1, 1, 0.0, tiles_ != nullptr, tiles_ != nullptr));
        }
        if (tiles_) {
            tiles_->setFrameBuffer(buffer);
            tiles_->readTile(static_cast<int>(chunk % source_.grid.across),
                             static_cast<int>(chunk / source_.grid.across));
        } else {
            lines_->setFrameBuffer(buffer);
            lines_->readPixels(area.y_min + first, area.y_min + last);
        }
    }

    /// What read() left: the samples of a line of the chunk.
    [[nodiscard]] const std::byte* line(std::size_t slice, int line, SampleType type) const {
        const auto row = static_cast<std::size_t>(line - first_line_);
        return reinterpret_cast<const std::byte*>(samples_.data() + slice * samples_per_channel_) +
               row * width_ * bytes_of(type);
    }

  private:
    [[nodiscard]] std::uint32_t* plane(std::size_t slice) { return samples_.data() + slice * samples_per_channel_; }

    const PartSource& source_;
    LibraryStream stream_;
    Imf::MultiPartInputFile input_;
    std::unique_ptr<Imf::InputPart> lines_;
    std::unique_ptr<Imf::TiledInputPart> tiles_;
    std::vector<std::uint32_t> samples_; ///< room for 4 bytes a sample, and aligned for them
    std::size_t samples_per_channel_ = 0;
    std::size_t width_ = 0;
    int first_line_ = 0;
};

class LibraryDecoder : public PartDecoder {
  public:
    explicit LibraryDecoder(const PartSource& source) : source_(source), layout_(find_slices(source)) {}

    [[nodiscard]] std::size_t chunk_bytes() const override {
        return layout_.pixel_bytes * static_cast<std::size_t>(source_.grid.chunk_width) *
               static_cast<std::size_t>(source_.grid.chunk_height);
    }

    void decode(std::size_t first, std::size_t last, const Band& band) override {
        for (std::size_t chunk = first; chunk < last; ++chunk) {
            // The library is handed nothing implausible.
            static_cast<void>(find_chunk(*source_.file, source_.part, source_.grid, chunk));
            try {
                decode_chunk(chunk, band);
            } catch (const RuntimeFailure&) {
                throw;
            } catch (const std::bad_alloc&) {
                throw;
            } catch (const std::exception& error) {
                const std::string label = source_.file->part_label(source_.part);
                source_.file->fail(fmt::format("{}pixels of chunk {} are damaged ({}); render or copy the file again",
                                               label.empty() ? "" : label + ": ", chunk, error.what()));
            }
        }
    }

  private:
    void decode_chunk(std::size_t chunk, const Band& band) {
        std::unique_ptr<LibraryReader>& reader = readers_.local();
        if (!reader) {
            reader = std::make_unique<LibraryReader>(source_);
        }
        const Window area = source_.grid.area(chunk);
        const LineRange lines = lines_in_band(area, band);
        reader->read(chunk, lines, layout_);
        for (std::size_t i = 0; i < layout_.slices.size(); ++i) {
            const ChunkSlice& slice = layout_.slices[i];
            for (int line = lines.first; line <= lines.last; ++line) {
                unpack_row(slice.type, reader->line(i, line, slice.type), static_cast<std::size_t>(area.width()),
                           band.at(slice.plane, area.x_min, area.y_min + line));
            }
        }
    }

    const PartSource& source_;
    ChunkSlices layout_;
    tbb::enumerable_thread_specific<std::unique_ptr<LibraryReader>> readers_;
};

} // namespace

std::unique_ptr<PartDecoder> make_library_decoder(const PartSource& source) {
    return std::make_unique<LibraryDecoder>(source);
}

} // namespace clshade
