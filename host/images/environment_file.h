// Environments in and out: lat-long pictures, and folders of pre-filtered maps.
#pragma once

#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"

#include <cstdint>
#include <filesystem>

namespace clshade {

/// Reads a lat-long picture (.hdr, .exr; R, G, B or Y), cleaned. `max_memory` (bytes, 0: no limit): a picture that
/// would take more is halved while it is read, as often as needed, never below 1024 rows; with `whole` it is refused
/// instead. Throws RuntimeFailure naming the file: missing, not an image, not twice as wide as high, a cube map
/// (attribute `envmap`; with the command that converts it), no finite texel, cut short, too large.
[[nodiscard]] LatLong read_lat_long(const std::filesystem::path& file, std::uint64_t max_memory, bool whole);

/// Does this path lead to a folder that write_filtered_set made?
[[nodiscard]] bool is_filtered_set(const std::filesystem::path& path);

/// Writes the folder `set`: radiance_n8192.exr to radiance_n0001.exr, irradiance.exr, sh.exr (9 x 1), ambient_brdf.exr
/// (channels exact.scale, exact.bias, linear.scale, linear.bias), all float; attributes in each say layout, scaling
/// (radiance, or E/pi), sign of the SH, axes, the environment's name and hash. An existing set is replaced, another
/// folder with something in it is refused. Never half-written: a set is complete or is_filtered_set says no. Throws
/// RuntimeFailure.
void write_filtered_set(const std::filesystem::path& set, const FilteredSet& maps, const AmbientTables& ambient);

/// Reads what write_filtered_set wrote. Throws RuntimeFailure naming the file at fault.
[[nodiscard]] FilteredSet read_filtered_set(const std::filesystem::path& set);

} // namespace clshade
