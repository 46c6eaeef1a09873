#include "host/images/exr_header.h"

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/images/completion.h"
#include "host/images/stamp.h"

#include <ImfChannelList.h>
#include <ImfIO.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

namespace clshade {

namespace {

struct CompressionName {
    std::string_view name;
    Imf::Compression compression;
    int rows; ///< of a chunk
};
constexpr std::array<CompressionName, 10> compressions{{{"none", Imf::NO_COMPRESSION, 1},
                                                        {"rle", Imf::RLE_COMPRESSION, 1},
                                                        {"zips", Imf::ZIPS_COMPRESSION, 1},
                                                        {"zip", Imf::ZIP_COMPRESSION, 16},
                                                        {"piz", Imf::PIZ_COMPRESSION, 32},
                                                        {"pxr24", Imf::PXR24_COMPRESSION, 16},
                                                        {"b44", Imf::B44_COMPRESSION, 32},
                                                        {"b44a", Imf::B44A_COMPRESSION, 32},
                                                        {"dwaa", Imf::DWAA_COMPRESSION, 32},
                                                        {"dwab", Imf::DWAB_COMPRESSION, 256}}};

bool is_dwa(Imf::Compression compression) {
    return compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
}

Imath::Box2i box_of(const Window& window) {
    return {{window.x_min, window.y_min}, {window.x_max, window.y_max}};
}

/// A file in memory, for OpenEXR to write to.
class MemoryStream final : public Imf::OStream {
  public:
    MemoryStream() : Imf::OStream("memory") {}
    void write(const char* bytes, int count) override {
        const auto size = static_cast<std::size_t>(std::max(count, 0));
        bytes_.resize(std::max(bytes_.size(), position_ + size));
        std::memcpy(bytes_.data() + position_, bytes, size);
        position_ += size;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t offset) override { position_ = static_cast<std::size_t>(offset); }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
    std::size_t position_ = 0;
};

} // namespace

Imf::Compression compression_of(const ExrSettings& settings) {
    const auto* found = std::find_if(compressions.begin(), compressions.end(),
                                     [&](const CompressionName& known) { return known.name == settings.compression; });
    if (found == compressions.end()) {
        std::array<std::string_view, compressions.size()> names{};
        std::transform(compressions.begin(), compressions.end(), names.begin(),
                       [](const CompressionName& known) { return known.name; });
        throw UsageError(fmt::format("--compression {}: unknown compression; use one of {}{}", settings.compression,
                                     fmt::join(names, " "), did_you_mean(settings.compression, names)));
    }
    if (settings.level) {
        const double level = *settings.level;
        if (is_zip(found->compression) && !(level >= 1 && level <= 9 && level == std::floor(level))) {
            throw UsageError(
                fmt::format("--compression {}:{}: the level is a whole number from 1 to 9", found->name, level));
        }
        if (is_dwa(found->compression) && !(level >= 0 && level <= 1e6)) {
            throw UsageError(
                fmt::format("--compression {}:{}: the level is 0 or more (45 is usual)", found->name, level));
        }
        if (!is_zip(found->compression) && !is_dwa(found->compression)) {
            throw UsageError(
                fmt::format("--compression {}:{}: {} has no level; use zip:1..9, zips:1..9, dwaa:N or dwab:N",
                            found->name, level, found->name));
        }
    }
    return found->compression;
}

bool is_zip(Imf::Compression compression) {
    return compression == Imf::ZIP_COMPRESSION || compression == Imf::ZIPS_COMPRESSION;
}

int chunk_rows(Imf::Compression compression) {
    const auto* found = std::find_if(compressions.begin(), compressions.end(),
                                     [&](const CompressionName& known) { return known.compression == compression; });
    return found == compressions.end() ? 1 : found->rows;
}

bool is_half(const OutputChannel& channel, const ExrSettings& settings) {
    return settings.half && !channel.force_float;
}

int block_rows(const ExrSettings& settings) {
    return chunk_rows(compression_of(settings));
}

void check_exr_settings(const ExrSettings& settings) {
    static_cast<void>(compression_of(settings));
}

Imf::Header plain_header(const Window& data_window, const std::vector<OutputChannel>& channels,
                         const ExrSettings& settings) {
    const Imf::Compression compression = compression_of(settings);
    Imf::Header header(box_of(data_window), box_of(data_window), 1.0F, Imath::V2f(0.0F, 0.0F), 1.0F, Imf::INCREASING_Y,
                       compression);
    if (settings.level && is_dwa(compression)) {
        header.dwaCompressionLevel() = static_cast<float>(*settings.level);
    }
    for (const OutputChannel& channel : channels) {
        header.channels().insert(channel.name, Imf::Channel(is_half(channel, settings) ? Imf::HALF : Imf::FLOAT));
    }
    return header;
}

ExrHead make_head(const OutputImage& image, const ExrSettings& settings) {
    Imf::Header header = plain_header(image.data_window, image.channels, settings);
    header.displayWindow() = box_of(image.display_window);
    header.pixelAspectRatio() = static_cast<float>(image.pixel_aspect);
    header.insert("software", Imf::StringAttribute("clshade"));
    for (const auto& [name, text] : image.attributes) {
        header.insert(name, Imf::StringAttribute(text));
    }
    for (const auto& [name, matrix] : image.matrices) {
        Imath::M44f stored;
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column) {
                stored[row][column] = static_cast<float>(matrix[row][column]);
            }
        }
        header.insert(name, Imf::M44fAttribute(stored));
    }
    header.insert(completion_attribute, Imf::StringAttribute(stamp_text({})));

    MemoryStream stream;
    // Writes the header and an empty table; without pixels there is nothing else in it.
    { const Imf::OutputFile file(stream, header, 0); }
    ExrHead head;
    head.bytes = stream.take();
    const int rows = chunk_rows(header.compression());
    head.chunks = (image.data_window.height() + rows - 1) / rows;
    head.table = head.bytes.size() - static_cast<std::size_t>(head.chunks) * sizeof(std::uint64_t);
    if (const auto place = find_exr_stamp(head.bytes)) {
        head.stamp = place->offset;
    } else {
        throw RuntimeFailure("internal: the header has no completion stamp");
    }
    return head;
}

} // namespace clshade
