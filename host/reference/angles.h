// The cosines that every model is written in, for one light at one pixel.
#pragma once

#include <glm/glm.hpp>

namespace clshade::reference {

/// Names as in models.md section 0; clamped as rule 8 of host/gbuffer/frame.h says.
struct Angles {
    double nl = 0.0;      ///< N.L; there is light only where it is > 0
    double ne = 0.0;      ///< max(N.E, 1e-4)
    double el = 0.0;      ///< E.L
    double eh = 0.0;      ///< E.H, 0..1
    double nh = 0.0;      ///< N.H, above 0
    double sin2_nh = 1.0; ///< |N x H|^2 = 1 - (N.H)^2 without its cancellation; means nothing where nh was raised
    glm::dvec3 half{0.0}; ///< H; shorter than 1 where L and E nearly cancel
    double gamma = 0.0;   ///< E.L - N.E N.L: dot product of the tangential parts of L and E
};

/// All arguments are unit vectors.
[[nodiscard]] Angles angles_between(const glm::dvec3& normal, const glm::dvec3& eye, const glm::dvec3& light);

} // namespace clshade::reference
