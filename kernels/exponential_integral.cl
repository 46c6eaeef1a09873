// E_3, the exponential integral of diffuse light through an absorbing layer (models.md section 7).
#ifndef CLSHADE_EXPONENTIAL_INTEGRAL_CL
#define CLSHADE_EXPONENTIAL_INTEGRAL_CL

#include "math.cl"

// E_3(a), a >= 0. Below 1 E_3 = (e^-a (1 - a) + a^2 E_1)/2 with a polynomial for E_1 + log a (error 2.3e-9); from 1 on
// e^-a/(a + 3) times one in 1/(a + 2) (relative error 2.3e-6).
static inline real exponential_integral_3(real a) {
    const real decay = exp2_clamped(-1.44269504f * a);
    real p = splat(-0.000152216060f);
    p = fma(p, a, splat(0.00156623498f));
    p = fma(p, a, splat(-0.0103510646f));
    p = fma(p, a, splat(0.0555332154f));
    p = fma(p, a, splat(-0.249996349f));
    p = fma(p, a, splat(0.999999762f));
    p = fma(p, a, splat(-0.577215672f));
    const real e1 = fma(log2_positive(larger(a, splat(1e-30f))), splat(-0.693147181f), p);
    const real small = 0.5f * fma(a * a, e1, decay * (1.0f - a));
    const real t = inverse(a + 2.0f);
    real q = splat(38.6451530f);
    q = fma(q, t, splat(-44.4973221f));
    q = fma(q, t, splat(25.6592541f));
    q = fma(q, t, splat(-8.33781815f));
    q = fma(q, t, splat(2.82035208f));
    q = fma(q, t, splat(0.00449465727f));
    q = fma(q, t, splat(0.999959290f));
    return choose(a < splat(1.0f), small, decay * q * inverse(a + 3.0f));
}

#endif
