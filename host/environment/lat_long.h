// An environment as a lat-long picture in memory: where its texels lie on the sphere, cleaning, halving, doubling, the
// built-in studio. No files.
//
// IMAGE FRAME. Directions in the picture's own frame are right-handed with z towards row 0. A texel's centre (x + 0.5,
// y + 0.5) lies at u = (x + 0.5)/width, v = (y + 0.5)/height with u = 0.5 - atan2(d.y, d.x)/(2 pi), v = acos(d.z)/pi
// (conventions.md section 4). How the picture stands in the world (its up axis and rotation) is the matrix
// BoundEnvironment::world_to_image; nothing here knows it.
#pragma once

#include "host/scene/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace clshade {

/// Linear Rec.709 radiance. `rgb` holds 3 floats a texel, row by row. width = 2 height, both at least 1; every value
/// finite and 0 or more once it has been cleaned.
struct LatLong {
    std::string name; ///< of the file, or "studio": for messages
    int width = 0;
    int height = 0;
    std::vector<float> rgb;
    std::optional<UpAxis> up;    ///< what the file says of itself (attribute `envmap` or `oiio:updirection`)
    int halvings = 0;            ///< times the file's picture was halved while it was read, to fit the memory
    std::uint64_t negative = 0;  ///< texels with a negative channel, set to 0 there
    std::uint64_t nonfinite = 0; ///< texels with NaN or Inf, which became black
};

/// Sets texels with NaN or Inf to black and negative channels to 0, and counts both (added to what was counted before).
void clean(LatLong& image);

/// Solid angle of each texel of row y (all of a row are alike) [sr]: 2 pi/width (cos(pi y/height) - cos(pi
/// (y+1)/height)).
[[nodiscard]] double texel_solid_angle(int width, int height, int y);

/// Half as wide and high: each texel the mean of four, weighted by their solid angles, so that the energy stays. Both
/// sides must be even (std::invalid_argument).
[[nodiscard]] LatLong halved(const LatLong& image);

/// What `halved` does, row by row, for those who do not have the whole picture: the share of the upper of rows 2 y and
/// 2 y + 1 of a picture of that size, and the row of half the length that both make.
[[nodiscard]] double upper_share(int width, int height, int y);
void halve_rows(std::span<const float> upper, std::span<const float> lower, double share, std::span<float> out);

/// Twice as wide and high, bilinearly between texel centres: filter_layout.h, SOURCE. The width must be even
/// (std::invalid_argument).
[[nodiscard]] LatLong doubled(const LatLong& image);

/// Rows of the picture that a lobe of exponent `shininess` is filtered from (filter_layout.h, SOURCE), given the size
/// of the environment; and that picture. A sharper lobe's source can be halved on to a softer lobe's. Throws
/// std::invalid_argument without texels.
[[nodiscard]] int source_height(int width, int height, double shininess);
[[nodiscard]] LatLong filter_source(const LatLong& image, double shininess);

/// The environment of scenes that name none: a studio by formula, `height` rows (at least 8), up axis y, camera looking
/// along -z: large warm key soft box over the left shoulder, cool fill from the right, a strip light behind, dark
/// floor, soft grey surroundings. Mean radiance near 0.5, peaks near 20. Its `up` is y.
[[nodiscard]] LatLong built_in_studio(int height = 256);

/// Hash of size and texels, 32 hex digits.
[[nodiscard]] std::string content_hash(const LatLong& image);

} // namespace clshade
