#include "host/base/error.h"
#include "host/images/chunk_slices.h"
#include "host/images/library_threads.h"
#include "host/images/part_decoder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfTileDescription.h>
#include <ImfTiledInputPart.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace clshade {

namespace {

// Of the library, the C++ interface: the decoders of OpenEXRCore 3.1.5 survive damaged data as well (found by changing
// bytes of small files under AddressSanitizer), but that of PIZ takes 1.6 times as long, those of B44 refuse sound
// pictures of a few pixels, and there is none for DWA.

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

/// A channel of a tile.
struct TilePlane {
    const PlaneTarget* target = nullptr;
    std::vector<float> pixels;
};

/// The library's reader of one thread. It keeps a chunk of its own, which only one thread at a time can use.
class LibraryReader {
  public:
    LibraryReader(const PartSource& source, std::span<const PlaneTarget> targets)
        : source_(source), targets_(targets), stream_(*source.file), input_(stream_, 0, false) {
        if (source.part >= input_.parts() || !same_part(input_.header(source.part), source)) {
            source.file->fail("changed while it was being read; run again when its writer has finished");
        }
        if (source.grid.tiled) {
            tiles_ = std::make_unique<Imf::TiledInputPart>(input_, source.part);
        } else {
            lines_ = std::make_unique<Imf::InputPart>(input_, source.part);
        }
    }

    void read(std::size_t chunk, const Band& band) {
        const Window area = source_.grid.area(chunk);
        const LineRange lines = lines_in_band(area, band);
        if (!tiles_) {
            aim_at(band);
            lines_->readPixels(area.y_min + lines.first, area.y_min + lines.last);
            return;
        }
        if (lines.first == 0 && lines.last == area.height() - 1) {
            aim_at(band);
            read_tile(chunk);
            return;
        }
        // Of a tile all lines arrive, also those that are not in the band.
        aim_at_tile();
        read_tile(chunk);
        for (const TilePlane& plane : tile_) {
            for (int line = lines.first; line <= lines.last; ++line) {
                std::copy_n(plane.pixels.data() + std::ptrdiff_t{line} * source_.grid.chunk_width, area.width(),
                            band.at(plane.target->plane, area.x_min, area.y_min + line));
            }
        }
    }

  private:
    void read_tile(std::size_t chunk) {
        tiles_->readTile(static_cast<int>(chunk % source_.grid.across), static_cast<int>(chunk / source_.grid.across));
    }

    void set_buffer(const Imf::FrameBuffer& buffer) {
        if (tiles_) {
            tiles_->setFrameBuffer(buffer);
        } else {
            lines_->setFrameBuffer(buffer);
        }
    }

    /// The library is to store pixels in the planes.
    void aim_at(const Band& band) {
        const float* planes = band.planes->data();
        if (planes == planes_ && band.area == area_) {
            return;
        }
        Imf::FrameBuffer buffer;
        const std::size_t line = static_cast<std::size_t>(band.planes->pitch()) * sizeof(float);
        // It addresses pixel (x, y) of the file as base + x * 4 + y * line, so that the base may lie outside the plane:
        // computed as a number, for it is no valid pointer.
        const std::int64_t corner =
            (std::int64_t{band.area.y_min} * band.planes->pitch() + band.area.x_min) * std::int64_t{sizeof(float)};
        for (const PlaneTarget& target : targets_) {
            const auto base =
                reinterpret_cast<std::uintptr_t>(band.at(target.plane, band.area.x_min, band.area.y_min)) -
                static_cast<std::uintptr_t>(corner);
            buffer.insert(target.channel,
                          Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base), // NOLINT(performance-no-int-to-ptr)
                                     sizeof(float), line));
        }
        set_buffer(buffer);
        planes_ = planes;
        area_ = band.area;
    }

    /// The library is to store a tile in memory of ours.
    void aim_at_tile() {
        const std::size_t width = static_cast<std::size_t>(source_.grid.chunk_width);
        Imf::FrameBuffer buffer;
        tile_.resize(targets_.size());
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            tile_[i].target = &targets_[i];
            tile_[i].pixels.resize(width * static_cast<std::size_t>(source_.grid.chunk_height));
            buffer.insert(targets_[i].channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(tile_[i].pixels.data()),
                                                          sizeof(float), width * sizeof(float), 1, 1, 0.0, true, true));
        }
        set_buffer(buffer);
        planes_ = nullptr;
    }

    const PartSource& source_;
    std::span<const PlaneTarget> targets_;
    LibraryStream stream_;
    Imf::MultiPartInputFile input_;
    std::unique_ptr<Imf::InputPart> lines_;
    std::unique_ptr<Imf::TiledInputPart> tiles_;
    const float* planes_ = nullptr; ///< where the library stores pixels now
    Window area_;
    std::vector<TilePlane> tile_;
};

class LibraryDecoder : public PartDecoder {
  public:
    explicit LibraryDecoder(const PartSource& source)
        : source_(source), chunk_bytes_(bytes_of_chunk(source.grid, find_slices(source))) {
        stop_library_threads();
        for (const PlaneTarget& target : source.targets) {
            const auto first = std::find_if(targets_.begin(), targets_.end(),
                                            [&](const PlaneTarget& known) { return known.channel == target.channel; });
            if (first == targets_.end()) {
                targets_.push_back(target);
            } else {
                copies_.emplace_back(first->plane, target.plane);
            }
        }
    }

    [[nodiscard]] std::size_t chunk_bytes() const override { return chunk_bytes_; }

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
                fail_chunk(source_, chunk, error.what());
            }
        }
    }

  private:
    void decode_chunk(std::size_t chunk, const Band& band) {
        std::unique_ptr<LibraryReader>& reader = readers_.local();
        if (!reader) {
            reader = std::make_unique<LibraryReader>(source_, targets_);
        }
        reader->read(chunk, band);
        const Window area = source_.grid.area(chunk);
        const LineRange lines = lines_in_band(area, band);
        for (const auto& [from, to] : copies_) {
            for (int line = lines.first; line <= lines.last; ++line) {
                std::copy_n(band.at(from, area.x_min, area.y_min + line), area.width(),
                            band.at(to, area.x_min, area.y_min + line));
            }
        }
    }

    const PartSource& source_;
    std::size_t chunk_bytes_;
    std::vector<PlaneTarget> targets_;        ///< each channel once, as the library wants them
    std::vector<std::pair<int, int>> copies_; ///< planes of channels that are wanted again
    tbb::enumerable_thread_specific<std::unique_ptr<LibraryReader>> readers_;
};

} // namespace

std::unique_ptr<PartDecoder> make_library_decoder(const PartSource& source) {
    return std::make_unique<LibraryDecoder>(source);
}

} // namespace clshade
