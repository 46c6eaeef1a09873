// Lat-long pictures in. OpenImageIO decodes the pixels; what an EXR claims is first checked by ExrFile.
#include "host/images/environment_file.h"

#include "host/base/error.h"
#include "host/images/band_halver.h"
#include "host/images/chunk_grid.h"
#include "host/images/exr_file.h"
#include "host/images/radiance_header.h"

#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

namespace {

namespace fs = std::filesystem;

constexpr int smallest_halved_height = 1024;
constexpr int band_rows = 64;
constexpr std::uint64_t texel_bytes = 3 * sizeof(float);
constexpr std::string_view again = "copy or download the file again";

[[noreturn]] void fail(const std::string& file, std::string_view what) {
    throw RuntimeFailure(fmt::format("{}: {}", file, what));
}

/// Where the colours of a picture lie among its channels. Grey: all three the same.
struct Channels {
    std::array<int, 3> index{};
    int first = 0; ///< of those to read
    int count = 0;
};

/// Number of bytes; throws unless it is a readable, regular file.
std::uint64_t checked_size(const std::string& file) {
    struct stat info {};
    if (::stat(file.c_str(), &info) != 0) {
        fail(file, errno == ENOENT ? std::string("no such file; check the path")
                                   : fmt::format("cannot be read: {}; check the path", std::strerror(errno)));
    }
    if (S_ISDIR(info.st_mode)) {
        if (fs::exists(fs::path(file) / "sh.exr") || fs::exists(fs::path(file) / "radiance_n8192.exr")) {
            fail(file, "is a set of maps of which files are missing; remove it and run `clshade prefilter` again");
        }
        fail(file, "is a folder and no set that `clshade prefilter` wrote; name a lat-long .hdr or .exr");
    }
    if (!S_ISREG(info.st_mode)) {
        fail(file, "is not a regular file; name a lat-long .hdr or .exr");
    }
    if (::access(file.c_str(), R_OK) != 0) {
        fail(file, fmt::format("cannot be read: {}; check the permissions", std::strerror(errno)));
    }
    if (info.st_size == 0) {
        fail(file, fmt::format("is empty; {}", again));
    }
    return static_cast<std::uint64_t>(info.st_size);
}

std::array<unsigned char, 4> first_bytes(const std::string& file) {
    std::array<unsigned char, 4> bytes{};
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor >= 0) {
        static_cast<void>(::pread(descriptor, bytes.data(), bytes.size(), 0));
        ::close(descriptor);
    }
    return bytes;
}

/// The header, the sizes and the table of chunks; hostile ones end here, before anything is allocated for them.
void check_exr(const std::string& file) {
    const ExrFile exr(file);
    check_part(exr, 0);
    check_chunks(exr, 0);
}

/// The way to a lat-long picture from six square faces one below the other.
std::string conversion(const std::string& file, std::int64_t face, bool declared) {
    return fmt::format("convert it with `exrenvmap {}-l -w {} {} LATLONG.exr`", declared ? "" : "-ci ", 4 * face, file);
}

void check_shape(const std::string& file, const OIIO::ImageSpec& spec) {
    const std::int64_t width = spec.width;
    const std::int64_t height = spec.height;
    const std::string size = fmt::format("{}x{}", width, height);
    if (width < 1 || height < 1) {
        fail(file, fmt::format("claims {} pixels; {}", size, again));
    }
    // OpenImageIO's name for the attribute `envmap`; some writers store it as a plain number.
    if (spec.get_string_attribute("textureformat") == "CubeFace Environment" ||
        spec.get_int_attribute("envmap", 0) == 1) {
        fail(file, fmt::format("is a cube map ({}), not a lat-long picture; {}", size, conversion(file, width, true)));
    }
    if (width == 2 * height) {
        return;
    }
    if (height == 6 * width) {
        fail(file, fmt::format("looks like the six faces of a cube map ({}), not like a lat-long picture; {}", size,
                               conversion(file, width, false)));
    }
    if (width == 6 * height || 4 * width == 3 * height || 3 * width == 4 * height) {
        const std::int64_t face = std::gcd(width, height);
        fail(file, fmt::format("looks like a cube map ({}), not like a lat-long picture; cut its faces out of it (such "
                               "as `oiiotool {} --cut {}x{}+0+0 -o face+X.exr`; +X -X +Y -Y +Z -Z) and convert them "
                               "with `exrenvmap -l -w {} face%.exr LATLONG.exr`",
                               size, file, face, face, 4 * face));
    }
    fail(file, fmt::format("is {}; a lat-long picture is exactly twice as wide as high; give another", size));
}

