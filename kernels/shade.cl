// The shading kernel: one work-item shades LANES neighbouring pixels. Read from here: load_surface (surface.cl) turns
// planes into a surface, shade_materials (materials.cl) runs the models over the lights, the rest is written below.
#include "frame_layout.h"
#include "types.h"

#include "background.cl"
#include "materials.cl"
#include "parameters.cl"
#include "radiance.cl"
#include "surface.cl"

// planes:  input planes, `plane_stride` floats apart; result: output planes, `result_stride` floats apart.
// first_pixel: index of the first pixel of these planes in the whole picture (a band starts later).
// counts: COUNT_SIZE counters, see types.h. maps, ambient, picture: see environment.cl.
__kernel void shade(__global const float* planes, ulong plane_stride, __global float* result, ulong result_stride,
                    ulong first_pixel, __constant const FrameConstants* frame, __global const LightConstants* lights,
                    __global uint* counts
#if HAS_ENVIRONMENT
                    ,
                    __constant const EnvironmentConstants* environment_constants, __global const float* maps,
                    __global const float* ambient, __global const float* picture
#endif
) {
    const ulong pixel = (ulong)get_global_id(0) * LANES;
    const inputs in = {planes, plane_stride, pixel};
    const results out = {result, result_stride, pixel};

    const surface s = load_surface(in, first_pixel, frame);
#if HAS_ENVIRONMENT
    const environment around = {environment_constants, maps, ambient, picture};
    const radiance lit = shade_materials(in, s, out, frame, lights, around);
#else
    const radiance lit = shade_materials(in, s, out, frame, lights);
#endif
    const radiance sum = add_emission(lit, in, s);

    const rgb total = scale_rgb(sum.total, s.coverage);
    mask overflown = s.alive & negated(is_finite_rgb(total));
    mask good = s.alive & negated(overflown);
    rgb colour = choose_rgb(good, total, grey(splat(0.0f)));
    real alpha = choose(good, s.coverage, splat(0.0f));
#if HAS_BACKGROUND
    const mask open = (alpha < splat(1.0f)) & negated(s.nonfinite | overflown);
    if (any_lane(open)) {
        const rgb seen = behind(around, ray_of(first_pixel + pixel, frame));
        const rgb over = multiply_add_rgb(grey(1.0f - alpha), seen, colour);
        const mask shown = open & is_finite_rgb(over);
        overflown |= open & negated(shown);
        good &= negated(overflown);
        colour = choose_rgb(shown, over, choose_rgb(overflown, grey(splat(0.0f)), colour));
        alpha = choose(shown, splat(1.0f), choose(overflown, splat(0.0f), alpha));
    }
#endif
    store_rgb(out, 0, colour);
    store_plane(result, result_stride, 3, pixel, alpha);
#if OUTPUT_DIFFUSE >= 0
    store_rgb(out, OUTPUT_DIFFUSE, deliver(sum.diffuse, s, good));
#endif
#if OUTPUT_SPECULAR >= 0
    store_rgb(out, OUTPUT_SPECULAR, deliver(sum.specular, s, good));
#endif
#if OUTPUT_ENVIRONMENT >= 0
    store_rgb(out, OUTPUT_ENVIRONMENT, deliver(sum.environment, s, good));
#endif

    const mask nonfinite = s.nonfinite | overflown;
    const mask clamped = s.alive & sum.clamped;
    const mask fractional = s.alive & sum.fractional_id;
    const mask no_tangent = s.alive & sum.no_tangent;
    if (any_lane(nonfinite | clamped | fractional | no_tangent)) {
#if OUTPUT_LIGHTS >= 0
        for (int k = 0; k < frame->light_count; ++k) {
            clear_light(out, k, nonfinite);
        }
#endif
        atomic_add(counts + COUNT_NONFINITE, count_lanes(nonfinite));
        atomic_add(counts + COUNT_CLAMPED, count_lanes(clamped));
        atomic_add(counts + COUNT_FRACTIONAL_IDS, count_lanes(fractional));
        atomic_add(counts + COUNT_NO_TANGENT, count_lanes(no_tangent));
    }
}
