#include "host/shading/environment_maps.h"

#include "host/base/error.h"
#include "host/environment/filter_layout.h"
#include "host/shading/metal_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace clshade {

namespace {

/// Kernels compute record numbers in single precision.
constexpr std::size_t most_records = std::size_t{1} << 24U;

/// A buffer's memory comes in lines of 64 bytes.
std::size_t whole_lines(std::size_t floats) {
    return (floats + 15) / 16 * 16;
}

/// Value `channel` at the middle between the vertices of a grid with `cells` cells, (x, y) in halves of a cell.
float at_half(std::span<const float> vertices, int cells, int x, int y, int channel) {
    const auto vertex = [&](int i, int j) {
        return static_cast<double>(
            vertices[(static_cast<std::size_t>(j) * static_cast<std::size_t>(cells + 1) + static_cast<std::size_t>(i)) *
                         3 +
                     static_cast<std::size_t>(channel)]);
    };
    const int left = x / 2;
    const int top = y / 2;
    const int right = left + x % 2;
    const int bottom = top + y % 2;
    return static_cast<float>(0.25 *
                              (vertex(left, top) + vertex(right, top) + vertex(left, bottom) + vertex(right, bottom)));
}

/// The metal's curve in air, which its table integrates.
ReflectanceCurve curve_of(const Metal& metal) {
    const MetalCurve curve = fit_metal_curve(metal, {});
    return {curve.bend, curve.coefficients};
}

std::shared_ptr<const LatLong> shown_picture(const BoundEnvironment& environment) {
    return environment.background ? environment.image : nullptr;
}

} // namespace

void fill_colour_records(std::span<float> records, std::span<const float> vertices, int width, int height,
                         const glm::dvec3& scale) {
    const std::array<float, 3> factor = {static_cast<float>(scale.x), static_cast<float>(scale.y),
                                         static_cast<float>(scale.z)};
    const auto row = static_cast<std::size_t>(width + 1) * 3;
    float* record = records.data();
    for (int y = 0; y < height; ++y) {
        const float* upper = vertices.data() + static_cast<std::size_t>(y) * row;
        const float* lower = upper + row;
        for (int x = 0; x < width; ++x, record += colour_floats, upper += 3, lower += 3) {
            for (std::size_t c = 0; c < 3; ++c) {
                record[4 * c] = upper[c] * factor[c];
                record[4 * c + 1] = upper[c + 3] * factor[c];
                record[4 * c + 2] = lower[c] * factor[c];
                record[4 * c + 3] = lower[c + 3] * factor[c];
            }
        }
    }
}

void fill_pair_records(std::span<float> records, std::span<const float> vertices, int width, int height) {
    const auto row = static_cast<std::size_t>(width + 1) * 2;
    float* record = records.data();
    for (int y = 0; y < height; ++y) {
        const float* upper = vertices.data() + static_cast<std::size_t>(y) * row;
        const float* lower = upper + row;
        for (int x = 0; x < width; ++x, record += pair_floats, upper += 2, lower += 2) {
            for (std::size_t c = 0; c < 2; ++c) {
                record[4 * c] = upper[c];
                record[4 * c + 1] = upper[c + 2];
                record[4 * c + 2] = lower[c];
                record[4 * c + 3] = lower[c + 2];
            }
        }
    }
}

std::vector<float> blended_level(const FilteredSet& maps, double shininess) {
    const double level = level_at(shininess);
    const int sharper = std::min(static_cast<int>(level), radiance_levels - 2);
    const double part = level - sharper;
    const std::vector<float>& fine = maps.radiance[static_cast<std::size_t>(sharper)];
    const std::vector<float>& coarse = maps.radiance[static_cast<std::size_t>(sharper) + 1];
    const int cells = level_cells(sharper);
    const int coarse_cells = level_cells(sharper + 1);
    const bool same = cells == coarse_cells;
    std::vector<float> blend(fine.size());
    std::size_t at = 0;
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x) {
            for (int c = 0; c < 3; ++c, ++at) {
                const float other = same ? coarse[at] : at_half(coarse, coarse_cells, x, y, c);
                blend[at] = static_cast<float>((1.0 - part) * static_cast<double>(fine[at]) +
                                               part * static_cast<double>(other));
            }
        }
    }
    return blend;
}

