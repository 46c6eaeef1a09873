// A stack of layers under one light (models.md section 5, rule 9 of host/gbuffer/frame.h).
//
// Layers k = 0 (top) to K-1 (base); section 5 has K = 2. N, L, E and H are the same for all of them; c = E.H. Medium k
// lies under interface k and has the index m_k against air, m_{-1} = 1. Everything holds per channel.
//
//   n_k = (1 + sqrt f0)/(1 - sqrt f0) from f0 measured in air (a metal's: its reflectance R_k(1) in air)
//   No interface: lobe `none`, or f0 = 0 above the base. F_k = r_k = 0, m_k = m_{k-1}. Else m_k = n_k.
//   r_k = ((m_k - m_{k-1})/(m_k + m_{k-1}))^2, a metal's: its R at normal incidence against m_{k-1}
//   outer: met from air, m_{k-1} = 1.
//
// fresnel = constant. F_k = Schlick(r_k, c) where outer (blinn_phong: the Gaussian form; a metal: R_k(c)), else r_k.
//   f_k     = Norm_k NH^n_k F_k / max(NL, NE) * prod_{j<k} (1 - F_j)(1 - r_j) * prod_{j<k} A_j
//   f_d     = diffuse * prod_{j<K-1} (outer: 1 - F_j; else 1 - r_j U_j) * (1 - r_{K-1} U_{K-1}) * prod_{j<K-1} A_j
//   U_k     = prod_{j<k} (1 - r_j)
// With K = 2: F_transmittance = 1 - F_0, F_b = r_1 (1 - r_0); f_bs has F_transmittance F_b, f_bd F_transmittance
// (1 - F_b). A base that is outer and blinn_phong_exact weighs its diffuse part with 1 - Schlick(r, N.L) (section 1).
// fresnel = exact. F_k = the dielectric or conductor formula, m_k against m_{k-1}, at the cosine inside the medium
// above,
//   c_{k-1} = sqrt(1 - (1 - c^2)/m_{k-1}^2).
//   f_k     = Norm_k NH^n_k F_k / max(NL, NE) * prod_{j<k} (1 - F_j)^2 * prod_{j<k} A_j
//   f_d     = diffuse * (1 - F_{K-1}) * prod_{j<K-1} (1 - F_j)^2 * prod_{j<K-1} A_j
//   (light enters and leaves through interface j at the same angle pair: F(n; c) = F(1/n; c'))
// Norm_k: linear for blinn_phong and blinn_phong_spectral (exact mode: exact); exact for blinn_phong_exact; the closed
//   form of section 3 for blinn_phong_anisotropic.
// A_j: host/reference/absorption.h with layer j's absorption; `original` refracts by m_j.
//
// Limits.
//   K = 1: sections 1 to 4. K = 2: section 5.
//   n_k = 1 (f0 = 0) without absorption above the base, wherever it stands: every factor of layer k is exactly 1 and
//     its term exactly 0. The picture is that of the stack without it, to the bit.
//   m_k = m_{k-1}: r_k = 0. The layer reflects nothing, and the stack is that without it (not outer; no absorption).
//   absorption -> 0: A -> 1, `none`. m_j = 1: `original` is the unrefracted exponential.
//   c = 1: exact and constant agree in every specular factor, (1 - F_j)^2 = (1 - F_j)(1 - r_j) = (1 - r_j)^2 (but for
//     the weight 1.7e-4 of the Gaussian form at c = 1).
//   m_{k-1} > m_k: total internal reflection needs (1 - c^2) > m_k^2. All m_k are at least 1, so no light that came
//   from
//     air meets it; the formula itself gives F = 1 there.
//   f0 = 1: m_k is infinite, F_k = 1, and nothing below is seen.
// Energy. At one direction, without absorption, the shares add up to at most 1:
//   exact: F_0 + (1 - F_0)^2 (F_1 + ...) <= F_0 + (1 - F_0)(F_1 + ...) <= 1.
//   constant, below the outer interface: with V_k = prod_{j<k} (1 - r_j U_j), U_j <= 1 gives prod (1 - r_j) <= V_k, so
//     the share of f_k is at most r_k U_k V_k = V_k - V_{k+1}; summed up with f_d's V_K that is at most 1.
#pragma once

#include "host/reference/angles.h"
#include "host/reference/material_values.h"

#include <glm/glm.hpp>

#include <array>

namespace clshade::reference {

/// Fills every layer's `interface` from lobes, f0, index and metal.
void find_interfaces(MaterialValues& material);

/// F_k at c = E.H; 0 where there is no interface.
[[nodiscard]] glm::dvec3 interface_fresnel(const LayerValues& layer, FresnelModel model, double eh);

/// Norm_k NH^n N.L / max(N.L, N.E): f_cos of a layer's lobe for F = 1; 0 for lobe `none`.
[[nodiscard]] double lobe_f_cos(const LayerValues& layer, FresnelModel model, const Angles& angles);

/// A of a layer's medium.
[[nodiscard]] glm::dvec3 layer_absorption(const LayerValues& layer, AbsorptionModel model, const Angles& angles);

/// What interfaces and media leave of every part.
struct StackWeights {
    std::array<glm::dvec3, most_layers> specular{}; ///< of layer k's lobe: F_k, the interfaces above and prod A_j
    glm::dvec3 diffuse{1.0};                        ///< of the base's diffuse part
};
/// Needs find_interfaces and N.L > 0.
[[nodiscard]] StackWeights stack_weights(const MaterialValues& material, const Angles& angles);

} // namespace clshade::reference
