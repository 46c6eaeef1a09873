#include "host/images/pack.h"

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
    const std::uint32_t special = 0x7c00U | (magnitude > float_infinity ? 0x200U : 0U);
    std::uint32_t half = magnitude < (113U << 23) ? denormal : normal;
    half = magnitude >= float_infinity ? special : half;
    return static_cast<std::uint16_t>(half | sign);
}

} // namespace

std::size_t pack_halves(std::span<const float> values, std::uint16_t* out) {
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
