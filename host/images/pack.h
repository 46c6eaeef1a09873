// Floats to the samples of output files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace clshade {

/// Rounds to the nearest half (ties to even). Finite values that half cannot hold become +-65504 instead of Inf; their
/// number is returned. Inf and NaN stay what they are. out has the size of values.
std::size_t pack_halves(std::span<const float> values, std::uint16_t* out);

/// sRGB's transfer function (IEC 61966-2-1) to 8 bits, rounded; clamped to 0..1; NaN gives 0.
[[nodiscard]] std::uint8_t srgb_byte(float linear);
/// 0..1 to 8 bits, rounded; clamped; NaN gives 0.
[[nodiscard]] std::uint8_t unit_byte(float value);

} // namespace clshade