void fill_curve(std::span<float> curve, const AmbientTables& tables, const AmbientCurve& wanted) {
    constexpr auto columns = static_cast<std::size_t>(ambient_cosines) + 1;
    const std::vector<float>& table = wanted.linear ? tables.linear : tables.exact;
    const double n = std::min(wanted.shininess, std::exp2(ambient_octaves) - 1.0);
    const double row = ambient_exponents * std::log2(n + 1.0) / ambient_octaves;
    const auto above = std::min(static_cast<std::size_t>(row), static_cast<std::size_t>(ambient_exponents - 1));
    const double part = row - static_cast<double>(above);
    std::array<double, columns> values{};
    for (std::size_t i = 0; i < columns; ++i) {
        const auto at = [&](std::size_t channel) {
            const std::size_t upper = 2 * (above * columns + i) + channel;
            return (1.0 - part) * static_cast<double>(table[upper]) +
                   part * static_cast<double>(table[upper + 2 * columns]);
        };
        values[i] = wanted.scale_factor * at(0) + wanted.bias_factor * at(1);
    }
    for (std::size_t i = 0; i + 1 < columns; ++i) {
        curve[i] = static_cast<float>(values[i]);
        curve[columns - 1 + i] = static_cast<float>(values[i + 1] - values[i]);
    }
}

bool EnvironmentMaps::serve(const BoundEnvironment& environment, const MapsLayout& layout) const {
    return environment.maps == set_ && shown_picture(environment) == shown_ && environment.intensity == intensity_ &&
           layout == layout_;
}

EnvironmentMaps::EnvironmentMaps(Device& device, const BoundEnvironment& environment, const MapsLayout& layout,
                                 Prefilter& prefilter)
    : set_(environment.maps), shown_(shown_picture(environment)), intensity_(environment.intensity), layout_(layout) {
    if (!set_) {
        throw std::invalid_argument("the frame's environment has not been filtered");
    }
    check_sizes(*set_);
    if (layout_.records() > most_records) {
        throw RuntimeFailure("the materials have too many different exponents for an environment; use fewer, or a "
                             "shininess channel");
    }
    fill(prefilter);
    fill_ambient(prefilter);
    fill_picture();
    const auto bind = [&device](AlignedBuffer& memory) {
        Buffer buffer(device, std::as_writable_bytes(memory.span()), Access::read);
        buffer.upload();
        return buffer;
    };
    maps_buffer_ = bind(maps_);
    ambient_buffer_ = bind(ambient_);
    picture_buffer_ = bind(picture_);
}

void EnvironmentMaps::fill(Prefilter& prefilter) {
    maps_ = AlignedBuffer(layout_.records() * colour_floats);
    const auto records = [this](std::size_t first) { return maps_.span().subspan(first * colour_floats); };
    for (int level = 0; layout_.levels() && level < radiance_levels; ++level) {
        fill_colour_records(records(level_record(level)), set_->radiance[static_cast<std::size_t>(level)],
                            level_cells(level), level_cells(level), intensity_);
    }
    fill_colour_records(records(irradiance_record()), set_->irradiance, irradiance_cells, irradiance_cells, intensity_);
    for (const BlendedLevel& level : layout_.blended()) {
        fill_colour_records(records(level.first), blended_level(*set_, level.shininess), level.cells, level.cells,
                            intensity_);
    }
    for (const MetalMap& map : layout_.metals()) {
        fill_colour_records(records(map.first), prefilter.spectral_table(curve_of(map.metal), map.linear),
                            ambient_cosines, ambient_exponents, glm::dvec3(1.0));
    }
}

void EnvironmentMaps::fill_ambient(Prefilter& prefilter) {
    const AmbientTables tables = prefilter.ambient_tables();
    ambient_ = AlignedBuffer(whole_lines(layout_.ambient_floats()));
    fill_pair_records(ambient_.span().subspan(ambient_table_float(false)), tables.exact, ambient_cosines,
                      ambient_exponents);
    fill_pair_records(ambient_.span().subspan(ambient_table_float(true)), tables.linear, ambient_cosines,
                      ambient_exponents);
    for (const AmbientCurve& curve : layout_.curves()) {
        fill_curve(ambient_.span().subspan(curve.first, curve_floats), tables, curve);
    }
}

void EnvironmentMaps::fill_picture() {
    if (!shown_) {
        picture_ = AlignedBuffer(colour_floats); // no device takes an empty buffer
        return;
    }
    const std::size_t texels = static_cast<std::size_t>(shown_->width) * static_cast<std::size_t>(shown_->height);
    picture_ = AlignedBuffer(whole_lines(4 * texels));
    for (std::size_t i = 0; i < texels; ++i) {
        std::copy_n(shown_->rgb.data() + 3 * i, 3, picture_.data() + 4 * i);
    }
}

} // namespace clshade
