// Stacks of layers (models.md section 5; pixel rule 9): interfaces that reflect, media that absorb.
//
// An index of refraction n stands here as its amplitude s = (n - 1) / (n + 1) = sqrt(F0): 0 for air, 1 for an infinite
// index. Reflectances between two media are then quotients of small polynomials that neither overflow nor cancel.
#ifndef CLSHADE_LAYERS_CL
#define CLSHADE_LAYERS_CL

#include "lights.cl"

// Below this N.L means no light; its reciprocal is only ever multiplied by it.
#define SMALLEST_NL 1e-6f

// Amplitude of a layer's own F0, to the last digit: near 1, where the index goes to infinity, it decides what a grazing
// ray sees.
static inline real amplitude_of(real f0) {
    const real root = square_root(f0);
    const real residual = fma(-root, root, f0);
    return fma(0.5f * residual, inverse(larger(root, splat(1e-15f))), root);
}

static inline rgb amplitude_of_rgb(rgb f0) {
    return make_rgb(amplitude_of(f0.r), amplitude_of(f0.g), amplitude_of(f0.b));
}

// What lies below a layer: its own medium, or that of the layer above where it has no interface (F0 = 0).
static inline real medium_below(real s, real above) {
    return choose(s > splat(0.0f), s, above);
}

// F0(n2/n1) = ((n2 - n1) / (n2 + n1))^2.
static inline real normal_reflectance(real above, real below) {
    const real amplitude = (below - above) * inverse(larger(1.0f - below * above, splat(1e-7f)));
    return amplitude * amplitude;
}

// 1 - r where light meets an interface in air, so that F = r + (1 - r) weight; 0 inside a stack, where F = r. A layer
// of F0 = 0 has no interface.
static inline real outer_gain(real r, real s, real above) {
    return choose((above == splat(0.0f)) & (s > splat(0.0f)), 1.0f - r, splat(0.0f));
}

// The same for the base, whose interface is there whatever its F0.
static inline real outer_gain_of_base(real r, real above) {
    return choose(above == splat(0.0f), 1.0f - r, splat(0.0f));
}

// A weight that holds only where light meets the interface in air.
static inline real where_outer(real weight, real gain) {
    return choose(gain > splat(0.0f), weight, splat(1.0f));
}

// The cosine of refraction times (1 + s): cos^2 = 1 - (1 - c^2)/n^2 = (4 s + (1 - s)^2 c^2) / (1 + s)^2.
static inline real refracted_square(real c2, real s) {
    const real t = 1.0f - s;
    return fma(t * t, c2, 4.0f * s);
}

static inline real refracted(real c2, real s) {
    return square_root(refracted_square(c2, s));
}

// Dielectric Fresnel between media a (above) and b, unpolarised; ga, gb as `refracted` gives them for the cosine c in
// air. Textbook: rs = (na ca - nb cb) / (na ca + nb cb), rp = (nb ca - na cb) / (nb ca + na cb). Multiplied by its
// conjugate each numerator has the factor z, which vanishes with the difference of the indices.
static inline real interface_reflectance(real c2, real ga, real gb, real a, real b) {
    const real a1 = 1.0f + a;
    const real b1 = 1.0f + b;
    const real p = a1 * (1.0f - b); // p : q = na : nb
    const real q = b1 * (1.0f - a);
    const real z = 4.0f * (a - b) * (1.0f - a * b);
    const real s = larger(fma(1.0f - b, ga, (1.0f - a) * gb), splat(1e-6f));
    const real t = larger(fma(q * b1, ga, p * a1 * gb), splat(1e-6f));
    // a1^2 b1^2 - 4 (a b1^2 + b a1^2) - ..., where a1^2 b1^2 - 4 b a1^2 = p^2 does not cancel for b near 1.
    const real v = fma(p, p, -4.0f * a * b1 * b1) - c2 * fma(p, p, q * q);
    const real inverse_st = inverse(s * t);
    const real rs_root = t * inverse_st;
    const real rp_root = s * inverse_st;
    const real rs = z * rs_root * rs_root;
    const real rp = z * v * rp_root * rp_root;
    return 0.5f * fma(rs, rs, rp * rp);
}

// 1/NL + 1/NE: the way down and up through a layer of thickness 1, not bent.
static inline real straight_path(incidence i, surface s) {
    return inverse(larger(i.nl, splat(SMALLEST_NL))) + s.inverse_ne;
}

// One half of 1/NL' + 1/NE': the way of a ray with the given cosine in air.
static inline real refracted_path(real cosine, real s) {
    return (1.0f + s) * inverse_sqrt(larger(refracted_square(cosine * cosine, s), splat(SMALLEST_NL * SMALLEST_NL)));
}

// A = max(0, 1 - a' (1/NL + 1/NE))
static inline real transmittance_approximated(real absorption, real path) {
    return larger(fma(-absorption, path, splat(1.0f)), splat(0.0f));
}

// -alpha d (1/NL' + 1/NE') as an exponent of 2: A = 2^exponent.
static inline real absorption_exponent(real absorption, real path) {
    return -1.44269504f * absorption * path;
}

static inline rgb medium_below_rgb(rgb s, rgb above) {
    return make_rgb(medium_below(s.r, above.r), medium_below(s.g, above.g), medium_below(s.b, above.b));
}

static inline rgb normal_reflectance_rgb(rgb above, rgb below) {
    return make_rgb(normal_reflectance(above.r, below.r), normal_reflectance(above.g, below.g),
                    normal_reflectance(above.b, below.b));
}

static inline rgb outer_gain_rgb(rgb r, rgb s, rgb above) {
    return make_rgb(outer_gain(r.r, s.r, above.r), outer_gain(r.g, s.g, above.g), outer_gain(r.b, s.b, above.b));
}

static inline rgb outer_gain_of_base_rgb(rgb r, rgb above) {
    return make_rgb(outer_gain_of_base(r.r, above.r), outer_gain_of_base(r.g, above.g),
                    outer_gain_of_base(r.b, above.b));
}

static inline rgb where_outer_rgb(real weight, rgb gain) {
    return make_rgb(where_outer(weight, gain.r), where_outer(weight, gain.g), where_outer(weight, gain.b));
}

static inline rgb refracted_rgb(real c2, rgb s) {
    return make_rgb(refracted(c2, s.r), refracted(c2, s.g), refracted(c2, s.b));
}

static inline rgb interface_reflectance_rgb(real c2, rgb ga, rgb gb, rgb a, rgb b) {
    return make_rgb(interface_reflectance(c2, ga.r, gb.r, a.r, b.r), interface_reflectance(c2, ga.g, gb.g, a.g, b.g),
                    interface_reflectance(c2, ga.b, gb.b, a.b, b.b));
}

static inline rgb refracted_path_rgb(real cosine, rgb s) {
    return make_rgb(refracted_path(cosine, s.r), refracted_path(cosine, s.g), refracted_path(cosine, s.b));
}

static inline rgb transmittance_approximated_rgb(rgb absorption, real path) {
    return make_rgb(transmittance_approximated(absorption.r, path), transmittance_approximated(absorption.g, path),
                    transmittance_approximated(absorption.b, path));
}

static inline rgb absorption_exponent_rgb(rgb absorption, rgb path) {
    return make_rgb(absorption_exponent(absorption.r, path.r), absorption_exponent(absorption.g, path.g),
                    absorption_exponent(absorption.b, path.b));
}

static inline rgb exp2_clamped_rgb(rgb x) {
    return make_rgb(exp2_clamped(x.r), exp2_clamped(x.g), exp2_clamped(x.b));
}

#endif
