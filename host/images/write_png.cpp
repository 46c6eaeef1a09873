#include "host/base/error.h"
#include "host/images/completion.h"
#include "host/images/image_writer.h"
#include "host/images/pack.h"
#include "host/images/stamp.h"
#include "host/images/temporary_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <new>
#include <string_view>

namespace clshade {

namespace {

/// Of zlib. Above, a preview takes twice as long and gets a few percent smaller.
constexpr int png_level = 4;

const OutputChannel* find_channel(const OutputImage& image, std::string_view name) {
    const auto found = std::find_if(image.channels.begin(), image.channels.end(),
                                    [&](const OutputChannel& channel) { return channel.name == name; });
    return found == image.channels.end() ? nullptr : &*found;
}

/// Rows of 8-bit pixels, three or four samples each.
std::vector<std::uint8_t> display_pixels(const std::array<const OutputChannel*, 3>& colours, const OutputChannel* alpha,
                                         int width, int height) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * (alpha != nullptr ? 4 : 3));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float a = alpha != nullptr ? alpha->slab->at(alpha->plane, x, y) : 1.0F;
            const float scale = a > 0.0F ? 1.0F / std::min(a, 1.0F) : 1.0F; // NaN and 0: as it is
            for (const OutputChannel* colour : colours) {
                bytes.push_back(srgb_byte(colour->slab->at(colour->plane, x, y) * scale));
            }
            if (alpha != nullptr) {
                bytes.push_back(unit_byte(a));
            }
        }
    }
    return bytes;
}

/// The PNG file as bytes: in memory first, so that every byte goes through TemporaryFile and its checks.
std::vector<unsigned char> encode(const std::string& name, const std::vector<std::uint8_t>& pixels, int width,
                                  int height, int channels, const OutputImage& image) {
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput memory(encoded);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("preview.png", &memory);
    if (output == nullptr) {
        throw RuntimeFailure(
            fmt::format("{}: this OpenImageIO cannot write PNG ({}); write .exr", name, OIIO::geterror()));
    }
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1); // divided here already, in linear light
    spec.attribute("Software", "clshade");
    spec.attribute("png:compressionLevel", png_level);
    spec.attribute("PixelAspectRatio", static_cast<float>(image.pixel_aspect));
    if (!output->open("preview.png", spec) || !output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) ||
        !output->close()) {
        throw RuntimeFailure(fmt::format("{}: cannot be encoded: {}; write .exr", name, output->geterror()));
    }
    return encoded;
}

/// Puts the job and the stamp before the last chunk. Returns the hash.
std::uint64_t complete(std::vector<unsigned char>& png, const OutputImage& image) {
    constexpr std::size_t end_chunk = 12; // IEND: length, name, checksum
    std::string texts;
    if (const auto job = image.attributes.find(job_attribute); job != image.attributes.end()) {
        texts += png_text_chunk(job_attribute, job->second);
    }
    const std::size_t stamp_at = texts.size();
    Stamp stamp;
    texts += png_text_chunk(completion_attribute, stamp_text(stamp));
    stamp.bytes = png.size() + texts.size();
    texts.replace(stamp_at, std::string::npos, png_text_chunk(completion_attribute, stamp_text(stamp)));
    std::fill(texts.end() - 4, texts.end(), '\0'); // the checksum follows from the hash
    const auto texts_at = png.insert(png.end() - end_chunk, texts.begin(), texts.end());
    StreamHash hash;
    hash.add(std::as_bytes(std::span(png)));
    stamp.hash = hash.value();
    const std::string chunk = png_text_chunk(completion_attribute, stamp_text(stamp));
    std::copy(chunk.begin(), chunk.end(), texts_at + static_cast<std::ptrdiff_t>(stamp_at));
    return stamp.hash;
}

} // namespace

WrittenFile write_png(const std::filesystem::path& file, const OutputImage& image, Replace replace) {
    const auto start = std::chrono::steady_clock::now();
    const std::string name = file.string();
    const std::array<const OutputChannel*, 3> colours{find_channel(image, "R"), find_channel(image, "G"),
                                                      find_channel(image, "B")};
    const OutputChannel* alpha = find_channel(image, "A");
    const int width = image.data_window.width();
    const int height = image.data_window.height();
    for (const OutputChannel* channel : {colours[0], colours[1], colours[2], alpha != nullptr ? alpha : colours[0]}) {
        if (channel == nullptr || channel->slab == nullptr || channel->plane < 0 ||
            channel->plane >= channel->slab->count() || channel->slab->width() != width ||
            channel->slab->height() != height) {
            throw RuntimeFailure(fmt::format("{}: a preview needs channels R, G and B; write .exr", name));
        }
    }
    try {
        const std::vector<std::uint8_t> pixels = display_pixels(colours, alpha, width, height);
        std::vector<unsigned char> encoded = encode(name, pixels, width, height, alpha != nullptr ? 4 : 3, image);
        WrittenFile written;
        written.hash = complete(encoded, image);
        written.bytes = encoded.size();
        TemporaryFile temporary(file);
        temporary.write(std::as_bytes(std::span(encoded)));
        temporary.close();
        if (replace == Replace::yes) {
            temporary.commit();
        } else {
            written.existed = !temporary.commit_new();
        }
        const std::chrono::duration<double, std::milli> busy = std::chrono::steady_clock::now() - start;
        written.busy_milliseconds = busy.count();
        return written;
    } catch (const std::bad_alloc&) {
        throw RuntimeFailure(fmt::format("{}: not enough memory to write it; free memory", name));
    }
}

} // namespace clshade
