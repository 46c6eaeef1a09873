// Adding up light, and where it is written (pixel rules 9 and 10).
#ifndef CLSHADE_RADIANCE_CL
#define CLSHADE_RADIANCE_CL

#include "lights.cl"

typedef struct {
    rgb total;
#if OUTPUT_DIFFUSE >= 0
    rgb diffuse;
#endif
#if OUTPUT_SPECULAR >= 0
    rgb specular;
#endif
    mask clamped;       // a parameter was out of range
    mask fractional_id; // the material id is no whole number
} radiance;

// The planes of the result at the pixels at hand.
typedef struct {
    __global float* planes;
    ulong stride;
    ulong pixel;
} results;

static inline radiance no_radiance(void) {
    radiance sum;
    sum.total = grey(splat(0.0f));
#if OUTPUT_DIFFUSE >= 0
    sum.diffuse = sum.total;
#endif
#if OUTPUT_SPECULAR >= 0
    sum.specular = sum.total;
#endif
    sum.clamped = FALSE_MASK;
    sum.fractional_id = FALSE_MASK;
    return sum;
}

static inline radiance choose_radiance(mask m, radiance a, radiance b) {
    radiance sum;
    sum.total = choose_rgb(m, a.total, b.total);
#if OUTPUT_DIFFUSE >= 0
    sum.diffuse = choose_rgb(m, a.diffuse, b.diffuse);
#endif
#if OUTPUT_SPECULAR >= 0
    sum.specular = choose_rgb(m, a.specular, b.specular);
#endif
    sum.clamped = (m & a.clamped) | (negated(m) & b.clamped);
    sum.fractional_id = (m & a.fractional_id) | (negated(m) & b.fractional_id);
    return sum;
}

static inline void store_rgb(results out, int plane, rgb value) {
    store_plane(out.planes, out.stride, plane, out.pixel, value.r);
    store_plane(out.planes, out.stride, plane + 1, out.pixel, value.g);
    store_plane(out.planes, out.stride, plane + 2, out.pixel, value.b);
}

// value * coverage where the pixel is alive and the product is finite, else 0.
static inline rgb deliver(rgb value, surface s, mask good) {
    return choose_rgb(good, scale_rgb(value, s.coverage), grey(splat(0.0f)));
}

static inline mask is_finite_rgb(rgb v) {
    return (v.r + v.g + v.b) * 0.0f == splat(0.0f);
}

// Sums over the lights of E_0 times what does not depend on the material's colours. Fresnel is linear in F0 and the
// diffuse part in the albedo, so the colours are multiplied in once, after the loop, and take no registers inside it.
typedef struct {
    rgb diffuse;  // of pi f_cos / albedo of the diffuse part
    rgb square;   // of its part in albedo^2 (full Oren-Nayar only)
    rgb specular; // of the lobe, without normaliser and Fresnel
    rgb weighted; // of the lobe times the Fresnel weight
} light_sums;

static inline light_sums no_light(void) {
    const rgb zero = grey(splat(0.0f));
    const light_sums sums = {zero, zero, zero, zero};
    return sums;
}

static inline rgb irradiance(__global const LightConstants* light, incidence i) {
    return make_rgb(light->power[0] * i.strength, light->power[1] * i.strength, light->power[2] * i.strength);
}

// sum + E_0 share
static inline rgb add_share(rgb sum, rgb e0, real share) {
    return multiply_add_rgb(e0, grey(share), sum);
}

// colour (diffuse + albedo square) + normaliser (F0 specular + (1 - F0) weighted); colour = albedo/pi times what
// the specular part leaves.
static inline radiance reflect(light_sums sums, rgb colour, rgb albedo, rgb f0, real normaliser) {
    const rgb diffuse = multiply_rgb(colour, multiply_add_rgb(albedo, sums.square, sums.diffuse));
    const rgb specular =
        scale_rgb(multiply_add_rgb(f0, sums.specular, multiply_rgb(complement(f0), sums.weighted)), normaliser);
    radiance sum = no_radiance();
    sum.total = add_rgb(diffuse, specular);
#if OUTPUT_DIFFUSE >= 0
    sum.diffuse = diffuse;
#endif
#if OUTPUT_SPECULAR >= 0
    sum.specular = specular;
#endif
    return sum;
}

#if OUTPUT_LIGHTS >= 0
// One light's own share. Planes start at zero; materials claim disjoint pixels, so each adds its own to what is there.
static inline void store_light(results out, mask mine, surface s, int index, radiance own) {
    const int plane = OUTPUT_LIGHTS + 3 * index;
    const rgb share = deliver(own.total, s, mine & is_finite_rgb(scale_rgb(own.total, s.coverage)));
    const rgb before = make_rgb(load_plane(out.planes, out.stride, plane, out.pixel),
                                load_plane(out.planes, out.stride, plane + 1, out.pixel),
                                load_plane(out.planes, out.stride, plane + 2, out.pixel));
    store_rgb(out, plane, choose_rgb(mine, share, before));
}

// Takes back a light's share where the sum over all lights came out as no finite number.
static inline void clear_light(results out, int index, mask cleared) {
    for (int plane = OUTPUT_LIGHTS + 3 * index; plane < OUTPUT_LIGHTS + 3 * index + 3; ++plane) {
        const real before = load_plane(out.planes, out.stride, plane, out.pixel);
        store_plane(out.planes, out.stride, plane, out.pixel, choose(cleared, splat(0.0f), before));
    }
}
#endif

#endif
