// What the filtering kernels read, worked out in double: directions, half-angles, rows and texels. No device.
#pragma once

#include "host/environment/lat_long.h"
#include "kernels/filter_types.h"

#include <span>
#include <vector>

namespace clshade {

/// A source picture as kernels read it.
struct FilterPicture {
    int width = 0;
    int height = 0;
    int pitch = 0;
    std::vector<float> texels;      ///< three planes of height x pitch
    std::vector<float> rows;        ///< sines of the rows' polar angles; then their texels' solid angles [sr]
    std::vector<float> half_angles; ///< sines of pi k/width, then cosines, k = -middle, ...
    int middle = 0;
};

[[nodiscard]] FilterPicture filter_picture(const LatLong& source);

/// The lobe of exponent `shininess` on a grid of `cells` cells over that picture; 0: the cosine.
[[nodiscard]] FilterSource filter_source_constants(const FilterPicture& picture, double shininess, int cells);

/// The grid's vertices with x, y, z >= 0: by the kernel's symmetries they stand for all. `cells` is even.
[[nodiscard]] std::vector<FilterDirection> filter_directions(const FilterPicture& picture, int cells);

/// Vertices on the border that the octahedron's folding makes one direction get one value, so that there is no seam of
/// rounding errors. RGB interleaved, (cells+1)^2 vertices.
void join_border(std::span<float> grid, int cells);

} // namespace clshade
