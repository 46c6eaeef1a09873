#include "host/images/pack.h"

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

#include <algorithm>
#include <bit>
#include <cmath>

namespace clshade {

namespace {

constexpr float largest_half = 65504.0F;
/// From here on (half a step above the largest) rounding to nearest would give Inf.
constexpr float overflow = 65520.0F;
constexpr std::uint32_t float_infinity = 0x7f800000U;

/// Both ways to round are computed and one is chosen, so that the compiler can vectorise the loop.
std::uint16_t round_to_half(float value) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = (bits >> 16) & 0x8000U;
    const std::uint32_t magnitude = bits & 0x7fffffffU;
    // Below the smallest normal half: adding 0.5 leaves the mantissa at half's denormal step, rounded by the addition.
    const float aligned = std::bit_cast<float>(magnitude) + 0.5F;
    const std::uint32_t denormal = std::bit_cast<std::uint32_t>(aligned) - 0x3f000000U;
    // Else: rebias the exponent by 127 - 15 and round 13 bits off, ties to even.
    const std::uint32_t odd = (magnitude >> 13) & 1U;
    const std::uint32_t normal = (magnitude - (112U << 23) + 0xfffU + odd) >> 13;
    const std::uint32_t special = 0x7c00U | (magnitude > float_infinity ? 0x200U | ((magnitude >> 13) & 0x3ffU) : 0U);
    std::uint32_t half = magnitude < (113U << 23) ? denormal : normal;
    half = magnitude >= float_infinity ? special : half;
    return static_cast<std::uint16_t>(half | sign);
}

#if defined(__x86_64__)
/// AVX2 and F16C.
bool has_conversion() {
    unsigned eax = 0;
    unsigned ebx = 0;
    unsigned ecx = 0;
    unsigned edx = 0;
    return __builtin_cpu_supports("avx2") != 0 && __get_cpuid(1, &eax, &ebx, &ecx, &edx) != 0 && (ecx & bit_F16C) != 0;
}

/// Eight values at a time. Returns how many values were done.
__attribute__((target("avx2,f16c"))) std::size_t pack_eights(std::span<const float> values, std::uint16_t* out,
                                                             std::size_t& clamped) {
    const __m256i absolute = _mm256_set1_epi32(0x7fffffff);
    const __m256i last_that_fits = _mm256_set1_epi32(std::bit_cast<std::int32_t>(overflow) - 1);
    const __m256i infinity = _mm256_set1_epi32(static_cast<std::int32_t>(float_infinity));
    const __m256i largest = _mm256_set1_epi32(std::bit_cast<std::int32_t>(largest_half));
    std::size_t i = 0;
    for (; i + 8 <= values.size(); i += 8) {
        __m256i bits = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values.data() + i));
        const __m256i magnitude = _mm256_and_si256(bits, absolute);
        const __m256i too_large =
            _mm256_and_si256(_mm256_cmpgt_epi32(magnitude, last_that_fits), _mm256_cmpgt_epi32(infinity, magnitude));
        if (_mm256_testz_si256(too_large, too_large) == 0) {
            const __m256i limit = _mm256_or_si256(largest, _mm256_andnot_si256(absolute, bits));
            bits = _mm256_blendv_epi8(bits, limit, too_large);
            const int lanes = _mm256_movemask_ps(_mm256_castsi256_ps(too_large));
            clamped += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(lanes)));
        }
        const __m128i halves = _mm256_cvtps_ph(_mm256_castsi256_ps(bits), _MM_FROUND_TO_NEAREST_INT);
        _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i), halves);
    }
    return i;
}
#endif

} // namespace

std::size_t pack_halves_portable(std::span<const float> values, std::uint16_t* out) {
    std::uint32_t clamped = 0; // a row or a strip: fits
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float value = values[i];
        const std::uint32_t magnitude = std::bit_cast<std::uint32_t>(value) & 0x7fffffffU;
        const bool too_large = magnitude >= std::bit_cast<std::uint32_t>(overflow) && magnitude < float_infinity;
        clamped += too_large ? 1U : 0U;
        out[i] = round_to_half(too_large ? std::copysign(largest_half, value) : value);
    }
    return clamped;
}

std::size_t pack_halves(std::span<const float> values, std::uint16_t* out) {
    std::size_t done = 0;
    std::size_t clamped = 0;
#if defined(__x86_64__)
    static const bool converts = has_conversion(); // asking takes longer than a row
    if (converts) {
        done = pack_eights(values, out, clamped);
    }
#endif
    return clamped + pack_halves_portable(values.subspan(done), out + done);
}

void split_bytes(std::span<const std::uint16_t> pairs, std::byte* even, std::byte* odd) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        even[i] = static_cast<std::byte>(pairs[i]);
        odd[i] = static_cast<std::byte>(pairs[i] >> 8U);
    }
}

void make_differences(std::span<const std::byte> bytes, std::byte* out) {
    if (bytes.empty()) {
        return;
    }
    out[0] = bytes[0];
    for (std::size_t i = 1; i < bytes.size(); ++i) {
        out[i] = static_cast<std::byte>(static_cast<unsigned>(bytes[i]) - static_cast<unsigned>(bytes[i - 1]) + 128U);
    }
}

std::uint8_t unit_byte(float value) {
    // The comparison is false for NaN.
    const float clamped = value > 0.0F ? std::min(value, 1.0F) : 0.0F;
    return static_cast<std::uint8_t>(std::lround(clamped * 255.0F));
}

std::uint8_t srgb_byte(float linear) {
    if (!(linear > 0.0F)) {
        return 0;
    }
    const float x = std::min(linear, 1.0F);
    return unit_byte(x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F);
}

} // namespace clshade
