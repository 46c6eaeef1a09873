// Powers for the loops that the compiler vectorises.
#pragma once

namespace clshade::rivals {
namespace {

/// 2^x for -126 < x < 127. Chebyshev interpolation of degree 4 on -0.5 .. 0.5, relative error 7e-6.
inline float power_of_two(float x) {
    const float whole = __builtin_rintf(x);
    const float f = x - whole;
    float p = 9.65671029e-03F;
    p = p * f + 5.58382829e-02F;
    p = p * f + 2.40225301e-01F;
    p = p * f + 6.93136734e-01F;
    p = p * f + 1.0F;
    return __builtin_bit_cast(float, __builtin_bit_cast(int, p) + (static_cast<int>(whole) << 23));
}

/// log2(1 + f) for -0.25 <= f < 0.5. Chebyshev interpolation of degree 6, relative error 1.3e-6.
inline float log_polynomial(float f) {
    float p = 1.17231839e-01F;
    p = p * f - 2.40619997e-01F;
    p = p * f + 2.98174036e-01F;
    p = p * f - 3.61730395e-01F;
    p = p * f + 4.80641618e-01F;
    p = p * f - 7.21324777e-01F;
    p = p * f + 1.44269619e+00F;
    return p * f;
}

/// log2(x) for normal x > 0: mantissa in 0.75 .. 1.5.
inline float log_to_two(float x) {
    const int bits = __builtin_bit_cast(int, x);
    const int exponent = (bits - 0x3f400000) >> 23;
    const float f = __builtin_bit_cast(float, bits - (exponent << 23)) - 1.0F;
    return log_polynomial(f) + static_cast<float>(exponent);
}

/// log2(1 - h) for 0 <= h < 1, with a small relative error near h = 0 too.
inline float log_of_rest(float h) {
    const float x = 1.0F - h;
    const int bits = __builtin_bit_cast(int, x);
    const int exponent = (bits - 0x3f400000) >> 23;
    const float mantissa = __builtin_bit_cast(float, bits - (exponent << 23)) - 1.0F;
    return log_polynomial(exponent == 0 ? -h : mantissa) + static_cast<float>(exponent);
}

inline float larger(float a, float b) {
    return a > b ? a : b;
}

inline float smaller(float a, float b) {
    return a < b ? a : b;
}

} // namespace
} // namespace clshade::rivals
