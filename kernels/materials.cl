// What a pixel's material does with the lights. The host writes this file anew for every structure of scene
// (host/shading/generated_source.cpp); this default is what it writes for one Blinn-Phong + Lambert material whose
// parameters all come from planes.
#ifndef CLSHADE_MATERIALS_CL
#define CLSHADE_MATERIALS_CL

#include "blinn_phong.cl"
#include "diffuse.cl"
#include "parameters.cl"
#include "radiance.cl"

// Material 0, "default": blinn_phong over lambert.
static inline radiance shade_material_0(inputs in, surface s, mask mine, results out,
                                        __constant const MaterialConstants* m, __global const LightConstants* lights,
                                        int light_count) {
    const rgb raw_f0 = make_rgb(load_input(in, 9), load_input(in, 10), load_input(in, 11));
    const rgb f0 = clamp_unit_rgb(raw_f0);
    const real shininess = clamp_shininess(load_input(in, 12));
    const rgb raw_albedo = make_rgb(load_input(in, 6), load_input(in, 7), load_input(in, 8));
    const rgb albedo = clamp_unit_rgb(raw_albedo);
    const real half_shininess = 0.5f * shininess;
    const rgb colour = scale_rgb(multiply_rgb(albedo, complement(f0)), INV_PI_F);

    light_sums sums = no_light();
    for (int k = 0; k < light_count; ++k) {
        const incidence i = incidence_of(s, lights + k);
        const rgb e0 = irradiance(lights + k, i);
        const real diffuse = lambert(i);
        const real specular = blinn_phong(i, half_shininess);
        const real weighted = specular * schlick_weight_gaussian(i);
        sums.diffuse = add_share(sums.diffuse, e0, diffuse);
        sums.specular = add_share(sums.specular, e0, specular);
        sums.weighted = add_share(sums.weighted, e0, weighted);
#if OUTPUT_LIGHTS >= 0
        light_sums own = no_light();
        own.diffuse = add_share(own.diffuse, e0, diffuse);
        own.specular = add_share(own.specular, e0, specular);
        own.weighted = add_share(own.weighted, e0, weighted);
        store_light(out, mine, s, k, reflect(own, colour, albedo, f0, normaliser_linear(shininess)));
#endif
    }
    radiance sum = reflect(sums, colour, albedo, f0, normaliser_linear(shininess));
    sum.clamped = outside_unit(raw_f0) | outside_unit(raw_albedo);
    return sum;
}

static inline radiance shade_materials(inputs in, surface s, results out, __constant const MaterialConstants* materials,
                                       __global const LightConstants* lights, int light_count) {
    return shade_material_0(in, s, s.alive, out, materials, lights, light_count);
}

static inline radiance add_emission(radiance sum, inputs in, surface s, __constant const ParameterConstants* p) {
    return sum; // no emission plane
}

#endif
