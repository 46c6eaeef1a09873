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

// Adds one light's share E_0 (colour * diffuse + fresnel * specular) for the pixels of `mine`: `diffuse` and `specular`
// are cosine-weighted BRDFs, colour and fresnel what they are multiplied by per channel.
static inline radiance add_light(radiance sum, results out, mask mine, surface s, int index,
                                 __global const LightConstants* light, incidence i, rgb colour, real diffuse,
                                 rgb fresnel, real specular) {
    const real d = diffuse * i.strength;
    const real f = specular * i.strength;
    const rgb both = make_rgb(fma(colour.r, d, fresnel.r * f), fma(colour.g, d, fresnel.g * f),
                              fma(colour.b, d, fresnel.b * f));
    const rgb power = make_rgb(splat(light->power[0]), splat(light->power[1]), splat(light->power[2]));
    sum.total = multiply_add_rgb(power, both, sum.total);
#if OUTPUT_DIFFUSE >= 0
    sum.diffuse = multiply_add_rgb(power, scale_rgb(colour, d), sum.diffuse);
#endif
#if OUTPUT_SPECULAR >= 0
    sum.specular = multiply_add_rgb(power, scale_rgb(fresnel, f), sum.specular);
#endif
#if OUTPUT_LIGHTS >= 0
    // Planes start at zero; materials claim disjoint pixels, so each adds its own to what is there.
    const int plane = OUTPUT_LIGHTS + 3 * index;
    const rgb whole = multiply_rgb(power, both);
    const rgb share = deliver(whole, s, mine & is_finite_rgb(scale_rgb(whole, s.coverage)));
    const rgb before = make_rgb(load_plane(out.planes, out.stride, plane, out.pixel),
                                load_plane(out.planes, out.stride, plane + 1, out.pixel),
                                load_plane(out.planes, out.stride, plane + 2, out.pixel));
    store_rgb(out, plane, choose_rgb(mine, share, before));
#endif
    return sum;
}

#if OUTPUT_LIGHTS >= 0
// Takes back a light's share where the sum over all lights came out as no finite number.
static inline void clear_light(results out, int index, mask cleared) {
    for (int plane = OUTPUT_LIGHTS + 3 * index; plane < OUTPUT_LIGHTS + 3 * index + 3; ++plane) {
        const real before = load_plane(out.planes, out.stride, plane, out.pixel);
        store_plane(out.planes, out.stride, plane, out.pixel, choose(cleared, splat(0.0f), before));
    }
}
#endif

#endif
