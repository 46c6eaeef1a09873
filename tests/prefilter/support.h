// Pictures, a device, and the sums of filter_layout.h once more in double, texel by texel.
#pragma once

#include "host/device/device.h"
#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"
#include "host/prefilter/prefilter.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace clshade::tests {

/// The CPU device, opened once.
Device& cpu_device();

/// With this run's own cache on disk (environment.cpp), so that programs are built once.
Prefilter prefilter_of(int lanes = 0);
inline constexpr int all_lanes[] = {1, 4, 8, 16};

/// A picture whose texel (x, y) has the radiance value(x, y).
LatLong picture(int height, const std::function<glm::dvec3(int, int)>& value);
/// Radiance 0 to 2, anew in every texel.
LatLong random_picture(int height, std::uint32_t seed);
LatLong black_picture(int height);
void set_texel(LatLong& image, int x, int y, const glm::dvec3& value);
/// The columns moved: texel x of the result is texel x - columns of the image.
LatLong turned(const LatLong& image, int columns);

/// Unit direction of a texel's middle, in the image frame.
glm::dvec3 texel_direction(int width, int height, double x, double y);
/// Unit direction of a vertex.
glm::dvec3 vertex_direction(int cells, int i, int j);
glm::dvec3 vertex_value(const std::vector<float>& grid, int cells, int i, int j);

/// Sum of L lobe(R.w) dw over the sum of lobe(R.w) dw, over all texels of `source`.
glm::dvec3 filtered(const LatLong& source, const glm::dvec3& direction, const std::function<double(double)>& lobe);
/// ((1 + c)/2)^(n/2).
std::function<double(double)> power_lobe(double shininess);
double cosine_lobe(double c);

/// |a - b| relative to the larger |b| of the three channels.
double relative_difference(const glm::dvec3& a, const glm::dvec3& b);

} // namespace clshade::tests
