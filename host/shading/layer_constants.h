// What the generator works out on the host where a material's parameters are constants: the formulas of the kernels, in
// double precision, per channel.
#pragma once

#include <glm/glm.hpp>

namespace clshade {

/// (n+2) / (4 pi (2 - 2^(-n/2))) (models.md section 1).
[[nodiscard]] double folded_normaliser_exact(double n);
/// 0.0397436 n + 0.0856832 (models.md section 2).
[[nodiscard]] double folded_normaliser_linear(double n);
/// sqrt(a b) / (8 pi (1 - w)) (models.md section 3).
[[nodiscard]] double folded_normaliser_anisotropic(double n_u, double n_v);

/// Amplitude (n-1)/(n+1) of an index of refraction with the given F0 in air: sqrt(F0).
[[nodiscard]] glm::dvec3 amplitude_of(const glm::dvec3& f0);
/// Index of refraction of an amplitude, (1+s)/(1-s); at most 1e12.
[[nodiscard]] glm::dvec3 index_of(const glm::dvec3& amplitude);
/// Medium below a layer: the layer's own, or the one above where its amplitude is 0 (pixel rule 9).
[[nodiscard]] glm::dvec3 folded_medium(const glm::dvec3& amplitude, const glm::dvec3& above);
/// F0(n2/n1) of two amplitudes (models.md section 5).
[[nodiscard]] glm::dvec3 folded_reflectance(const glm::dvec3& above, const glm::dvec3& below);
/// 1 - r where light meets the interface in air (`above` is 0) and there is one, else 0.
[[nodiscard]] glm::dvec3 folded_gain(const glm::dvec3& r, const glm::dvec3& amplitude, const glm::dvec3& above,
                                     bool is_base);

/// a' = (1 - exp(-2 alpha d))/2 of alpha d (models.md section 5).
[[nodiscard]] glm::dvec3 folded_approximate_absorption(const glm::dvec3& depth);
/// 2 E_3(a'): what an absorbing layer leaves of diffuse light on its way down (models.md section 7).
[[nodiscard]] glm::dvec3 folded_diffuse_transmittance(const glm::dvec3& absorption);

} // namespace clshade
