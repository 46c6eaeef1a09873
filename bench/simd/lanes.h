// Vectors of floats as wide as the instruction set this file is compiled for, by GCC's vector extension.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace clshade::rivals {
namespace {

#if defined(__AVX512F__)
constexpr int lane_count = 16;
#elif defined(__AVX__)
constexpr int lane_count = 8;
#else
constexpr int lane_count = 4;
#endif
using Real = float __attribute__((vector_size(4 * lane_count)));
using Whole = int __attribute__((vector_size(4 * lane_count)));

inline Real splat(float value) {
    return value - Real{};
}

inline Real load(const float* from) {
    return *reinterpret_cast<const Real*>(from);
}

/// Past the caches where the instruction set can.
inline void stream(float* to, Real value) {
#if defined(__AVX512F__)
    _mm512_stream_ps(to, value);
#elif defined(__AVX__)
    _mm256_stream_ps(to, value);
#elif defined(__SSE2__)
    _mm_stream_ps(to, value);
#else
    *reinterpret_cast<Real*>(to) = value;
#endif
}

/// Orders streamed stores before the thread reports that it is done.
inline void finish_streams() {
#if defined(__SSE2__)
    _mm_sfence();
#endif
}

inline Real maximum(Real a, Real b) {
#if defined(__AVX512F__)
    return _mm512_max_ps(a, b);
#elif defined(__AVX__)
    return _mm256_max_ps(a, b);
#elif defined(__SSE2__)
    return _mm_max_ps(a, b);
#else
    return a > b ? a : b;
#endif
}

inline Real minimum(Real a, Real b) {
#if defined(__AVX512F__)
    return _mm512_min_ps(a, b);
#elif defined(__AVX__)
    return _mm256_min_ps(a, b);
#elif defined(__SSE2__)
    return _mm_min_ps(a, b);
#else
    return a < b ? a : b;
#endif
}

/// c / sqrt(x) for x > 0: the estimate and one Newton step, or the real thing and one.
inline Real over_sqrt(float c, Real x) {
#if defined(__AVX512F__)
    const Real y = _mm512_rsqrt14_ps(x);
#elif defined(__AVX__)
    const Real y = _mm256_rsqrt_ps(x);
#elif defined(__SSE2__)
    const Real y = _mm_rsqrt_ps(x);
#else
    Real y = x;
    for (int i = 0; i < lane_count; ++i) {
        y[i] = 1.0F / __builtin_sqrtf(x[i]);
    }
#endif
    return y * (1.5F * c - (0.5F * c * x) * (y * y));
}

/// 1 / x for x > 0, likewise.
inline Real reciprocal(Real x) {
#if defined(__AVX512F__)
    const Real y = _mm512_rcp14_ps(x);
    return y * (2.0F - x * y);
#elif defined(__AVX__)
    const Real y = _mm256_rcp_ps(x);
    return y * (2.0F - x * y);
#else
    return 1.0F / x;
#endif
}

/// 2^x for -126 < x < 127. Chebyshev interpolation of degree 4, relative error 7e-6.
inline Real exp2_lanes(Real x) {
#if defined(__AVX512F__)
    const Real whole = _mm512_roundscale_ps(x, 8); // nearest, no exception
#else
    const Real magic = splat(12582912.0F); // 1.5 * 2^23: the sum has the nearest whole number in its low bits
    const Real shifted = x + magic;
    const Real whole = shifted - magic;
#endif
    const Real f = x - whole; // -0.5 .. 0.5
    Real p = splat(9.65671029e-03F);
    p = p * f + 5.58382829e-02F;
    p = p * f + 2.40225301e-01F;
    p = p * f + 6.93136734e-01F;
    p = p * f + 1.0F;
#if defined(__AVX512F__)
    return _mm512_scalef_ps(p, whole);
#else
    return reinterpret_cast<Real>(reinterpret_cast<Whole>(p) + (reinterpret_cast<Whole>(shifted) << 23));
#endif
}

/// log2(x) for normal x > 0, with a small relative error near x = 1: mantissa in 0.75 .. 1.5, then log2(1 + f) / f by
/// Chebyshev interpolation of degree 6, relative error 1.3e-6.
inline Real log2_lanes(Real x) {
#if defined(__AVX512F__)
    const Real mantissa = _mm512_getmant_ps(x, _MM_MANT_NORM_p75_1p5, _MM_MANT_SIGN_zero);
    const Real f = mantissa - 1.0F;
    const Real exponent = _mm512_getexp_ps(x) - _mm512_getexp_ps(mantissa);
#else
    const Whole bits = reinterpret_cast<Whole>(x);
    const Whole whole = (bits - 0x3f400000) >> 23;
    const Real f = reinterpret_cast<Real>(bits - (whole << 23)) - 1.0F;
    const Real exponent = __builtin_convertvector(whole, Real);
#endif
    Real p = splat(1.17231839e-01F);
    p = p * f - 2.40619997e-01F;
    p = p * f + 2.98174036e-01F;
    p = p * f - 3.61730395e-01F;
    p = p * f + 4.80641618e-01F;
    p = p * f - 7.21324777e-01F;
    p = p * f + 1.44269619e+00F;
    return p * f + exponent;
}

} // namespace
} // namespace clshade::rivals
