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
#if OUTPUT_ENVIRONMENT >= 0
    rgb environment;
#endif
    mask clamped;       // a parameter was out of range
    mask fractional_id; // the material id is no whole number
    mask no_tangent;    // an anisotropic material without a usable tangent
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
#if OUTPUT_ENVIRONMENT >= 0
    sum.environment = sum.total;
#endif
    sum.clamped = FALSE_MASK;
    sum.fractional_id = FALSE_MASK;
    sum.no_tangent = FALSE_MASK;
    return sum;
}

static inline radiance make_radiance(rgb diffuse, rgb specular) {
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

static inline radiance choose_radiance(mask m, radiance a, radiance b) {
    radiance sum;
    sum.total = choose_rgb(m, a.total, b.total);
#if OUTPUT_DIFFUSE >= 0
    sum.diffuse = choose_rgb(m, a.diffuse, b.diffuse);
#endif
#if OUTPUT_SPECULAR >= 0
    sum.specular = choose_rgb(m, a.specular, b.specular);
#endif
#if OUTPUT_ENVIRONMENT >= 0
    sum.environment = choose_rgb(m, a.environment, b.environment);
#endif
    sum.clamped = (m & a.clamped) | (negated(m) & b.clamped);
    sum.fractional_id = (m & a.fractional_id) | (negated(m) & b.fractional_id);
    sum.no_tangent = (m & a.no_tangent) | (negated(m) & b.no_tangent);
    return sum;
}

// The light of an environment added.
static inline radiance add_environment(radiance sum, rgb diffuse, rgb specular) {
    const rgb own = add_rgb(diffuse, specular);
    sum.total = add_rgb(sum.total, own);
#if OUTPUT_DIFFUSE >= 0
    sum.diffuse = add_rgb(sum.diffuse, diffuse);
#endif
#if OUTPUT_SPECULAR >= 0
    sum.specular = add_rgb(sum.specular, specular);
#endif
#if OUTPUT_ENVIRONMENT >= 0
    sum.environment = own;
#endif
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

static inline rgb irradiance(__global const LightConstants* light, incidence i) {
    return make_rgb(light->power[0] * i.strength, light->power[1] * i.strength, light->power[2] * i.strength);
}

// Materials add up E_0 times what does not depend on their colours and multiply the colours in after the loop over the
// lights: Fresnel is linear in F0 and the diffuse part in the albedo, so neither takes registers inside it.
// sum + E_0 share
static inline rgb add_share(rgb sum, rgb e0, real share) {
    return multiply_add_rgb(e0, grey(share), sum);
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
