#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/images/image_reader.h"
#include "host/images/image_writer.h"
#include "host/images/pack.h"
#include "host/images/temporary_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <new>
#include <set>
#include <string_view>

namespace clshade {

namespace {

struct CompressionName {
    std::string_view name;
    Imf::Compression compression;
};
constexpr std::array<CompressionName, 10> compressions{{{"none", Imf::NO_COMPRESSION},
                                                        {"rle", Imf::RLE_COMPRESSION},
                                                        {"zips", Imf::ZIPS_COMPRESSION},
                                                        {"zip", Imf::ZIP_COMPRESSION},
                                                        {"piz", Imf::PIZ_COMPRESSION},
                                                        {"pxr24", Imf::PXR24_COMPRESSION},
                                                        {"b44", Imf::B44_COMPRESSION},
                                                        {"b44a", Imf::B44A_COMPRESSION},
                                                        {"dwaa", Imf::DWAA_COMPRESSION},
                                                        {"dwab", Imf::DWAB_COMPRESSION}}};

bool is_zip(Imf::Compression compression) {
    return compression == Imf::ZIP_COMPRESSION || compression == Imf::ZIPS_COMPRESSION;
}

bool is_dwa(Imf::Compression compression) {
    return compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
}

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

/// Hands OpenEXR's bytes to a temporary, which remembers failures that OpenEXR's destructors swallow.
class ExrStream final : public Imf::OStream {
  public:
    ExrStream(const std::string& name, TemporaryFile& file) : Imf::OStream(name.c_str()), file_(file) {}
    void write(const char* bytes, int count) override {
        file_.write(std::as_bytes(std::span(bytes, static_cast<std::size_t>(std::max(count, 0)))));
    }
    std::uint64_t tellp() override { return file_.position(); }
    void seekp(std::uint64_t offset) override { file_.seek(offset); }

