// Device against reference, pixel by pixel. Pure functions; printing is the caller's.
#pragma once

#include "host/base/plane_slab.h"
#include "host/reference/reference.h"
#include "host/reference/rounding.h"
#include "host/reference/tolerance.h"

#include <cstdint>
#include <span>

namespace clshade::reference {

/// Errors over the selected pixels. a is the device's value, b the reference's.
///
/// Relative errors |a - b| / |b| and ULPs count only where |b| > max(abs, 1e-3 I) (I: the pixel's light level; the 1e-3
/// is that of models.md section 14); in darker channels only absolute errors say anything. Percentiles are over
/// pixels, of the largest relative error of a pixel's channels (0 where all are dark); rms_rel and rms_abs are over
/// channels. A NaN or Inf from the device counts as an infinite error.
struct Comparison {
    std::uint64_t pixels = 0;
    double max_rel = 0.0;
    double rms_rel = 0.0;
    double max_abs = 0.0;
    double rms_abs = 0.0;
    double p50_rel = 0.0;
    double p99_rel = 0.0;
    double p999_rel = 0.0;         ///< 99.9 %
    double p9999_rel = 0.0;        ///< 99.99 %
    double max_ulp = 0.0;          ///< distance of a from b rounded to float, in floats
    std::uint64_t outside = 0;     ///< pixels beyond tolerance
    std::uint64_t beyond_hard = 0; ///< pixels beyond the hard limit
    struct Worst {
        int x = -1;
        int y = -1;
        int channel = 0; ///< counted from the first plane compared
        double device = 0.0;
        double reference = 0.0;
        double share = -1.0; ///< |a - b| over what the tolerance allows
    } worst;                 ///< the channel with the largest share; x < 0 if no pixel was selected
};

/// Compares planes first_plane to first_plane + channels - 1 (at most 3). `selected`: one byte per pixel, row by row,
/// non-zero where the pixel counts; empty: all. `scale` may be empty if the tolerance does not need it.
[[nodiscard]] Comparison compare(const PlaneSlab& device, const Image& reference, const RoundingScale& scale,
                                 const Tolerance& tolerance, std::span<const std::uint8_t> selected = {},
                                 int first_plane = 0, int channels = 3);

/// The verdict. A comparison of no pixel does not pass: it proves nothing.
[[nodiscard]] bool passes(const Comparison& comparison, const Tolerance& tolerance);

/// Number of floats from a to b, 0 if equal; infinity if either is not finite.
[[nodiscard]] double ulp_distance(float a, float b);

} // namespace clshade::reference
