// Punctual lights: where the light comes from and how much arrives (models.md section 0; pixel rule 8).
#ifndef CLSHADE_LIGHTS_CL
#define CLSHADE_LIGHTS_CL

#include "surface.cl"

// Guards of H for L = -E and for N.H <= 0, both only possible with the eye behind the surface.
#define SMALLEST_HH 1e-12f // added to |L + E|^2
#define SMALLEST_NH 1e-12f

// Everything a model needs of one light at one pixel.
typedef struct {
    real strength; // E_0 = power * strength
    real nl;       // N.L, at least 0: every f_cos has it, or `ratio`, as a factor, so that light from behind gives 0
    real el;       // E.L
    real two_eh;   // 2 E.H = |L + E|
    real log2_nh2; // log2 (N.H)^2: one for all lobes
    vec3 across;   // the part of L + E at a right angle to N
    real ratio;    // min(1, N.L / N.E): N.L / max(N.L, N.E)
} incidence;

static inline incidence make_incidence(surface s, vec3 l, real strength) {
    incidence i;
    const real raw_nl = dot3(s.n, l);
    i.nl = larger(raw_nl, splat(0.0f));
    i.strength = strength;
    i.el = dot3(s.e, l);
    i.ratio = smaller(splat(1.0f), i.nl * s.inverse_ne);

    // Half vector h = L + E, not normalised: |h|^2 = 2 + 2 E.L, E.H = |h| / 2.
    const vec3 h = add3(l, s.e);
    const real hh = fma(h.x, h.x, fma(h.y, h.y, fma(h.z, h.z, splat(SMALLEST_HH))));
    const real inverse_h = inverse_sqrt(hh);
    const real inverse_hh = inverse_h * inverse_h;
    const real along = raw_nl + s.raw_ne; // N.h
    const real nh = larger(along, splat(SMALLEST_NH));
    // The part of h across N. What rounding does to `along` moves it along N, at a right angle to what is wanted.
    const vec3 across = make_vec3(fma(-along, s.n.x, h.x), fma(-along, s.n.y, h.y), fma(-along, s.n.z, h.z));
    i.across = across;
    i.two_eh = hh * inverse_h;
    // |H - (N.H) N|^2 is 1 - (N.H)^2 without cancellation near the highlight's centre.
    i.log2_nh2 = log2_cosine_squared(nh * nh * inverse_hh, dot3(across, across) * inverse_hh);
    return i;
}

static inline incidence incidence_of(surface s, __global const LightConstants* light) {
    vec3 l = make_vec3(splat(light->direction[0]), splat(light->direction[1]), splat(light->direction[2]));
    real strength = splat(1.0f);
#if HAS_POINT_LIGHTS || HAS_SPOT_LIGHTS
    if (light->type != LIGHT_DISTANT) {
        const vec3 d = make_vec3((light->position_hi[0] - s.position.x) + light->position_lo[0],
                                 (light->position_hi[1] - s.position.y) + light->position_lo[1],
                                 (light->position_hi[2] - s.position.z) + light->position_lo[2]);
        const real inverse_distance = inverse_sqrt(dot3(d, d));
        const vec3 axis = l;
        l = scale3(d, inverse_distance);
        strength = inverse_distance * inverse_distance;
#if HAS_SPOT_LIGHTS
        if (light->type == LIGHT_SPOT) {
            // Smoothstep over the angle from the axis, from the cone's edge inwards.
            const vec3 across = cross3(axis, l);
            const real angle = angle_of(sqrt(dot3(across, across)), -dot3(axis, l));
            const real t = smaller(larger((light->cone_angle - angle) * light->cone_inverse_width, splat(0.0f)), splat(1.0f));
            strength *= t * t * (3.0f - 2.0f * t);
        }
#endif
    }
#endif
    return make_incidence(s, l, strength);
}

#endif
