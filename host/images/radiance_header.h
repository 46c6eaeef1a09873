// Private to host/images: what the header of a Radiance .hdr must not say.
#pragma once

#include <string>

namespace clshade {

/// The new run-length encoding packs 127 bytes of a component into two: 127 pixels into 8 bytes.
inline constexpr double most_radiance_pixels_per_byte = 127.0 / 8.0;
/// Of other formats: Deflate reaches 1032 (zlib's documentation), and a pixel has at least two bytes.
inline constexpr double most_pixels_per_byte = 516.0;

/// Throws RuntimeFailure for colours in XYZ, which would be taken for RGB. GAMMA, PRIMARIES and EXPOSURE are left alone
/// (conventions.md section 4).
void check_radiance_header(const std::string& file);

} // namespace clshade
