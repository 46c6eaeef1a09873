// Elementary functions over lanes. The built-in exp2, log2, pow, atan2 of CPU drivers are calls that cost 10 to 50
// times as much; these are polynomials. Coefficients: minimax fits of this project (Lawson's iteration), errors as
// stated, in exact arithmetic; rounding adds about 1e-7. Long ones are written in pairs (Estrin): the loop over the
// lights waits for their latency.
#ifndef CLSHADE_MATH_CL
#define CLSHADE_MATH_CL

#include "lanes.cl"

#define PI_F 3.14159265358979f
#define INV_PI_F 0.318309886183791f

// 1.5 * 2^23: adding it rounds to a whole number in the low bits (round to nearest, IEEE arithmetic; the program is
// never built with relaxed maths).
#define ROUNDING_MAGIC 12582912.0f

// Below this an exponential is taken as 2^-60: small against any radiance, and nothing goes denormal (1.5-1.8x).
#define SMALLEST_EXPONENT (-60.0f)

// 2^x for -126 <= x <= 127. Relative error of the polynomial 9.2e-8.
static inline real exp2_in_range(real x) {
    const real shifted = x + ROUNDING_MAGIC;
    const real f = x - (shifted - ROUNDING_MAGIC);
    const real f2 = f * f;
    const real p01 = fma(f, splat(0.693147004f), splat(1.0f));
    const real p23 = fma(f, splat(0.0555073358f), splat(0.240222424f));
    const real p45 = fma(f, splat(0.00132647273f), splat(0.00967151299f));
    const real p = fma(fma(p45, f2, p23), f2, p01);
    return AS_REAL(AS_INTEGER(p) + (AS_INTEGER(shifted) << 23));
}

// 2^x for x <= 127, clamped at SMALLEST_EXPONENT.
static inline real exp2_clamped(real x) {
    return exp2_in_range(larger(x, splat(SMALLEST_EXPONENT)));
}

// exponent + log2(1 - t), for a mantissa 1 - t between sqrt(1/2) and sqrt(2). Relative error of the polynomial 3e-8.
static inline real log2_from(integer exponent, real t) {
    // log(1 - t) = -(t + t^2 p(t))
    const real t2 = t * t;
    const real p01 = fma(t, splat(0.333339512f), splat(0.499999911f));
    const real p23 = fma(t, splat(0.199620724f), splat(0.250017554f));
    const real p45 = fma(t, splat(0.149179742f), splat(0.165705085f));
    const real p67 = fma(t, splat(0.0873484313f), splat(0.143075213f));
    const real p = fma(fma(p67, t2, p45), t2 * t2, fma(p23, t2, p01));
    const real minus_log = fma(p, t2, t);
    return fma(minus_log, splat(-1.44269504f), LANES_FROM_INTEGER(exponent));
}

// log2 of a squared cosine, from the squared cosine and, near 1 where that has lost its low digits, the squared sine
// (models.md section 14: log1p(-sin^2) keeps high exponents exact). 0 <= cos2 <= 1; cos2 = 0 gives about -127.
static inline real log2_cosine_squared(real cos2, real sin2) {
    const integer sqrt_half = (integer)(0x3f3504f3);
    const integer bits = AS_INTEGER(cos2) - sqrt_half;
    const integer exponent = bits >> 23;
    const real mantissa = AS_REAL((bits & (integer)(0x007fffff)) + sqrt_half);
    return log2_from(exponent, choose(exponent >= (integer)(0), sin2, 1.0f - mantissa));
}

// log2 x, x > 0 and not denormal.
static inline real log2_positive(real x) {
    const integer sqrt_half = (integer)(0x3f3504f3);
    const integer bits = AS_INTEGER(x) - sqrt_half;
    return log2_from(bits >> 23, 1.0f - AS_REAL((bits & (integer)(0x007fffff)) + sqrt_half));
}

// Division and square root of 16 lanes occupy one port for 10 to 24 cycles each, which would be a third of a one-light
// pixel. Where the processor has AVX-512 its 14-bit estimates and one Newton step do the same to within one ulp.
#if LANES == 16 && defined(__AVX512F__) && defined(__has_builtin)
#if __has_builtin(__builtin_ia32_rsqrt14ps512_mask) && __has_builtin(__builtin_ia32_rcp14ps512_mask)
#define CLSHADE_AVX512_ESTIMATES 1
#endif
#endif

// 1 / sqrt(x), x > 0. NaN or Inf for x = 0.
static inline real inverse_sqrt(real x) {
#ifdef CLSHADE_AVX512_ESTIMATES
    const real y = __builtin_ia32_rsqrt14ps512_mask(x, x, (ushort)0xffff);
    const real residual = fma(-x * y, y, splat(1.0f));
    return fma(0.5f * y, residual, y);
#else
    return 1.0f / sqrt(x);
#endif
}

// sqrt(x), x >= 0.
static inline real square_root(real x) {
    return x * inverse_sqrt(larger(x, splat(1e-30f)));
}

// 1 / x for finite x other than 0.
static inline real inverse(real x) {
#ifdef CLSHADE_AVX512_ESTIMATES
    const real y = __builtin_ia32_rcp14ps512_mask(x, x, (ushort)0xffff);
    return fma(fma(-x, y, splat(1.0f)), y, y);
#else
    return 1.0f / x;
#endif
}

// Angle in [0, pi] of a vector with the given cosine and sine parts (any common positive length), sine >= 0.
// Keeps its precision at both ends where acos does not. Maximum error of the polynomial 1.1e-7 relative.
static inline real angle_of(real sine, real cosine) {
    const real c = fabs(cosine);
    const mask steep = sine > c;
    const real t = choose(steep, c, sine) / larger(choose(steep, sine, c), splat(1e-30f));
    const real t2 = t * t;
    real p = splat(-0.00482253404f);
    p = fma(p, t2, splat(0.0247340631f));
    p = fma(p, t2, splat(-0.0602031313f));
    p = fma(p, t2, splat(0.0996847302f));
    p = fma(p, t2, splat(-0.140413284f));
    p = fma(p, t2, splat(0.199742138f));
    p = fma(p, t2, splat(-0.333323926f));
    const real a = fma(p * t2, t, t);
    const real quarter = choose(steep, 0.5f * PI_F - a, a);
    return choose(cosine < splat(0.0f), PI_F - quarter, quarter);
}

#endif
