#include "host/environment/lat_long.h"

#include "host/base/hash.h"
#include "host/environment/filter_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

namespace clshade {

namespace {

constexpr std::size_t channels = 3;

std::size_t row_floats(const LatLong& image) {
    return static_cast<std::size_t>(image.width) * channels;
}

/// A picture of another size with the same history.
LatLong resized(const LatLong& image, int width, int height) {
    LatLong result;
    result.name = image.name;
    result.width = width;
    result.height = height;
    result.up = image.up;
    result.halvings = image.halvings;
    result.negative = image.negative;
    result.nonfinite = image.nonfinite;
    result.rgb.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels);
    return result;
}

/// Doubles a row: 3/4 of the texel itself and 1/4 of its neighbour, to either side.
void double_row(std::span<const double> row, std::span<float> out) {
    const std::size_t width = row.size() / channels;
    for (std::size_t x = 0; x < width; ++x) {
        const std::size_t left = (x + width - 1) % width;
        const std::size_t right = (x + 1) % width;
        for (std::size_t c = 0; c < channels; ++c) {
            const double own = 0.75 * row[x * channels + c];
            out[2 * x * channels + c] = static_cast<float>(own + 0.25 * row[left * channels + c]);
            out[(2 * x + 1) * channels + c] = static_cast<float>(own + 0.25 * row[right * channels + c]);
        }
    }
}

} // namespace

void clean(LatLong& image) {
    for (std::size_t i = 0; i + channels <= image.rgb.size(); i += channels) {
        const std::span<float> texel(&image.rgb[i], channels);
        if (!std::all_of(texel.begin(), texel.end(), [](float value) { return std::isfinite(value); })) {
            std::fill(texel.begin(), texel.end(), 0.0F);
            ++image.nonfinite;
        } else if (std::any_of(texel.begin(), texel.end(), [](float value) { return value < 0.0F; })) {
            std::transform(texel.begin(), texel.end(), texel.begin(),
                           [](float value) { return std::max(value, 0.0F); });
            ++image.negative;
        }
    }
}

double texel_solid_angle(int width, int height, int y) {
    // cos a - cos b = 2 sin((a+b)/2) sin((b-a)/2), which loses no digits at the poles.
    const double step = std::numbers::pi / height;
    return 2.0 * std::numbers::pi / width * 2.0 * std::sin((y + 0.5) * step) * std::sin(0.5 * step);
}

void halve_rows(std::span<const float> upper, std::span<const float> lower, double share, std::span<float> out) {
    for (std::size_t x = 0; 2 * x < upper.size() / channels; ++x) {
        for (std::size_t c = 0; c < channels; ++c) {
            const std::size_t left = 2 * x * channels + c;
            const std::size_t right = left + channels;
            const double above = 0.5 * (static_cast<double>(upper[left]) + static_cast<double>(upper[right]));
            const double below = 0.5 * (static_cast<double>(lower[left]) + static_cast<double>(lower[right]));
            out[x * channels + c] = static_cast<float>(share * above + (1.0 - share) * below);
        }
    }
}

double upper_share(int width, int height, int y) {
    const double upper = texel_solid_angle(width, height, 2 * y);
    return upper / (upper + texel_solid_angle(width, height, 2 * y + 1));
}

LatLong halved(const LatLong& image) {
    if (image.width % 2 != 0 || image.height % 2 != 0 || image.width < 2 || image.height < 2) {
        throw std::invalid_argument(
            fmt::format("{}: {}x{} texels cannot be halved", image.name, image.width, image.height));
    }
    LatLong half = resized(image, image.width / 2, image.height / 2);
    const std::span<const float> texels(image.rgb);
    for (int y = 0; y < half.height; ++y) {
        const std::size_t first = 2 * static_cast<std::size_t>(y) * row_floats(image);
        halve_rows(texels.subspan(first, row_floats(image)),
                   texels.subspan(first + row_floats(image), row_floats(image)),
                   upper_share(image.width, image.height, y),
                   std::span(half.rgb).subspan(static_cast<std::size_t>(y) * row_floats(half), row_floats(half)));
    }
    return half;
}

LatLong doubled(const LatLong& image) {
    if (image.width % 2 != 0 || image.width < 2 || image.height < 1) {
        throw std::invalid_argument(
            fmt::format("{}: {}x{} texels cannot be doubled", image.name, image.width, image.height));
    }
    const std::size_t floats = row_floats(image);
    // Row y; beyond a pole the nearest row, half a turn on.
    const auto texel = [&](int y, std::size_t i) {
        const bool beyond = y < 0 || y >= image.height;
        const auto row = static_cast<std::size_t>(std::clamp(y, 0, image.height - 1));
        return static_cast<double>(image.rgb[row * floats + (beyond ? (i + floats / 2) % floats : i)]);
    };
    LatLong twice = resized(image, 2 * image.width, 2 * image.height);
    std::vector<double> row(floats);
    for (int y = 0; y < twice.height; ++y) {
        const int own = y / 2;
        const int other = y % 2 == 0 ? own - 1 : own + 1;
        for (std::size_t i = 0; i < floats; ++i) {
            row[i] = 0.75 * texel(own, i) + 0.25 * texel(other, i);
        }
        double_row(row, std::span(twice.rgb).subspan(static_cast<std::size_t>(y) * 2 * floats, 2 * floats));
    }
    return twice;
}

int source_height(int width, int height, double shininess) {
    if (width < 1 || height < 1) {
        throw std::invalid_argument(fmt::format("a picture of {}x{} texels", width, height));
    }
    while (height < smallest_source_height) {
        width *= 2;
        height *= 2;
    }
    const double largest_texel = 2.0 / std::sqrt(shininess) / texels_per_deviation;
    while (width % 2 == 0 && height % 2 == 0 && std::numbers::pi / (0.5 * height) <= largest_texel) {
        width /= 2;
        height /= 2;
    }
    return height;
}

LatLong filter_source(const LatLong& image, double shininess) {
    const int wanted = source_height(image.width, image.height, shininess);
    LatLong source = image;
    while (source.height < smallest_source_height) {
        source = doubled(source);
    }
    while (source.height > wanted) {
        source = halved(source);
    }
    return source;
}

std::string content_hash(const LatLong& image) {
    return hash_hex(fmt::format("{}x{} {}", image.width, image.height, hash_hex(std::as_bytes(std::span(image.rgb)))));
}

} // namespace clshade
