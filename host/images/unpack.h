// Rows of EXR samples to floats, and the byte shuffles of OpenEXR's RLE and ZIP. Little-endian hosts, as is the file.
#pragma once

#include "host/gbuffer/image_layout.h"

#include <cstddef>
#include <span>

namespace clshade {

[[nodiscard]] constexpr std::size_t bytes_of(SampleType type) {
    return type == SampleType::half ? 2 : 4;
}

/// The loops that take the time, for one kind of processor. All kinds give the same bits.
struct UnpackLoops {
    /// `count` halves (at any alignment) to floats. NaNs keep sign and payload and become quiet, as the processor's own
    /// conversion has it.
    void (*widen_halves)(const std::byte* halves, std::size_t count, float* out) = nullptr;
    /// The same for halves whose first bytes lie at `even` and second bytes at `odd`.
    void (*merge_halves)(const std::byte* even, const std::byte* odd, std::size_t count, float* out) = nullptr;
    /// `pairs` pairs of bytes, taken from `even` and `odd` in turn.
    void (*merge_bytes)(const std::byte* even, const std::byte* odd, std::size_t pairs, std::byte* out) = nullptr;
    /// See undo_differences.
    void (*undo_differences)(std::span<std::byte> bytes) = nullptr;
};

/// For any processor.
[[nodiscard]] const UnpackLoops& portable_loops();
/// With AVX2 and F16C; null on processors without them.
[[nodiscard]] const UnpackLoops* avx2_loops();
/// The best for this processor.
[[nodiscard]] const UnpackLoops& unpack_loops();

/// `count` samples that lie one after the other (at any alignment) to floats; unsigned integers are rounded to nearest.
void unpack_row(SampleType type, const std::byte* samples, std::size_t count, float* out);

/// The same for samples whose even bytes lie at `even` and odd bytes at `odd`.
void merge_row(SampleType type, const std::byte* even, const std::byte* odd, std::size_t count, float* out);

/// Bytes that PXR24 keeps of a sample: of a float the upper three.
[[nodiscard]] constexpr std::size_t pxr24_bytes_of(SampleType type) {
    return type == SampleType::half ? 2 : (type == SampleType::float32 ? 3 : 4);
}

/// A row as PXR24 packs it before it deflates: differences of samples to their left neighbours (modulo 2^32), first all
/// their highest bytes, then the next lower ones.
void undo_pxr24_row(SampleType type, const std::byte* bytes, std::size_t count, float* out);

/// Each byte but the first was stored as its difference to the one before, plus 128 (modulo 256).
void undo_differences(std::span<std::byte> bytes);

/// OpenEXR's run lengths: a count byte c >= 0 repeats the next byte c + 1 times, c < 0 takes the next -c bytes as they
/// are. False unless `packed` fills `out` exactly.
[[nodiscard]] bool undo_runs(std::span<const std::byte> packed, std::span<std::byte> out);

} // namespace clshade
