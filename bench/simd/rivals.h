// The C++ rivals, compiled once per instruction set. This header and the files that implement it include nothing with
// inline functions of the standard library: a copy of one compiled for AVX-512 must not end up in the rest of the
// program.
#pragma once

#include <stddef.h> // NOLINT(modernize-deprecated-headers,hicpp-deprecated-headers): see above

namespace clshade::rivals {

/// Planes of the bench frame. Plane p of the input begins at in + p * in_stride; all are padded to 16 floats and lie on
/// 64-byte boundaries. Order: normal 0-2, position 3-5, albedo 6-8, f0 9-11, shininess 12.
/// Outputs: R, G, B and, if planes_out is 4, alpha.
struct Planes {
    const float* in = nullptr;
    size_t in_stride = 0;
    int planes_in = 0;
    float* out = nullptr;
    size_t out_stride = 0;
    int planes_out = 0;
};

/// A distant light: unit vector to the light, irradiance.
struct DistantLight {
    float to_light[3];
    float irradiance[3];
};

struct Scene {
    float eye[3] = {0.0F, 0.0F, 0.0F};
    const DistantLight* lights = nullptr;
    int light_count = 0;
};

/// Shades pixels [begin, end), both multiples of 16 (with padding).
using ShadeRange = void (*)(const Planes& planes, const Scene& scene, size_t begin, size_t end);
/// Moves the same bytes: every output plane k gets (k + 1) times the sum of the input planes.
using StreamRange = void (*)(const Planes& planes, size_t begin, size_t end);

/// A lat-long picture to filter (host/environment/filter_layout.h): three planes of height x width texels, and the
/// angles of its rows (polar) and columns (azimuth).
struct SkySource {
    int width;
    int height;
    const float* red;
    const float* green;
    const float* blue;
    const float* row_sine;
    const float* row_cosine;
    const float* row_area; ///< solid angle of a texel [sr]
    const float* column_sine;
    const float* column_cosine;
};

struct SkyLobe {
    float half_exponent; ///< n/2
    float reach;         ///< (1 - R.w)/2 beyond which texels are left out; 1: none
    bool cosine;         ///< the lobe is max(0, R.w) instead
    int cells;           ///< of the octahedral grid
};

/// Filters for the vertices [begin, end) of the grid; `out` is RGB interleaved.
using FilterRange = void (*)(const SkySource& source, const SkyLobe& lobe, float* out, size_t begin, size_t end);

/// Pixels with all their channels next to each other, as image libraries hand them out. Which channel is which, in this
/// order: normal, position, albedo, f0 (three each), GGX roughness, coverage.
inline constexpr size_t interleaved_channels = 14;
struct Interleaved {
    size_t channels; ///< of a pixel
    size_t offset[interleaved_channels];
};
/// Shades `count` pixels under the scene's first light; `out` is RGBA interleaved.
using InterleavedRange = void (*)(const float* pixels, const Interleaved& layout, const Scene& scene, float* out,
                                  size_t count);

} // namespace clshade::rivals
