#include "host/shading/environment_layout.h"

#include "host/environment/filter_layout.h"

#include <algorithm>
#include <cmath>

namespace clshade {

namespace {

constexpr double largest_shininess = 65536.0;

std::size_t cells_of(int side) {
    return static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
}

/// The value that a constant parameter has in every pixel (rule 6), none if it varies.
std::optional<double> constant_shininess(const BoundParameter& parameter) {
    if (!parameter.is_constant()) {
        return std::nullopt;
    }
    return std::clamp(parameter.constant.x, 0.0, largest_shininess);
}

/// The exponent at which a layer looks into the levels; none if it varies.
std::optional<double> looked_up_at(const BoundLayer& layer) {
    if (layer.specular != SpecularModel::blinn_phong_anisotropic) {
        return constant_shininess(layer.shininess);
    }
    const auto u = constant_shininess(layer.shininess_u);
    const auto v = constant_shininess(layer.shininess_v);
    if (!u || !v) {
        return std::nullopt;
    }
    return streak_shininess(*u, *v);
}

} // namespace

const BlendedLevel* MapsLayout::level_of(double shininess) const {
    const auto found = std::find_if(blended.begin(), blended.end(),
                                    [shininess](const BlendedLevel& level) { return level.shininess == shininess; });
    return found == blended.end() ? nullptr : &*found;
}

const MetalMap* MapsLayout::metal_of(std::size_t material, std::size_t layer) const {
    const auto found = std::find_if(metals.begin(), metals.end(), [material, layer](const MetalMap& map) {
        return map.material == material && map.layer == layer;
    });
    return found == metals.end() ? nullptr : &*found;
}

double level_at(double shininess) {
    return std::clamp(std::log2(sharpest_shininess / std::max(shininess, 1.0)), 0.0,
                      static_cast<double>(radiance_levels - 1));
}

std::size_t level_record(int level) {
    std::size_t record = 0;
    for (int above = 0; above < level; ++above) {
        record += cells_of(level_cells(above));
    }
    return record;
}

std::size_t irradiance_record() {
    return level_record(radiance_levels);
}

double streak_shininess(double shininess_u, double shininess_v) {
    const double wide = 1.0 / std::max(std::min(shininess_u, shininess_v), 1.0);
    const double narrow = 1.0 / std::max(std::max(shininess_u, shininess_v), 1.0);
    return 1.0 / std::max(narrow, wide / 8.0);
}

MapsLayout maps_layout(const Frame& frame) {
    MapsLayout layout;
    if (!frame.environment) {
        return layout;
    }
    layout.records = irradiance_record() + cells_of(irradiance_cells);
    for (std::size_t i = 0; i < frame.materials.size(); ++i) {
        const BoundMaterial& material = frame.materials[i];
        for (std::size_t k = 0; k < material.layers.size(); ++k) {
            const BoundLayer& layer = material.layers[k];
            if (layer.specular == SpecularModel::none) {
                continue;
            }
            if (layer.specular == SpecularModel::blinn_phong_spectral) {
                layout.metals.push_back({i, k, material.fresnel == FresnelModel::constant, layout.records});
                layout.records +=
                    static_cast<std::size_t>(ambient_cosines) * static_cast<std::size_t>(ambient_exponents);
            }
            const std::optional<double> shininess = looked_up_at(layer);
            if (!shininess) {
                layout.levels = true;
            } else if (layout.level_of(*shininess) == nullptr) {
                const int cells = level_cells(static_cast<int>(level_at(*shininess)));
                layout.blended.push_back({*shininess, layout.records, cells});
                layout.records += cells_of(cells);
            }
        }
    }
    return layout;
}

} // namespace clshade
