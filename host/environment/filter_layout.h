// What a pre-filtered environment consists of: levels, sizes, places of samples. The contract between the pre-filter on
// the device, the reference's own, and the shading kernels. Rules only; nobody's arithmetic.
//
// LEVELS (models.md section 6; n falls by two a level, since with its factor of four values between levels err by
// 12-14 %). Level i = 0..13 holds the radiance filtered with the lobe
//   p_n(c) = (n+2)/(8 pi) ((1+c)/2)^(n/2),  n = 8192 / 2^i,  c = R.w,
// for directions R on a grid of (cells+1)^2 vertices, cells = max(384 >> (i/2), 48): 1.6 or more grid steps in
// the lobe's deviation 2/sqrt(n), and enough to keep the energy of a sun within 0.5 % at the widest levels.
//
// GRID. Vertex (i, j) of a level with `cells` cells a side, i, j = 0..cells, stands at index j (cells+1) + i and is the
// octahedral direction of x = 2 i/cells - 1, y = 2 j/cells - 1: z = 1 - |x| - |y|; where z < 0, (x, y) becomes
// ((1 - |y|) sgn x, (1 - |x|) sgn y) with sgn 0 = 1; then normalised, in the image frame of lat_long.h. Vertices on the
// border are shared by the two sides that fold there, so bilinear interpolation has no seam anywhere.
//
// SOURCE of level i: the picture, halved (lat_long.h) as long as both sides stay even before it and the texel's height
// pi/height after it is at most a fifth of the lobe's deviation 2/sqrt(n). A picture of fewer than 128 rows is first
// doubled until it has 128 or more: each texel becomes four, bilinearly between texel centres (u wraps; beyond a pole
// the row nearest to it stands opposite, half a turn on).
// FILTER: the sum over the source's texels of L p_n(R.w) dw divided by the sum of p_n(R.w) dw, w the texel's centre and
// dw its solid angle. Texels with n theta^2/8 > 21 (theta: angle to R) may be left out: 1e-9 of the lobe.
//
// IRRADIANCE map: E/pi with the kernel max(0, N.w)/pi in place of p_n, on a grid of 48 cells, from a source halved as
// for n = 128 (as above).
// SH: L_lm = sum of L Y_lm dw over the picture itself, order and signs of models.md section 6 (no Condon-Shortley
// sign), l = 0..2, radiance (not E/pi), in the image frame.
//
// AMBIENT BRDF tables (models.md section 6): scale and bias for the exact and for the linear normaliser at vertices
// (i, j): N.E = max(i/128, 1e-4), i = 0..128; n = 2^(13 j/64) - 1, j = 0..64; index j 129 + i.
#pragma once

#include <algorithm>

namespace clshade {

inline constexpr int radiance_levels = 14;
inline constexpr double sharpest_shininess = 8192.0; ///< of level 0
inline constexpr int irradiance_cells = 48;
inline constexpr double irradiance_source_shininess = 128.0;
inline constexpr int smallest_source_height = 128;
inline constexpr double texels_per_deviation = 5.0;
inline constexpr int ambient_cosines = 128;  ///< cells along N.E
inline constexpr int ambient_exponents = 64; ///< cells along log2(n+1)/13
inline constexpr double ambient_octaves = 13.0;

[[nodiscard]] constexpr double level_shininess(int level) {
    return sharpest_shininess / static_cast<double>(1 << level);
}

[[nodiscard]] constexpr int level_cells(int level) {
    return std::max(384 >> (level / 2), 48);
}

} // namespace clshade
