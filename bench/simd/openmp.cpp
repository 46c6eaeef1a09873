// The compiler's own vectorisation of a plain loop (OpenMP simd, relaxed floating point), one distant light: what gcc
// makes of the one-light kernel when its author writes no vector code but knows to replace the power.
#include "bench/simd/kernel_set.h"
#include "bench/simd/powers.h"
#include "bench/simd/rivals.h"

namespace clshade::rivals {

namespace {

/// models.md sections 0 and 2, three-dot form as in hand.cpp. WithAlpha is a constant so that the loop has no branch.
template <bool WithAlpha>
void shade_one_light(const Planes& planes, const Scene& scene, size_t begin, size_t end) {
    const float* const in = planes.in;
    const size_t s = planes.in_stride;
    float* const out_r = planes.out;
    float* const out_g = planes.out + planes.out_stride;
    float* const out_b = planes.out + 2 * planes.out_stride;
    float* const out_a = WithAlpha ? planes.out + 3 * planes.out_stride : nullptr;
    const DistantLight light = scene.lights[0];
    const float lx = light.to_light[0], ly = light.to_light[1], lz = light.to_light[2];
    const float er = light.irradiance[0], eg = light.irradiance[1], eb = light.irradiance[2];
    const float eye_x = scene.eye[0], eye_y = scene.eye[1], eye_z = scene.eye[2];
    constexpr float one_over_pi = 0.318309886F;

#pragma omp simd
    for (size_t i = begin; i < end; ++i) {
        const float nx = in[i], ny = in[i + s], nz = in[i + 2 * s];
        const float squared = nx * nx + ny * ny + nz * nz;
        const float scale = 1.0F / __builtin_sqrtf(larger(squared, 1e-12F));
        const float surface = squared >= 1e-12F ? 1.0F : 0.0F;
        const float ex = eye_x - in[i + 3 * s], ey = eye_y - in[i + 4 * s], ez = eye_z - in[i + 5 * s];
        const float eye_scale = 1.0F / __builtin_sqrtf(ex * ex + ey * ey + ez * ez);
        const float raw_ne = (nx * ex + ny * ey + nz * ez) * scale * eye_scale;
        const float ne = larger(raw_ne, 1e-4F);
        const float nl = larger((nx * lx + ny * ly + nz * lz) * scale, 0.0F);
        const float el = (ex * lx + ey * ly + ez * lz) * eye_scale;
        const float squared_sum = larger(2.0F + 2.0F * el, 1e-7F);
        const float r = 1.0F / __builtin_sqrtf(squared_sum);
        const float eh = 0.5F * squared_sum * r;
        const float nh = smaller((nl + raw_ne) * r, 1.0F);
        const float n = in[i + 12 * s];
        const float power = power_of_two(larger(0.5F * n * log_to_two(larger(nh * nh, 1e-12F)), -60.0F));
        const float lobe = (0.0397436F * n + 0.0856832F) * power * (nl / larger(nl, ne)) * surface;
        const float gauss = power_of_two((-5.55473F * eh - 6.98316F) * eh);
        const float lambert = one_over_pi * nl * surface;
        const float f0_r = in[i + 9 * s], f0_g = in[i + 10 * s], f0_b = in[i + 11 * s];
        out_r[i] = er * ((1.0F - f0_r) * (in[i + 6 * s] * lambert + lobe * gauss) + f0_r * lobe);
        out_g[i] = eg * ((1.0F - f0_g) * (in[i + 7 * s] * lambert + lobe * gauss) + f0_g * lobe);
        out_b[i] = eb * ((1.0F - f0_b) * (in[i + 8 * s] * lambert + lobe * gauss) + f0_b * lobe);
        if constexpr (WithAlpha) {
            out_a[i] = surface;
        }
    }
}

} // namespace

void CLSHADE_RIVALS(openmp_simd)(const Planes& planes, const Scene& scene, size_t begin, size_t end) {
    (planes.planes_out > 3 ? shade_one_light<true> : shade_one_light<false>)(planes, scene, begin, end);
}

} // namespace clshade::rivals
