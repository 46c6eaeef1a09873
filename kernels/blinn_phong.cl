// Physically based Blinn-Phong, exact (models.md section 1) and as implemented by tri-Ace (section 2).
// Values are cosine-weighted, f_cos = f_r N.L, which is bounded where f_r is not: N.L / max(N.L, N.E) = min(1, NL/NE).
#ifndef CLSHADE_BLINN_PHONG_CL
#define CLSHADE_BLINN_PHONG_CL

#include "lights.cl"

// Section 1: (n+2) / (4 pi (2 - 2^(-n/2))), the reciprocal of the lobe's hemispherical integral at normal view.
static inline real normaliser_exact(real n) {
    return (n + 2.0f) * (0.25f * INV_PI_F) * inverse(2.0f - exp2_clamped(-0.5f * n));
}

// Section 2: the deck's linear fit of it.
static inline real normaliser_linear(real n) {
    return fma(n, splat(0.0397436f), splat(0.0856832f));
}

// (1 - E.H)^5: the weight of Schlick's Fresnel, F = F0 + (1 - F0) weight.
static inline real schlick_weight_of(real cosine) {
    const real w = 1.0f - cosine;
    const real w2 = w * w;
    return w2 * w2 * w;
}

static inline real schlick_weight(incidence i) {
    return schlick_weight_of(0.5f * i.two_eh);
}

// Section 2: the spherical-Gaussian stand-in for that weight, 2^((-5.55473 E.H - 6.98316) E.H).
static inline real schlick_weight_gaussian_of(real two_cosines) {
    return exp2_in_range(two_cosines * fma(two_cosines, splat(-0.25f * 5.55473f), splat(-0.5f * 6.98316f)));
}

static inline real schlick_weight_gaussian(incidence i) {
    return schlick_weight_gaussian_of(i.two_eh);
}

// (N.H)^n = 2^(n/2 log2 (N.H)^2), which is 1 for n = 0 whatever N.H is. The specular part is this times normaliser,
// Fresnel and i.ratio = N.L / max(N.L, N.E).
static inline real cosine_power(incidence i, real half_shininess) {
    return exp2_clamped(half_shininess * i.log2_nh2);
}

// What the specular part leaves for diffuse: (1 - F0) in section 2; in section 1 also 1 - (1 - N.L)^5, since
// 1 - Schlick(F0, N.L) = (1 - F0)(1 - (1 - N.L)^5).
static inline real diffuse_weight_exact(incidence i) {
    const real w = 1.0f - i.nl;
    const real w2 = w * w;
    return 1.0f - w2 * w2 * w;
}

#endif
