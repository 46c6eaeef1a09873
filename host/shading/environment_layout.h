// Where the maps of a frame's environment lie in the buffers that kernels look them up in: levels and irradiance as
// colour records, ambient tables as pair records (kernels/lookup.cl), and what single materials need behind them. The
// generator of kernel code asks for those maps; EnvironmentMaps fills them.
#pragma once

#include "host/scene/scene.h"

#include <cstddef>
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
    Metal metal;
    bool linear = false;
    std::size_t first = 0; ///< record
};

/// scale_factor scale + bias_factor bias as a function of N.E for one exponent.
struct AmbientCurve {
    double shininess = 0.0;
    bool linear = false;
    double scale_factor = 1.0;
    double bias_factor = 0.0;
    std::size_t first = 0; ///< float
};

class MapsLayout {
  public:
    /// Every level, for exponents that vary between pixels.
    void ask_levels() { levels_ = true; }
    /// Maps for one exponent, a metal, a curve: where they lie. The same is asked for once only.
    [[nodiscard]] BlendedLevel ask_level(double shininess);
    [[nodiscard]] std::size_t ask_metal(const Metal& metal, bool linear);
    [[nodiscard]] std::size_t ask_curve(double shininess, bool linear, double scale_factor, double bias_factor);

    [[nodiscard]] bool levels() const { return levels_; }
    [[nodiscard]] const std::vector<BlendedLevel>& blended() const { return blended_; }
    [[nodiscard]] const std::vector<MetalMap>& metals() const { return metals_; }
    [[nodiscard]] const std::vector<AmbientCurve>& curves() const { return curves_; }
    /// Colour records in all.
    [[nodiscard]] std::size_t records() const { return records_; }
    /// Floats of the ambient tables and curves.
    [[nodiscard]] std::size_t ambient_floats() const;

    MapsLayout();

  private:
    bool levels_ = false;
    std::vector<BlendedLevel> blended_;
    std::vector<MetalMap> metals_;
    std::vector<AmbientCurve> curves_;
    std::size_t records_ = 0;
};

/// Do both want the same?
[[nodiscard]] bool operator==(const MapsLayout& a, const MapsLayout& b);

inline constexpr std::size_t colour_floats = 16;
inline constexpr std::size_t pair_floats = 8;
/// Of a curve: values, then slopes.
inline constexpr std::size_t curve_floats = 256;

/// mip of rule 11: log2(8192 / max(n, 1)), 0..13.
[[nodiscard]] double level_at(double shininess);

/// Record of a level's first cell.
[[nodiscard]] std::size_t level_record(int level);
/// Of the irradiance map.
[[nodiscard]] std::size_t irradiance_record();
/// First float of the ambient table with the exact normaliser or the linear one.
[[nodiscard]] std::size_t ambient_table_float(bool linear);

/// The exponent of an anisotropic lobe's lookups (rule 11: 1/v).
[[nodiscard]] double streak_shininess(double shininess_u, double shininess_v);

} // namespace clshade
