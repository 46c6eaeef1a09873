// AmbientBRDF tables (models.md section 6): what a lobe gathers from a white sky, split by reflectance. With SPECTRAL a
// metal's own reflectance in red, green, blue; without, Schlick's two parts as red and green.
//
// The integral goes over half vectors, dw_L = 4 EH dw_H, at polar angle theta about N and azimuth phi from E's side.
// Where min(1, NL/NE) and the horizon bend the integrand is cut: at cos phi = tan theta/tan theta_E (NL = NE) and at
// cos phi = -cot(2 theta)/tan theta_E (NL = 0). Those limits start or end like square roots at theta = theta_E and
// (pi/2 -+ theta_E)/2, so theta runs in three pieces, each with nodes that crowd at its ends. Lanes are neighbouring
// N.E.
#include "filter_types.h"
#include "lanes.cl"
#include "math.cl"
#include "spectral.cl"
#include "vectors.cl"

#define POLAR_NODES 32
#define AZIMUTH_NODES 16

// sin x on -pi/2..pi/2, relative error 7e-10 in exact arithmetic (Taylor).
static inline real sine_of(real x) {
    const real x2 = x * x;
    real p = splat(1.6059044e-10f);
    p = fma(p, x2, splat(-2.5052108e-8f));
    p = fma(p, x2, splat(2.7557319e-6f));
    p = fma(p, x2, splat(-1.9841270e-4f));
    p = fma(p, x2, splat(8.3333333e-3f));
    p = fma(p, x2, splat(-0.16666667f));
    return fma(p * x2, x, x);
}

static inline real arc_cosine(real c) {
    c = larger(smaller(c, splat(1.0f)), splat(-1.0f));
    return angle_of(square_root((1.0f - c) * (1.0f + c)), c);
}

// Reflectance at E.H = 1 - 2 h.
static inline rgb reflectance(real h, __global const float* curve, int coefficients, float bend) {
#ifdef SPECTRAL
    const real x = metal_argument(1.0f - 2.0f * h, bend);
    rgb p = grey(splat(0.0f));
    for (int k = coefficients - 1; k >= 0; --k) {
        p = horner(p, x, curve[3 * k], curve[3 * k + 1], curve[3 * k + 2]);
    }
    p = larger_rgb(p, 0.0f);
    return make_rgb(smaller(p.r, splat(1.0f)), smaller(p.g, splat(1.0f)), smaller(p.b, splat(1.0f)));
#else
    const real w = 2.0f * h;
    const real w2 = w * w;
    const real fresnel = w2 * w2 * w;
    return make_rgb(1.0f - fresnel, fresnel, splat(0.0f));
#endif
}

typedef struct {
    real cosine; // N.E
    real sine;
    real angle;
} eye_angles;

// The integral over phi from `low` to `high` of min(1, NL/NE) EH times the reflectance.
static inline rgb azimuth_sum(eye_angles eye, real cosine, real across, real along, real low, real high,
                              __global const float* nodes, __global const float* curve, int coefficients, float bend) {
    rgb sum = grey(splat(0.0f));
    const real length = high - low;
    const real light = 2.0f * cosine * inverse(eye.cosine);
    for (int i = 0; i < AZIMUTH_NODES; ++i) {
        const real s = sine_of(0.5f * fma(length, splat(nodes[2 * i]), low));
        const real h = fma(along * s, s, across); // (1 - EH)/2, without cancellation near E = H
        const real eh = 1.0f - 2.0f * h;
        const real attenuation = larger(smaller(fma(light, eh, splat(-1.0f)), splat(1.0f)), splat(0.0f));
        const real weight = nodes[2 * i + 1] * attenuation * eh;
        const rgb r = reflectance(h, curve, coefficients, bend);
        sum = multiply_add_rgb(r, grey(weight), sum);
    }
    return scale_rgb(sum, length);
}

// The integral over theta from `low` to `high`.
static inline rgb polar_sum(eye_angles eye, AmbientRow row, real low, real high, __global const float* nodes,
                            __global const float* curve, int coefficients, float bend) {
    rgb sum = grey(splat(0.0f));
    const real length = high - low;
    const real cotangent = eye.cosine * inverse(larger(eye.sine, splat(1e-12f)));
    for (int i = 0; i < POLAR_NODES; ++i) {
        const real theta = fma(length, splat(nodes[2 * i]), low);
        const real s = sine_of(theta);
        const real c = sine_of(0.5f * PI_F - theta);
        const real c2 = c * c;
        const real s2 = s * s;
        const real lobe = exp2_clamped(row.half_exponent * log2_cosine_squared(c2, s2));
        const real weight = nodes[2 * i + 1] * lobe * s;
        const real d = sine_of(0.5f * (theta - eye.angle));
        const real across = d * d;
        const real along = s * eye.sine;
        const real full = arc_cosine(s * inverse(c) * cotangent);
        const real horizon = larger(arc_cosine((s2 - c2) * inverse(larger(2.0f * s * c, splat(1e-20f))) * cotangent), full);
        __global const float* azimuths = nodes + 2 * POLAR_NODES;
        const rgb inner = azimuth_sum(eye, c, across, along, splat(0.0f), full, azimuths, curve, coefficients, bend);
        const rgb outer = azimuth_sum(eye, c, across, along, full, horizon, azimuths, curve, coefficients, bend);
        sum = multiply_add_rgb(add_rgb(inner, outer), grey(weight), sum);
    }
    return scale_rgb(sum, length);
}

// A work-item: LANES vertices of one row of the table. `eyes`: N.E, its sine and its angle in rows of `columns`, a
// multiple of the lanes. `nodes`: position in 0..1 and weight of the polar nodes, then of the azimuthal ones. `curve`:
// coefficients, RGB, lowest first. `result`: per row of the table three rows of `columns`.
__kernel void ambient_brdf(__global const float* eyes, __global const AmbientRow* rows, __global const float* nodes,
                           __global const float* curve, int coefficients, float bend, __global float* result,
                           int columns, int row_count) {
    const int groups = columns / LANES;
    const int index = (int)get_global_id(0);
    const int j = index / groups;
    const int column = (index - j * groups) * LANES;
    if (j < row_count) {
        const AmbientRow row = rows[j];
        const eye_angles eye = {load_plane(eyes, columns, 0, column), load_plane(eyes, columns, 1, column),
                                load_plane(eyes, columns, 2, column)};
        const real reach = splat(row.reach);
        const real below = smaller(0.25f * PI_F - 0.5f * eye.angle, reach);
        const real at = smaller(eye.angle, reach);
        const real first = smaller(below, at);
        const real second = larger(below, at);
        const real third = smaller(0.25f * PI_F + 0.5f * eye.angle, reach);
        rgb sum = polar_sum(eye, row, splat(0.0f), first, nodes, curve, coefficients, bend);
        sum = add_rgb(sum, polar_sum(eye, row, first, second, nodes, curve, coefficients, bend));
        sum = add_rgb(sum, polar_sum(eye, row, second, third, nodes, curve, coefficients, bend));
        sum = scale_rgb(sum, splat(row.factor));
        *(__global real*)(result + (3 * j) * columns + column) = sum.r;
        *(__global real*)(result + (3 * j + 1) * columns + column) = sum.g;
        *(__global real*)(result + (3 * j + 2) * columns + column) = sum.b;
    }
}
