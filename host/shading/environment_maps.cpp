#include "host/shading/environment_maps.h"

#include "host/base/error.h"
#include "host/environment/filter_layout.h"
#include "host/shading/metal_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace clshade {

namespace {

constexpr std::size_t colour_floats = 16;
constexpr std::size_t pair_floats = 8;
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

bool same_metal(const Metal& a, const Metal& b) {
    return std::equal(a.samples.begin(), a.samples.end(), b.samples.begin(), b.samples.end(),
                      [](const ComplexIndex& x, const ComplexIndex& y) {
                          return x.wavelength == y.wavelength && x.n == y.n && x.k == y.k;
                      });
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

EnvironmentMaps::Origin EnvironmentMaps::origin_of(const Frame& frame, const MapsLayout& layout) {
    const BoundEnvironment& environment = *frame.environment;
    Origin origin;
    origin.maps = environment.maps;
    origin.picture = environment.background ? environment.image : nullptr;
    origin.intensity = environment.intensity;
    for (const BlendedLevel& level : layout.blended) {
        origin.exponents.push_back(level.shininess);
    }
    for (const MetalMap& map : layout.metals) {
        origin.metals.push_back(frame.materials[map.material].layers[map.layer].metal);
        origin.linear.push_back(map.linear);
    }
    origin.levels = layout.levels;
    return origin;
}

bool EnvironmentMaps::serve(const Frame& frame) const {
    const Origin wanted = origin_of(frame, maps_layout(frame));
    return wanted.maps == origin_.maps && wanted.picture == origin_.picture && wanted.intensity == origin_.intensity &&
           wanted.exponents == origin_.exponents && wanted.linear == origin_.linear &&
           wanted.levels == origin_.levels &&
           std::equal(wanted.metals.begin(), wanted.metals.end(), origin_.metals.begin(), origin_.metals.end(),
                      same_metal);
}

EnvironmentMaps::EnvironmentMaps(Device& device, const Frame& frame, Prefilter& prefilter) {
    if (!frame.environment->maps) {
        throw std::invalid_argument("the frame's environment has not been filtered");
    }
    const MapsLayout layout = maps_layout(frame);
    if (layout.records > most_records) {
        throw RuntimeFailure(fmt::format("{}: the materials have too many different exponents for an environment; use "
                                         "fewer, or a shininess channel",
                                         frame.file));
    }
    origin_ = origin_of(frame, layout);
    maps_ = AlignedBuffer(layout.records * colour_floats);
    fill(frame, layout, prefilter);
    fill_ambient(prefilter);
    if (origin_.picture) {
        fill_picture(*origin_.picture);
    } else {
        picture_ = AlignedBuffer(colour_floats); // no device takes an empty buffer
    }
    const auto bind = [&device](AlignedBuffer& memory) {
        Buffer buffer(device, std::as_writable_bytes(memory.span()), Access::read);
        buffer.upload();
        return buffer;
    };
    maps_buffer_ = bind(maps_);
    ambient_buffer_ = bind(ambient_);
    picture_buffer_ = bind(picture_);
}

void EnvironmentMaps::fill(const Frame& frame, const MapsLayout& layout, Prefilter& prefilter) {
    const FilteredSet& maps = *origin_.maps;
    check_sizes(maps);
    const auto records = [this](std::size_t first) { return maps_.span().subspan(first * colour_floats); };
    for (int level = 0; layout.levels && level < radiance_levels; ++level) {
        fill_colour_records(records(level_record(level)), maps.radiance[static_cast<std::size_t>(level)],
                            level_cells(level), level_cells(level), origin_.intensity);
    }
    fill_colour_records(records(irradiance_record()), maps.irradiance, irradiance_cells, irradiance_cells,
                        origin_.intensity);
    for (const BlendedLevel& level : layout.blended) {
        fill_colour_records(records(level.first), blended_level(maps, level.shininess), level.cells, level.cells,
                            origin_.intensity);
    }
    for (const MetalMap& map : layout.metals) {
        const Metal& metal = frame.materials[map.material].layers[map.layer].metal;
        fill_colour_records(records(map.first), prefilter.spectral_table(curve_of(metal), map.linear), ambient_cosines,
                            ambient_exponents, glm::dvec3(1.0));
    }
}

void EnvironmentMaps::fill_ambient(Prefilter& prefilter) {
    const AmbientTables tables = prefilter.ambient_tables();
    const std::size_t table = static_cast<std::size_t>(ambient_cosines) * ambient_exponents * pair_floats;
    ambient_ = AlignedBuffer(2 * table);
    fill_pair_records(ambient_.span(), tables.exact, ambient_cosines, ambient_exponents);
    fill_pair_records(ambient_.span().subspan(table), tables.linear, ambient_cosines, ambient_exponents);
}

void EnvironmentMaps::fill_picture(const LatLong& picture) {
    const std::size_t texels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    picture_ = AlignedBuffer(whole_lines(4 * texels));
    for (std::size_t i = 0; i < texels; ++i) {
        std::copy_n(picture.rgb.data() + 3 * i, 3, picture_.data() + 4 * i);
    }
}

} // namespace clshade
