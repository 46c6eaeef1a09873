// Rows of EXR samples to floats, and the byte shuffles of OpenEXR's RLE and ZIP. Little-endian hosts, as is the file.
#pragma once

#include "host/gbuffer/image_layout.h"

#include <cstddef>
#include <span>
#include <vector>

namespace clshade {

[[nodiscard]] constexpr std::size_t bytes_of(SampleType type) {
    return type == SampleType::half ? 2 : 4;
}

/// `count` samples that lie one after the other (at any alignment) to floats; unsigned integers are rounded to nearest.
void unpack_row(SampleType type, const std::byte* samples, std::size_t count, float* out);

/// The same for samples whose even bytes lie at `even` and odd bytes at `odd`. `scratch` grows to a row.
void merge_row(SampleType type, const std::byte* even, const std::byte* odd, std::size_t count, float* out,
               std::vector<std::byte>& scratch);

/// Each byte but the first was stored as its difference to the one before, plus 128 (modulo 256).
void undo_differences(std::span<std::byte> bytes);

/// OpenEXR's run lengths: a count byte c >= 0 repeats the next byte c + 1 times, c < 0 takes the next -c bytes as they
/// are. False unless `packed` fills `out` exactly.
[[nodiscard]] bool undo_runs(std::span<const std::byte> packed, std::span<std::byte> out);

} // namespace clshade
