// Written by clshade (host/shading/material_code.cpp) for one set of materials: functions for each, and
// which pixel goes to which. The copy in kernels/ is for Blinn-Phong + Lambert with every parameter from planes.
#ifndef CLSHADE_MATERIALS_CL
#define CLSHADE_MATERIALS_CL

#include "anisotropic.cl"
#include "blinn_phong.cl"
#include "diffuse.cl"
#include "environment.cl"
#include "layers.cl"
#include "parameters.cl"
#include "radiance.cl"
#include "spectral.cl"

// Material 0, "default": blinn_phong.lambert
//   layer 0: blinn_phong, f0 from f0.R, shininess from shininess over lambert, albedo from albedo.R
typedef struct {
    rgb f0;
    real shininess;
    real half_shininess;
    real scale;
    rgb specular_colour;
    rgb weighted_colour;
    rgb albedo;
    rgb diffuse_colour;
    mask clamped;
} material_0;

typedef struct {
    rgb specular;
    rgb weighted;
    rgb diffuse;
} sums_0;

// What the pixel's parameters say.
static inline material_0 read_material_0(inputs in, surface s, __constant const FrameConstants* frame) {
    material_0 m;
    const rgb raw_f0 = make_rgb(load_input(in, 9), load_input(in, 10), load_input(in, 11));
    m.f0 = clamp_unit_rgb(raw_f0);
    m.shininess = clamp_shininess(load_input(in, 12));
    m.half_shininess = 0.5f * m.shininess;
    m.scale = normaliser_linear(m.shininess);
    m.specular_colour = scale_rgb(m.f0, m.scale);
    m.weighted_colour = scale_rgb(complement(m.f0), m.scale);
    const rgb raw_albedo = make_rgb(load_input(in, 6), load_input(in, 7), load_input(in, 8));
    m.albedo = clamp_unit_rgb(raw_albedo);
    m.diffuse_colour = multiply_rgb(scale_rgb(m.albedo, splat(0.31830987f)), complement(m.f0));
    m.clamped = outside_unit(raw_f0) | outside_unit(raw_albedo);
    return m;
}

// Adds a light of irradiance e0.
static inline sums_0 add_light_0(sums_0 sums, material_0 m, surface s, incidence i, rgb e0) {
    const real weight = schlick_weight_gaussian(i);
    const real lobe = cosine_power(i, m.half_shininess);
    const real weighted = lobe * weight;
    const real scattered = lambert(i);
    sums.specular = add_share(sums.specular, e0, i.ratio * lobe);
    sums.weighted = add_share(sums.weighted, e0, i.ratio * weighted);
    sums.diffuse = add_share(sums.diffuse, e0, scattered);
    return sums;
}

// Multiplies the colours in.
static inline radiance reflect_0(material_0 m, sums_0 sums) {
    const rgb diffuse = multiply_rgb(m.diffuse_colour, sums.diffuse);
    const rgb specular = multiply_add_rgb(m.weighted_colour, sums.weighted, multiply_rgb(m.specular_colour,
        sums.specular));
    radiance sum = make_radiance(diffuse, specular);
    sum.clamped = m.clamped;
    return sum;
}

// From planes to radiance; store_light needs to know which pixels are its own.
static inline radiance shade_material_0(mask mine, inputs in, surface s, results out,
    __constant const FrameConstants* frame, __global const LightConstants* lights) {
    const material_0 m = read_material_0(in, s, frame);
    const sums_0 none = {0};
    sums_0 sums = none;
    for (int k = 0; k < frame->light_count; ++k) {
        const incidence i = incidence_of(s, lights + k);
        const rgb e0 = irradiance(lights + k, i);
        sums = add_light_0(sums, m, s, i, e0);
#if OUTPUT_LIGHTS >= 0
        store_light(out, mine, s, k, reflect_0(m, add_light_0(none, m, s, i, e0)));
#endif
    }
    return reflect_0(m, sums);
}

static inline radiance shade_materials(inputs in, surface s, results out, __constant const FrameConstants* frame,
                                       __global const LightConstants* lights) {
    return shade_material_0(s.alive, in, s, out, frame, lights);
}

static inline radiance add_emission(radiance sum, inputs in, surface s) {
    return sum;
}

#endif