/// A part of the picture alone, which happens to be twice as wide as high.
void check_windows(const std::string& file, const OIIO::ImageSpec& spec) {
    const bool cropped = spec.full_width == 2 * spec.full_height && spec.width < spec.full_width &&
                         spec.x >= spec.full_x && spec.x + spec.width <= spec.full_x + spec.full_width;
    if (cropped) {
        fail(file, fmt::format("holds only {}x{} pixels of {}x{} (data and display window); write it whole", spec.width,
                               spec.height, spec.full_width, spec.full_height));
    }
    const int orientation = spec.get_int_attribute("Orientation", 1);
    if (orientation != 1) {
        fail(file, fmt::format("its rows or columns run the other way (orientation {}); convert it with `oiiotool {} "
                               "--reorient -o UPRIGHT.exr`",
                               orientation, file));
    }
}

Channels find_channels(const std::string& file, const OIIO::ImageSpec& spec) {
    const auto index_of = [&](const std::string& name) {
        const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
        return found == spec.channelnames.end() ? -1 : static_cast<int>(found - spec.channelnames.begin());
    };
    std::vector<std::string> layers{""};
    for (const std::string& name : spec.channelnames) { // then a layer such as "ViewLayer.Combined."
        if (name.size() > 2 && name.ends_with(".R")) {
            layers.push_back(name.substr(0, name.size() - 1));
        }
    }
    std::vector<Channels> found;
    for (const std::string& layer : layers) {
        const std::array<int, 3> rgb{index_of(layer + "R"), index_of(layer + "G"), index_of(layer + "B")};
        const int grey = layer.empty() ? index_of("Y") : -1;
        Channels channels;
        if (*std::min_element(rgb.begin(), rgb.end()) >= 0) {
            channels.index = rgb;
        } else if (grey >= 0) {
            channels.index = {grey, grey, grey};
        } else {
            continue;
        }
        channels.first = *std::min_element(channels.index.begin(), channels.index.end());
        channels.count = *std::max_element(channels.index.begin(), channels.index.end()) - channels.first + 1;
        found.push_back(channels);
        if (layer.empty()) {
            break; // the picture itself
        }
    }
    if (found.size() != 1) {
        fail(file, fmt::format("has {} with R, G and B ({}); write one picture with channels R, G, B or Y",
                               found.empty() ? "no layer" : "several layers", fmt::join(spec.channelnames, " ")));
    }
    for (const int index : found[0].index) {
        if (!spec.channelformat(index).is_floating_point()) {
            fail(file, fmt::format("its pixels are {}, whole numbers that hold no radiance; give an .hdr, or an .exr "
                                   "of half or float",
                                   spec.channelformat(index).c_str()));
        }
    }
    return found[0];
}

/// How often to halve the picture so that it fits; `most` bytes, 0: any number.
int halvings_of(const std::string& file, const OIIO::ImageSpec& spec, std::uint64_t most, bool whole) {
    const auto bytes = [](int height) {
        return 2 * static_cast<std::uint64_t>(height) * static_cast<std::uint64_t>(height) * texel_bytes;
    };
    const std::uint64_t mebibytes = (bytes(spec.height) + (1U << 20U) - 1) >> 20U;
    int halvings = 0;
    int height = spec.height;
    while (most > 0 && bytes(height) > most) {
        const char* obstacle = whole                                 ? ", all of which the background shows"
                               : height % 2 != 0                     ? " and cannot be halved (an odd number of rows)"
                               : height / 2 < smallest_halved_height ? " and are not halved below 1024 rows"
                                                                     : nullptr;
        if (obstacle != nullptr) {
            fail(file, fmt::format("{}x{} texels take {} MiB{}; raise --max-mem to {} or more, or scale the picture "
                                   "down first",
                                   spec.width, spec.height, mebibytes, obstacle, mebibytes));
        }
        height /= 2;
        ++halvings;
    }
    return halvings;
}

/// Rows `begin` to `end` (from the top) of the wanted channels, at full resolution.
void read_band(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const Channels& channels, int begin, int end,
               std::vector<float>& raw) {
    raw.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(end - begin) *
               static_cast<std::size_t>(channels.count));
    const int last = channels.first + channels.count;
    const bool done = spec.tile_width > 0
                          ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + begin, spec.y + end, 0, 1,
                                             channels.first, last, OIIO::TypeFloat, raw.data())
                          : input.read_scanlines(0, 0, spec.y + begin, spec.y + end, 0, channels.first, last,
                                                 OIIO::TypeFloat, raw.data());
    if (!done) {
        std::string said = input.geterror();
        std::replace(said.begin(), said.end(), '\n', ' ');
        throw RuntimeFailure(fmt::format("the pixels are damaged or incomplete ({}); {}",
                                         said.empty() ? "no reason given" : said, again));
    }
}

