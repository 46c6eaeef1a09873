// Floats to the samples of output files, and the byte shuffles of OpenEXR's RLE and ZIP (unpack.h has the way back).
// Little-endian hosts, as is the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace clshade {

/// Rounds to the nearest half (ties to even). Finite values that half cannot hold become +-65504 instead of Inf; their
/// number is returned. Inf stays what it is, NaN keeps its sign and upper bits and becomes a quiet one, as x86's own
/// conversion does. out has the size of values. Uses that conversion where there is one; the bits are the same.
std::size_t pack_halves(std::span<const float> values, std::uint16_t* out);
/// The same without it.
std::size_t pack_halves_portable(std::span<const float> values, std::uint16_t* out);

/// Low bytes to `even`, high bytes to `odd`, one of each for every pair.
void split_bytes(std::span<const std::uint16_t> pairs, std::byte* even, std::byte* odd);

/// Each byte but the first as its difference to the one before, plus 128 (modulo 256). `out` is other memory.
void make_differences(std::span<const std::byte> bytes, std::byte* out);

/// sRGB's transfer function (IEC 61966-2-1) to 8 bits, rounded; clamped to 0..1; NaN gives 0.
[[nodiscard]] std::uint8_t srgb_byte(float linear);
/// 0..1 to 8 bits, rounded; clamped; NaN gives 0.
[[nodiscard]] std::uint8_t unit_byte(float value);

} // namespace clshade
