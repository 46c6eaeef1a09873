// Anisotropic Blinn-Phong (models.md section 3).
#pragma once

#include "host/reference/angles.h"

#include <glm/glm.hpp>

namespace clshade::reference {

/// Orthonormal tangents of a surface.
struct TangentFrame {
    glm::dvec3 tangent{0.0};   ///< T
    glm::dvec3 bitangent{0.0}; ///< B = N x T
    bool missing = false;      ///< nothing usable was given: T comes from N alone
};

/// Rule 6 of host/gbuffer/frame.h: t of any length, made perpendicular to the unit normal. Where t is shorter than 1e-6
/// or parallel to N (|t - (t.N) N| < 1e-4 |t|), the frame of Duff et al. ("Building an Orthonormal Basis, Revisited",
/// JCGT 2017).
[[nodiscard]] TangentFrame tangent_frame(const glm::dvec3& t, const glm::dvec3& normal);

/// e = (n_u (T.H)^2 + n_v (B.H)^2) / max((T.H)^2 + (B.H)^2, 1e-12); (n_u + n_v)/2 where 1 - (N.H)^2 < 1e-12.
[[nodiscard]] double anisotropic_exponent(const Angles& angles, const TangentFrame& frame, double n_u, double n_v);

/// Normaliser in closed form; that of section 1 for n_u = n_v. Both >= 0.
[[nodiscard]] double normaliser_anisotropic(double n_u, double n_v);

/// Normaliser of the cheap form: the linear one of section 2 for the exponent sqrt((n_u + 2)(n_v + 2)) - 2. No model
/// uses it; the vectors of section 3 have it.
[[nodiscard]] double normaliser_anisotropic_cheap(double n_u, double n_v);

/// Norm(n_u, n_v) (N.H)^e N.L / max(N.L, N.E): the specular f_cos for F = 1. Needs N.L > 0.
[[nodiscard]] double anisotropic_f_cos(const Angles& angles, const TangentFrame& frame, double n_u, double n_v);

/// Specular f_cos: Norm(n_u, n_v) F(F0, E.H) (N.H)^e N.L / max(N.L, N.E) with Schlick's F. Needs N.L > 0.
[[nodiscard]] glm::dvec3 blinn_phong_anisotropic(const Angles& angles, const TangentFrame& frame, const glm::dvec3& f0,
                                                 double n_u, double n_v);

} // namespace clshade::reference