std::vector<float> colours_of(const std::vector<float>& raw, const Channels& channels) {
    std::vector<float> rgb;
    rgb.reserve(raw.size() / static_cast<std::size_t>(channels.count) * 3);
    for (std::size_t at = 0; at < raw.size(); at += static_cast<std::size_t>(channels.count)) {
        for (const int index : channels.index) {
            rgb.push_back(raw[at + static_cast<std::size_t>(index - channels.first)]);
        }
    }
    return rgb;
}

bool is_plain_rgb(const Channels& channels) {
    return channels.count == 3 && channels.index == std::array{channels.first, channels.first + 1, channels.first + 2};
}

std::optional<UpAxis> up_of(const OIIO::ImageSpec& spec) {
    const std::string up = spec.get_string_attribute("oiio:updirection"); // OpenImageIO sets it for `envmap`, too
    if (up == "y") {
        return UpAxis::y;
    }
    if (up == "z") {
        return UpAxis::z;
    }
    return spec.get_int_attribute("envmap", -1) == 0 ? std::optional(UpAxis::y) : std::nullopt;
}

LatLong read_pixels(const std::string& file, OIIO::ImageInput& input, const OIIO::ImageSpec& spec,
                    const Channels& channels, int halvings) {
    BandHalver halver(spec.width, spec.height, halvings);
    // Bands of tiles must begin where tiles do.
    const int step = spec.tile_height > 0 ? spec.tile_height : band_rows;
    LatLong band;
    std::vector<float> raw;
    for (int y = 0; y < spec.height; y += step) {
        read_band(input, spec, channels, y, std::min(y + step, spec.height), raw);
        if (is_plain_rgb(channels)) {
            band.rgb.swap(raw);
        } else {
            band.rgb = colours_of(raw, channels);
        }
        clean(band);
        halver.push(band.rgb);
    }
    if (band.nonfinite == static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height)) {
        throw RuntimeFailure("every texel is NaN or Inf; write the picture again");
    }
    LatLong image;
    image.name = fs::path(file).filename().string();
    image.width = spec.width >> halvings;
    image.height = spec.height >> halvings;
    image.rgb = halver.take();
    image.up = up_of(spec);
    image.halvings = halvings;
    image.negative = band.negative;
    image.nonfinite = band.nonfinite;
    return image;
}

LatLong read_checked(const std::string& file, std::uint64_t max_memory, bool whole) {
    const std::uint64_t size = checked_size(file);
    const std::array<unsigned char, 4> start = first_bytes(file);
    const bool exr = start == std::array<unsigned char, 4>{0x76, 0x2f, 0x31, 0x01};
    const bool radiance = start[0] == '#' && start[1] == '?';
    if (exr) {
        check_exr(file);
    } else if (radiance) {
        check_radiance_header(file);
    }
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file);
    if (input == nullptr) {
        static_cast<void>(OIIO::geterror()); // lists formats and libraries; of no use here
        fail(file, "is not an image that can be read; give a lat-long .hdr or .exr");
    }
    const OIIO::ImageSpec spec = input->spec();
    check_shape(file, spec);
    check_windows(file, spec);
    const Channels channels = find_channels(file, spec);
    const double most_ratio = radiance ? most_radiance_pixels_per_byte : most_pixels_per_byte;
    if (!exr && static_cast<double>(spec.width) * spec.height > static_cast<double>(size) * most_ratio) {
        fail(file, fmt::format("claims {}x{} pixels, more than its {} bytes can hold; {}", spec.width, spec.height,
                               size, again));
    }
    return read_pixels(file, *input, spec, channels, halvings_of(file, spec, max_memory, whole));
}

} // namespace

LatLong read_lat_long(const fs::path& file, std::uint64_t max_memory, bool whole) {
    const std::string name = file.string();
    try {
        return read_checked(name, max_memory, whole);
    } catch (const RuntimeFailure& failure) {
        const std::string what = failure.what();
        if (what.starts_with(name)) {
            throw;
        }
        fail(name, what);
    } catch (const std::bad_alloc&) {
        fail(name, "not enough memory for its pixels; free memory or give --max-mem");
    } catch (const std::exception& error) { // of OpenImageIO and the libraries that it uses
        fail(name, fmt::format("cannot be read ({}); {}", error.what(), again));
    }
}

} // namespace clshade
