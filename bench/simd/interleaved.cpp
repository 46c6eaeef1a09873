// One distant light over pixels as OpenImageIO hands them out: all channels of a pixel next to each other. A plain loop
// that the compiler vectorises, as openmp.cpp.
#include "bench/simd/kernel_set.h"
#include "bench/simd/powers.h"
#include "bench/simd/rivals.h"

namespace clshade::rivals {

/// models.md sections 0 and 2, pixel rules of frame.h: sky, coverage, n = 2/r^4 - 2.
void CLSHADE_RIVALS(interleaved)(const float* pixels, const Interleaved& layout, const Scene& scene, float* out,
                                 size_t count) {
    const size_t channels = layout.channels;
    const size_t* const at = layout.offset;
    const DistantLight light = scene.lights[0];
    const float lx = light.to_light[0], ly = light.to_light[1], lz = light.to_light[2];
    const float er = light.irradiance[0], eg = light.irradiance[1], eb = light.irradiance[2];
    const float eye_x = scene.eye[0], eye_y = scene.eye[1], eye_z = scene.eye[2];
    constexpr float one_over_pi = 0.318309886F;

#pragma omp simd
    for (size_t i = 0; i < count; ++i) {
        const float* const in = pixels + i * channels;
        const float coverage = smaller(larger(in[at[13]], 0.0F), 1.0F);
        const float share = 1.0F / larger(coverage, 1e-12F); // planes are averages over the pixel
        const float nx = in[at[0]], ny = in[at[1]], nz = in[at[2]];
        const float squared = nx * nx + ny * ny + nz * nz;
        const float scale = 1.0F / __builtin_sqrtf(larger(squared, 1e-12F));
        const float surface = squared >= 1e-12F ? coverage : 0.0F;
        const float ex = eye_x - in[at[3]], ey = eye_y - in[at[4]], ez = eye_z - in[at[5]];
        const float eye_scale = 1.0F / __builtin_sqrtf(ex * ex + ey * ey + ez * ez);
        const float raw_ne = (nx * ex + ny * ey + nz * ez) * scale * eye_scale;
        const float ne = larger(raw_ne, 1e-4F);
        const float nl = larger((nx * lx + ny * ly + nz * lz) * scale, 0.0F);
        const float el = (ex * lx + ey * ly + ez * lz) * eye_scale;
        const float squared_sum = larger(2.0F + 2.0F * el, 1e-7F);
        const float r = 1.0F / __builtin_sqrtf(squared_sum);
        const float eh = 0.5F * squared_sum * r;
        const float nh = smaller((nl + raw_ne) * r, 1.0F);
        const float roughness = larger(in[at[12]] * share, 1e-3F);
        const float squared_roughness = roughness * roughness;
        const float n = smaller(larger(2.0F / (squared_roughness * squared_roughness) - 2.0F, 0.0F), 65536.0F);
        const float power = power_of_two(larger(0.5F * n * log_to_two(larger(nh * nh, 1e-12F)), -60.0F));
        const float lobe = (0.0397436F * n + 0.0856832F) * power * (nl / larger(nl, ne)) * surface;
        const float gauss = power_of_two((-5.55473F * eh - 6.98316F) * eh);
        const float lambert = one_over_pi * nl * surface * share;
        const float f0_r = in[at[9]] * share, f0_g = in[at[10]] * share, f0_b = in[at[11]] * share;
        float* const pixel = out + 4 * i;
        pixel[0] = er * ((1.0F - f0_r) * (in[at[6]] * lambert + lobe * gauss) + f0_r * lobe);
        pixel[1] = eg * ((1.0F - f0_g) * (in[at[7]] * lambert + lobe * gauss) + f0_g * lobe);
        pixel[2] = eb * ((1.0F - f0_b) * (in[at[8]] * lambert + lobe * gauss) + f0_b * lobe);
        pixel[3] = surface;
    }
}

} // namespace clshade::rivals
