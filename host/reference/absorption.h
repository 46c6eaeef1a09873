// What a layer's medium takes from the light that passes it twice (models.md section 5).
#pragma once

#include <glm/glm.hpp>

namespace clshade::reference {

/// A = max(0, 1 - a' (1/NL + 1/NE)); a' >= 0 per channel; NL, NE > 0.
[[nodiscard]] glm::dvec3 absorption_approximated(const glm::dvec3& a, double nl, double ne);

/// A = exp(-alpha d (1/NL' + 1/NE')), NL' = sqrt(1 - (1 - NL^2)/m^2), NE' likewise: the cosines inside a medium of
/// index m >= 1. m = 1: the unrefracted exponential.
[[nodiscard]] glm::dvec3 absorption_original(const glm::dvec3& alpha_d, const glm::dvec3& m, double nl, double ne);

} // namespace clshade::reference
