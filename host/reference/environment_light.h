// A material under an environment: rule 11 of host/gbuffer/frame.h.
//
// Layers and interfaces as in host/reference/layers.h, at the cosine x = N.E instead of E.H:
//   L_o = sum_k S_k L(R, n_k) prod_{j<k} T_j As_j + albedo D(E/pi) * weight
// T_j = (1 - F_j(x))(1 - r_j), exact: (1 - F_j(x))^2. S_k: Fresnel times AmbientBRDF (split sum). As: section 7.
#pragma once

#include "host/reference/ambient_brdf.h"
#include "host/reference/environment.h"
#include "host/reference/material_values.h"

#include <glm/glm.hpp>

#include <array>

namespace clshade::reference {

/// AmbientBRDF of a layer's lobe.
struct LayerAmbient {
    AmbientBrdf brdf;
    glm::dvec3 metal{0.0}; ///< spectral, met from air: the lobe's integral with the metal's own Fresnel curve
};

/// What multiplies the looked-up light.
struct AmbientWeights {
    std::array<glm::dvec3, most_layers> specular{}; ///< of layer k's L(R, n)
    glm::dvec3 diffuse{1.0};                        ///< of the base's diffuse part
};

/// Radiance towards the eye.
struct EnvironmentLight {
    glm::dvec3 diffuse{0.0};
    glm::dvec3 specular{0.0};
};

/// Exponent that a layer's lobe has for AmbientBRDF: its own, or the mean one of an anisotropic lobe.
[[nodiscard]] double ambient_shininess(const LayerValues& layer);

/// The normaliser that rule 9 has for this lobe.
[[nodiscard]] Normaliser ambient_normaliser(const LayerValues& layer, FresnelModel model);

/// From the tables. x: N.E, 1e-4..1.
[[nodiscard]] LayerAmbient layer_ambient(const LayerValues& layer, FresnelModel model, double x);

/// `ambient`: one per layer. Needs find_interfaces.
[[nodiscard]] AmbientWeights ambient_weights(const MaterialValues& material, double x,
                                             const std::array<LayerAmbient, most_layers>& ambient);

/// What the base's diffuse model makes of E/pi: before albedo and weight, clamped to 0.
[[nodiscard]] glm::dvec3 diffuse_response(const MaterialValues& material, double x, const DiffuseLight& light);

/// Radiance that a layer's lobe gathers: L(R, n), or the sum of an anisotropic lobe's lookups. N and E are unit
/// vectors.
[[nodiscard]] glm::dvec3 gathered_radiance(const LayerValues& layer, const PreparedEnvironment& environment,
                                           const glm::dvec3& normal, const glm::dvec3& eye);

/// All of it.
[[nodiscard]] EnvironmentLight environment_light(const MaterialValues& material, const PreparedEnvironment& environment,
                                                 const glm::dvec3& normal, const glm::dvec3& eye);

} // namespace clshade::reference
