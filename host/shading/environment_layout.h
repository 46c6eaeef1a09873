// Where a frame's maps lie in the buffers that kernels look them up in, as colour records and pair records (see
// kernels/lookup.cl): the levels of the environment, its irradiance, and the maps that single materials need.
#pragma once

#include "host/gbuffer/frame.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace clshade {

/// A map for one exponent: two levels interpolated beforehand, which halves the work of pixels whose exponent is the
/// same everywhere.
struct BlendedLevel {
    double shininess = 0.0;
    std::size_t first = 0; ///< record
    int cells = 0;
};

/// A metal's own ambient table.
struct MetalMap {
    std::size_t material = 0;
    std::size_t layer = 0;
    bool linear = false;
    std::size_t first = 0; ///< record
};

struct MapsLayout {
    bool levels = false; ///< some exponent varies between pixels: all levels are needed
    std::vector<BlendedLevel> blended;
    std::vector<MetalMap> metals;
    std::size_t records = 0; ///< in all

    /// Null if there is none of this exponent.
    [[nodiscard]] const BlendedLevel* level_of(double shininess) const;
    [[nodiscard]] const MetalMap* metal_of(std::size_t material, std::size_t layer) const;
};

/// What the frame's materials need. Without an environment: nothing.
[[nodiscard]] MapsLayout maps_layout(const Frame& frame);

/// mip of rule 11: log2(8192 / max(n, 1)), 0..13.
[[nodiscard]] double level_at(double shininess);

/// Record of a level's first cell.
[[nodiscard]] std::size_t level_record(int level);
/// Of the irradiance map.
[[nodiscard]] std::size_t irradiance_record();

/// The exponent of an anisotropic lobe's lookups (rule 11: 1/v).
[[nodiscard]] double streak_shininess(double shininess_u, double shininess_v);

} // namespace clshade
