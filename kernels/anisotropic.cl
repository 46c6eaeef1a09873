// Anisotropic Blinn-Phong (models.md section 3): an exponent along the tangent, another across it.
#ifndef CLSHADE_ANISOTROPIC_CL
#define CLSHADE_ANISOTROPIC_CL

#include "blinn_phong.cl"

// A tangent nearer than this to the normal (as a sine) cannot be believed (pixel rule 6).
#define SMALLEST_TANGENT_SINE 1e-4f
#define SHORTEST_TANGENT 1e-6f

typedef struct {
    vec3 t, b;    // unit tangent and bitangent, at right angles to N
    mask missing; // no tangent, one parallel to N or beyond all measure: a frame of N alone stands in
} tangent_frame;

// Duff et al., "Building an Orthonormal Basis, Revisited" (JCGT 2017): the first axis of a frame around n.
static inline vec3 any_tangent(vec3 n) {
    const real sign = choose(AS_INTEGER(n.z) < (integer)(0), splat(-1.0f), splat(1.0f));
    const real a = -inverse(sign + n.z);
    return make_vec3(fma(sign * n.x * n.x, a, splat(1.0f)), sign * n.x * n.y * a, -sign * n.x);
}

static inline tangent_frame tangent_frame_of(vec3 n, vec3 tangent) {
    const real along = dot3(tangent, n);
    const vec3 u = make_vec3(fma(-along, n.x, tangent.x), fma(-along, n.y, tangent.y), fma(-along, n.z, tangent.z));
    const real u2 = dot3(u, u);
    const real t2 = dot3(tangent, tangent);
    tangent_frame f;
    f.missing = (u2 < SMALLEST_TANGENT_SINE * SMALLEST_TANGENT_SINE * t2) |
                (t2 < splat(SHORTEST_TANGENT * SHORTEST_TANGENT)) | (t2 > splat(FLT_MAX));
    const vec3 projected = scale3(u, inverse_sqrt(choose(f.missing, splat(1.0f), u2)));
    f.t = choose3(f.missing, any_tangent(n), projected);
    f.b = cross3(n, f.t);
    return f;
}

// e/2 with e = (n_u (T.H)^2 + n_v (B.H)^2) / (1 - (N.H)^2). H's length cancels, and only its part across N counts: so
// that what rounding left of N in T, much where the tangent is nearly parallel to it, does not. At the highlight's
// centre, where both products vanish, any value will do.
static inline real anisotropic_half_exponent(incidence i, tangent_frame f, real shininess_u, real shininess_v) {
    const real th = dot3(f.t, i.across);
    const real bh = dot3(f.b, i.across);
    const real t = th * th;
    const real b = bh * bh;
    return 0.5f * fma(shininess_u, t, shininess_v * b) * inverse(larger(t + b, splat(1e-24f)));
}

// sqrt(a b) / (8 pi (1 - w)), w = (2^(-a/2) + 2 2^(-a b/(a+b)) + 2^(-b/2)) / 4, a = n_u + 2, b = n_v + 2.
static inline real normaliser_anisotropic(real shininess_u, real shininess_v) {
    const real a = shininess_u + 2.0f;
    const real b = shininess_v + 2.0f;
    const real w = 0.25f * (exp2_clamped(-0.5f * a) + 2.0f * exp2_clamped(-a * b * inverse(a + b)) + exp2_clamped(-0.5f * b));
    return square_root(a * b) * (0.125f * INV_PI_F) * inverse(1.0f - w);
}

#endif
