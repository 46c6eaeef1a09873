#include "host/images/unpack.h"

#include <bit>
#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace clshade {

static_assert(std::endian::native == std::endian::little, "samples are used as they lie in the file");

namespace {

/// IEEE half to float without a branch, so that the compiler vectorises the loop: shift exponent and mantissa into
/// place and rescale by 2^(127-15), which also normalises denormals; Inf and NaN get their exponent back.
float half_to_float(std::uint16_t half) {
    constexpr std::uint32_t infinity_half = 0x7c00U << 13;
    const std::uint32_t magnitude = (half & 0x7fffU) << 13;
    const float scaled = std::bit_cast<float>(magnitude) * 0x1p112F;
    const std::uint32_t finite = std::bit_cast<std::uint32_t>(scaled);
    const std::uint32_t special = magnitude | 0x7f800000U;
    const std::uint32_t bits = magnitude >= infinity_half ? special : finite;
    const std::uint32_t sign = (half & 0x8000U) << 16;
    return std::bit_cast<float>(bits | sign);
}

template <typename Sample>
Sample load(const std::byte* at) {
    Sample sample;
    std::memcpy(&sample, at, sizeof(sample));
    return sample;
}

} // namespace

void unpack_row(SampleType type, const std::byte* samples, std::size_t count, float* out) {
    switch (type) {
    case SampleType::half:
        for (std::size_t i = 0; i < count; ++i) {
            out[i] = half_to_float(load<std::uint16_t>(samples + 2 * i));
        }
        break;
    case SampleType::uint32:
        for (std::size_t i = 0; i < count; ++i) {
            out[i] = static_cast<float>(load<std::uint32_t>(samples + 4 * i));
        }
        break;
    case SampleType::float32:
        std::memcpy(out, samples, 4 * count);
        break;
    }
}

void merge_row(SampleType type, const std::byte* even, const std::byte* odd, std::size_t count, float* out,
               std::vector<std::byte>& scratch) {
    const std::size_t pairs = count * bytes_of(type) / 2;
    std::byte* merged = reinterpret_cast<std::byte*>(out);
    if (type != SampleType::float32) {
        scratch.resize(2 * pairs);
        merged = scratch.data();
    }
    for (std::size_t i = 0; i < pairs; ++i) {
        merged[2 * i] = even[i];
        merged[2 * i + 1] = odd[i];
    }
    if (type != SampleType::float32) {
        unpack_row(type, merged, count, out);
    }
}

void undo_differences(std::span<std::byte> bytes) {
    std::size_t i = 0;
    std::uint8_t last = 128; // makes the first byte stand for itself
#ifdef __SSE2__
    // A running sum of 16 bytes in four shifted additions.
    const __m128i bias = _mm_set1_epi8(-128);
    for (; i + 16 <= bytes.size(); i += 16) {
        auto* at = reinterpret_cast<__m128i*>(bytes.data() + i);
        __m128i sum = _mm_add_epi8(_mm_loadu_si128(at), bias);
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 1));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
        sum = _mm_add_epi8(sum, _mm_set1_epi8(static_cast<char>(last)));
        _mm_storeu_si128(at, sum);
        last = std::to_integer<std::uint8_t>(bytes[i + 15]);
    }
#endif
    for (; i < bytes.size(); ++i) {
        last = static_cast<std::uint8_t>(last + std::to_integer<std::uint8_t>(bytes[i]) - 128U);
        bytes[i] = std::byte{last};
    }
}

bool undo_runs(std::span<const std::byte> packed, std::span<std::byte> out) {
    while (!packed.empty()) {
        const int code = std::to_integer<int>(packed[0]); // 0..255
        const int count = code < 128 ? code : code - 256;
        const bool repeat = count >= 0;
        const auto length = static_cast<std::size_t>(repeat ? count + 1 : -count);
        const std::size_t taken = 1 + (repeat ? 1 : length);
        if (packed.size() < taken || out.size() < length) {
            return false;
        }
        if (repeat) {
            std::memset(out.data(), std::to_integer<int>(packed[1]), length);
        } else {
            std::memcpy(out.data(), packed.data() + 1, length);
        }
        packed = packed.subspan(taken);
        out = out.subspan(length);
    }
    return out.empty();
}

} // namespace clshade