  private:
    TemporaryFile& file_;
};

bool is_half(const OutputChannel& channel, const ExrSettings& settings) {
    return settings.half && !channel.force_float;
}

Imath::Box2i box_of(const Window& window) {
    return {{window.x_min, window.y_min}, {window.x_max, window.y_max}};
}

Imf::Header header_of(const OutputImage& image, const ExrSettings& settings) {
    const Imf::Compression compression = compression_of(settings);
    Imf::Header header(box_of(image.display_window), box_of(image.data_window), static_cast<float>(image.pixel_aspect),
                       Imath::V2f(0.0F, 0.0F), 1.0F, Imf::INCREASING_Y, compression);
    if (settings.level && is_zip(compression)) {
        header.zipCompressionLevel() = static_cast<int>(*settings.level);
    }
    if (settings.level && is_dwa(compression)) {
        header.dwaCompressionLevel() = static_cast<float>(*settings.level);
    }
    for (const OutputChannel& channel : image.channels) {
        header.channels().insert(channel.name, Imf::Channel(is_half(channel, settings) ? Imf::HALF : Imf::FLOAT));
    }
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
    return header;
}

void check_image(const std::string& file, const OutputImage& image) {
    std::set<std::string> names;
    for (const OutputChannel& channel : image.channels) {
        if (channel.name.empty() || !names.insert(channel.name).second) {
            throw RuntimeFailure(
                fmt::format("{}: two output channels are named '{}'; rename a light or a layer", file, channel.name));
        }
        if (channel.slab == nullptr || channel.plane < 0 || channel.plane >= channel.slab->count() ||
            channel.slab->width() != image.data_window.width() ||
            channel.slab->height() != image.data_window.height()) {
            throw RuntimeFailure(
                fmt::format("{}: internal: channel '{}' has not the size of the image", file, channel.name));
        }
    }
    if (image.channels.empty()) {
        throw RuntimeFailure(fmt::format("{}: no channels to write; choose some", file));
    }
}

/// Lines converted and compressed in one go. A multiple of every compression's block (256 lines for dwab), so that
/// blocks, and with them the bytes, do not depend on it.
constexpr int strip_lines = 256;

/// The base OpenEXR counts pixel (x, y) of the file from; outside the memory in general, so computed as a number.
char* base_of(const void* first, int x, int y, std::size_t sample, std::size_t row) {
    const auto address = reinterpret_cast<std::uintptr_t>(first) -
                         static_cast<std::uintptr_t>(std::int64_t{x} * static_cast<std::int64_t>(sample)) -
                         static_cast<std::uintptr_t>(std::int64_t{y} * static_cast<std::int64_t>(row));
    return reinterpret_cast<char*>(address); // NOLINT(performance-no-int-to-ptr): see above
}

/// Returns the number of values clamped to half's range.
std::uint64_t write_pixels(Imf::OutputFile& output, const OutputImage& image, const ExrSettings& settings) {
    const Window& window = image.data_window;
    const auto width = static_cast<std::size_t>(window.width());
    const int lines = is_dwa(output.header().compression()) ? strip_lines * std::max(settings.threads, 1) : strip_lines;
    std::uint64_t clamped = 0;
    std::vector<std::vector<std::uint16_t>> halves(image.channels.size());
    for (int top = 0; top < window.height(); top += lines) {
        const int rows = std::min(lines, window.height() - top);
        Imf::FrameBuffer buffer;
        for (std::size_t i = 0; i < image.channels.size(); ++i) {
            const OutputChannel& channel = image.channels[i];
            if (is_half(channel, settings)) {
                halves[i].resize(width * static_cast<std::size_t>(rows));
                for (int y = 0; y < rows; ++y) {
                    clamped += pack_halves(channel.slab->row(channel.plane, top + y),
                                           halves[i].data() + static_cast<std::size_t>(y) * width);
                }
                const std::size_t row_bytes = width * sizeof(std::uint16_t);
                buffer.insert(channel.name, Imf::Slice(Imf::HALF,
                                                       base_of(halves[i].data(), window.x_min, window.y_min + top,
                                                               sizeof(std::uint16_t), row_bytes),
                                                       sizeof(std::uint16_t), row_bytes));
            } else {
                const std::size_t row_bytes = static_cast<std::size_t>(channel.slab->pitch()) * sizeof(float);
                buffer.insert(channel.name, Imf::Slice(Imf::FLOAT,
                                                       base_of(channel.slab->row(channel.plane, 0).data(), window.x_min,
                                                               window.y_min, sizeof(float), row_bytes),
                                                       sizeof(float), row_bytes));
            }
        }
        output.setFrameBuffer(buffer);
        output.writePixels(rows);
    }
    return clamped;
}

} // namespace

void check_exr_settings(const ExrSettings& settings) {
    static_cast<void>(compression_of(settings));
}

std::uint64_t write_exr(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings) {
    const std::string name = file.string();
    check_image(name, image);
    check_exr_settings(settings);
    std::uint64_t clamped = 0;
    try {
        const int workers = settings.threads > 1 ? settings.threads : 0;
        if (Imf::globalThreadCount() != workers) {
            Imf::setGlobalThreadCount(workers);
        }
        const Imf::Header header = header_of(image, settings);
        TemporaryFile temporary(file);
        ExrStream stream(name, temporary);
        {
            Imf::OutputFile output(stream, header, Imf::globalThreadCount());
            clamped = write_pixels(output, image, settings);
        } // writes the table of chunks
        temporary.close();
        try {
            static_cast<void>(read_layout(temporary.path()));
        } catch (const Error& error) {
            throw RuntimeFailure(
                fmt::format("{}: was not stored as it was written ({}); check the medium", name, error.what()));
        }
        temporary.commit();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw RuntimeFailure(fmt::format("{}: not enough memory to write it; free memory or use fewer threads", name));
    } catch (const std::exception& error) {
        throw RuntimeFailure(fmt::format("{}: cannot be written: {}; check the folder", name, error.what()));
    }
    return clamped;
}

} // namespace clshade
