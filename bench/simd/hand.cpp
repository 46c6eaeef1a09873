// Hand-vectorised: one vector of pixels at a time, a run-time loop over the lights in registers, streamed stores.
// models.md section 2 (approximated Blinn-Phong) with Lambert, in the form that needs least arithmetic:
//   E.H = sqrt((1 + E.L) / 2), N.H = (N.L + N.E) / sqrt(2 (1 + E.L))      (section 0, three-dot form)
//   N.H^n = 2^(n/2 log2 N.H^2),  N.L / max(N.L, N.E) = min(1, N.L / N.E)
// F_spec = F0 + (1 - F0) G is linear in F0, so the loop sums the weights of F0 and of 1 - F0 apart.
#include "bench/simd/kernel_set.h"
#include "bench/simd/lanes.h"

namespace clshade::rivals {

namespace {

/// Floats ahead: more streams than the hardware follows on its own; 64 to 256 do equally well.
constexpr size_t prefetch_distance = 128;

/// WithAlpha is a constant so that the loop over the pixels has no branch.
template <bool WithAlpha>
void shade(const Planes& planes, const Scene& scene, size_t begin, size_t end) {
    const size_t stride = planes.in_stride;
    const Real eye[3] = {splat(scene.eye[0]), splat(scene.eye[1]), splat(scene.eye[2])};
    const Real one = splat(1.0F);
    const Real zero = splat(0.0F);
    constexpr float one_over_pi = 0.318309886F;

    for (size_t i = begin; i < end; i += lane_count) {
        const float* in = planes.in + i;
        for (int p = 0; p < 13; ++p) { // measured: 10 to 15 % at one light
            __builtin_prefetch(in + p * stride + prefetch_distance);
        }
        Real normal[3] = {load(in), load(in + stride), load(in + 2 * stride)};
        const Real squared = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
        const Real scale = over_sqrt(1.0F, maximum(squared, splat(1e-12F)));
        const Whole surface = squared >= 1e-12F;
        Real to_eye[3] = {eye[0] - load(in + 3 * stride), eye[1] - load(in + 4 * stride),
                          eye[2] - load(in + 5 * stride)};
        const Real eye_scale = over_sqrt(1.0F, to_eye[0] * to_eye[0] + to_eye[1] * to_eye[1] + to_eye[2] * to_eye[2]);
        for (int c = 0; c < 3; ++c) {
            normal[c] *= scale;
            to_eye[c] *= eye_scale;
        }
        const Real raw_ne = normal[0] * to_eye[0] + normal[1] * to_eye[1] + normal[2] * to_eye[2];
        const Real ne = maximum(raw_ne, splat(1e-4F));
        const Real one_over_ne = reciprocal(ne);
        const Real n = load(in + 12 * stride);
        const Real half_n = 0.5F * n;

        Real diffuse[3] = {zero, zero, zero};  // sum of N.L E_0
        Real specular[3] = {zero, zero, zero}; // sum of lobe E_0
        Real fresnel[3] = {zero, zero, zero};  // sum of lobe G E_0
        for (int k = 0; k < scene.light_count; ++k) {
            const DistantLight& light = scene.lights[k];
            const Real nl = maximum(
                normal[0] * light.to_light[0] + normal[1] * light.to_light[1] + normal[2] * light.to_light[2], zero);
            const Real half_squared = maximum(to_eye[0] * light.to_light[0] + (to_eye[1] * light.to_light[1] +
                                                                               (to_eye[2] * light.to_light[2] + 1.0F)),
                                              splat(5e-8F));      // 1 + E.L
            const Real r = over_sqrt(0.707106781F, half_squared); // 1 / |L + E|
            const Real eh = half_squared * r;
            const Real nh = maximum((nl + raw_ne) * r, splat(1e-6F));
            const Real exponent = maximum(half_n * log2_lanes(nh * nh), splat(-60.0F));
            const Real lobe = exp2_lanes(exponent) * minimum(one, nl * one_over_ne);
            const Real weighted = lobe * exp2_lanes((-5.55473F * eh - 6.98316F) * eh);
            for (int c = 0; c < 3; ++c) {
                diffuse[c] += nl * light.irradiance[c];
                specular[c] += lobe * light.irradiance[c];
                fresnel[c] += weighted * light.irradiance[c];
            }
        }

        const Real normaliser = 0.0397436F * n + 0.0856832F;
        float* out = planes.out + i;
        for (int c = 0; c < 3; ++c) {
            const Real f0 = load(in + (9 + c) * stride);
            const Real albedo = load(in + (6 + c) * stride);
            const Real weight = one - f0;
            const Real radiance =
                weight * (one_over_pi * albedo * diffuse[c] + normaliser * fresnel[c]) + normaliser * f0 * specular[c];
            stream(out + c * planes.out_stride, surface ? radiance : zero);
        }
        if constexpr (WithAlpha) {
            stream(out + 3 * planes.out_stride, surface ? one : zero);
        }
    }
    finish_streams();
}

} // namespace

void CLSHADE_RIVALS(hand_simd)(const Planes& planes, const Scene& scene, size_t begin, size_t end) {
    (planes.planes_out > 3 ? shade<true> : shade<false>)(planes, scene, begin, end);
}

} // namespace clshade::rivals
