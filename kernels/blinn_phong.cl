// Physically based Blinn-Phong, exact (models.md section 1) and as implemented by tri-Ace (section 2).
// Values are cosine-weighted, f_cos = f_r N.L, which is bounded where f_r is not: N.L / max(N.L, N.E) = min(1, NL/NE).
#ifndef CLSHADE_BLINN_PHONG_CL
#define CLSHADE_BLINN_PHONG_CL

#include "lights.cl"

// Section 1: (n+2) / (4 pi (2 - 2^(-n/2))), the reciprocal of the lobe's hemispherical integral at normal view.
static inline real normaliser_exact(real n) {
    return (n + 2.0f) * (0.25f * INV_PI_F) / (2.0f - exp2_clamped(-0.5f * n));
}

// Section 2: the deck's linear fit of it.
static inline real normaliser_linear(real n) {
    return fma(n, splat(0.0397436f), splat(0.0856832f));
}

// (1 - c)^5: the weight of Schlick's Fresnel, F = F0 + (1 - F0) weight.
static inline real schlick_weight(real c) {
    const real w = 1.0f - c;
    const real w2 = w * w;
    return w2 * w2 * w;
}

// Section 2: the spherical-Gaussian stand-in for that weight, 2^((-5.55473 c - 6.98316) c).
static inline real schlick_weight_gaussian(real c) {
    return exp2_in_range(c * fma(c, splat(-5.55473f), splat(-6.98316f)));
}

static inline rgb fresnel(rgb f0, real weight) {
    return make_rgb(fma(1.0f - f0.r, weight, f0.r), fma(1.0f - f0.g, weight, f0.g), fma(1.0f - f0.b, weight, f0.b));
}

// (N.H)^n = 2^(n/2 log2 (N.H)^2); 1 for n = 0 whatever N.H is.
static inline real lobe(incidence i, real n) {
    return exp2_clamped(0.5f * n * log2_cosine_squared(i.nh2, i.sin2_nh));
}

// The specular part without its Fresnel colour, for both sections: normaliser N.H^n N.L / max(N.L, N.E). The normaliser
// is the same for every light of a pixel: normaliser_linear(n) for section 2, normaliser_exact(n) for section 1.
static inline real blinn_phong(incidence i, real n, real normaliser) {
    return normaliser * lobe(i, n) * i.ratio;
}

// What the specular part leaves for diffuse: (1 - F0) in section 2; in section 1 also 1 - (1 - N.L)^5, since
// 1 - Schlick(F0, N.L) = (1 - F0)(1 - (1 - N.L)^5).
static inline real diffuse_weight_exact(incidence i) {
    return 1.0f - schlick_weight(i.nl);
}

#endif
