#include "host/prefilter/filter_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace clshade {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int most_lanes = 16;
/// Exponent e^-21 = 1e-9 of the lobe's Gaussian form, beyond which texels may be left out (filter_layout.h).
constexpr double reach_exponent = 21.0;
constexpr int pitch_alignment = 16;

std::size_t index_of(int value) {
    return static_cast<std::size_t>(value);
}

void copy_repeated(std::span<const float> row, int channel, std::span<float> out) {
    const std::size_t width = row.size() / 3;
    for (std::size_t x = 0; x < std::min(width, out.size()); ++x) {
        out[x] = row[3 * x + index_of(channel)];
    }
    for (std::size_t x = width; x < out.size(); ++x) {
        out[x] = out[x - width];
    }
}

/// Angle from R within which texels count [rad].
double reach_angle(double shininess) {
    return shininess == 0.0 ? pi / 2.0 : std::min(pi, std::sqrt(8.0 * reach_exponent / shininess));
}

} // namespace

FilterPicture filter_picture(const LatLong& source) {
    FilterPicture picture;
    picture.width = source.width;
    picture.height = source.height;
    const int columns = 2 * source.width + most_lanes;
    picture.pitch = (columns + pitch_alignment - 1) / pitch_alignment * pitch_alignment;
    picture.texels.resize(3 * index_of(picture.height) * index_of(picture.pitch));
    for (int channel = 0; channel < 3; ++channel) {
        for (int y = 0; y < source.height; ++y) {
            const std::size_t target = index_of(channel * source.height + y) * index_of(picture.pitch);
            copy_repeated(
                std::span(source.rgb).subspan(3 * index_of(y) * index_of(source.width), 3 * index_of(source.width)),
                channel, std::span(picture.texels).subspan(target, index_of(picture.pitch)));
        }
    }
    for (int y = 0; y < source.height; ++y) {
        picture.rows.push_back(static_cast<float>(std::sin(pi * (y + 0.5) / source.height)));
    }
    for (int y = 0; y < source.height; ++y) {
        picture.rows.push_back(static_cast<float>(texel_solid_angle(source.width, source.height, y)));
    }
    picture.middle = std::max(source.width / 2, source.height) + most_lanes;
    const int entries = 2 * picture.middle + most_lanes;
    for (int k = 0; k < entries; ++k) {
        picture.half_angles.push_back(static_cast<float>(std::sin(pi * (k - picture.middle) / source.width)));
    }
    for (int k = 0; k < entries; ++k) {
        picture.half_angles.push_back(static_cast<float>(std::cos(pi * (k - picture.middle) / source.width)));
    }
    return picture;
}

FilterSource filter_source_constants(const FilterPicture& picture, double shininess, int cells) {
    const double angle = reach_angle(shininess);
    FilterSource source{};
    source.width = picture.width;
    source.height = picture.height;
    source.pitch = picture.pitch;
    source.middle = picture.middle;
    source.table = static_cast<int>(picture.half_angles.size() / 2);
    source.rows = std::min(picture.height, static_cast<int>(angle * picture.height / pi) + 1);
    source.reach = static_cast<float>(std::pow(std::sin(angle / 2.0), 2.0));
    source.half_exponent = static_cast<float>(shininess / 2.0);
    source.cosine = shininess == 0.0 ? 1 : 0;
    source.cells = cells;
    return source;
}

std::vector<FilterDirection> filter_directions(const FilterPicture& picture, int cells) {
    const int half = cells / 2;
    std::vector<FilterDirection> directions;
    directions.reserve(index_of(half + 1) * index_of(half + 2) / 2);
    for (int b = 0; b <= half; ++b) {
        for (int a = 0; a + b <= half; ++a) {
            const double theta = std::atan2(std::hypot(a, b), half - a - b);
            // u = 0.5 - phi/(2 pi); a texel's index is that of its centre.
            const double column = (0.5 - std::atan2(b, a) / (2.0 * pi)) * picture.width - 0.5;
            const double row = theta / pi * picture.height - 0.5;
            const double column_rest = pi * (column - std::round(column)) / picture.width;
            const double row_rest = pi / 2.0 * (row - std::round(row)) / picture.height;
            FilterDirection direction{};
            direction.a = a;
            direction.b = b;
            direction.column = static_cast<int>(std::round(column));
            direction.row = static_cast<int>(std::round(row));
            direction.column_cos = static_cast<float>(std::cos(column_rest));
            direction.column_sin = static_cast<float>(std::sin(column_rest));
            direction.row_cos = static_cast<float>(std::cos(row_rest));
            direction.row_sin = static_cast<float>(std::sin(row_rest));
            direction.sine = static_cast<float>(std::sin(theta));
            directions.push_back(direction);
        }
    }
    return directions;
}

void join_border(std::span<float> grid, int cells) {
    const auto copy = [&](int from_i, int from_j, int to_i, int to_j) {
        const auto vertex = [cells](int i, int j) { return 3 * (index_of(j) * index_of(cells + 1) + index_of(i)); };
        std::copy_n(grid.begin() + static_cast<std::ptrdiff_t>(vertex(from_i, from_j)), 3,
                    grid.begin() + static_cast<std::ptrdiff_t>(vertex(to_i, to_j)));
    };
    for (const int side : {0, cells}) {
        for (int t = 0; t < cells / 2; ++t) {
            copy(side, t, side, cells - t);
            copy(t, side, cells - t, side);
        }
    }
    copy(0, 0, cells, 0); // all four corners are the pole below
    copy(0, 0, 0, cells);
    copy(0, 0, cells, cells);
}

} // namespace clshade
