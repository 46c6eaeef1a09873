// Lights as a pixel sees them (rule 8 of host/gbuffer/frame.h).
#pragma once

#include "host/scene/scene.h"

#include <glm/glm.hpp>

#include <optional>

namespace clshade::reference {

/// Light arriving at a point. Zero irradiance: no light, and the direction means nothing.
struct Incident {
    glm::dvec3 direction{0.0, 0.0, 1.0}; ///< L: unit, from the point to the light
    glm::dvec3 irradiance{0.0};          ///< E_0 on a surface facing the light
};

/// A point or spot light gives nothing where the position is unknown or not finite, or is the light's own.
[[nodiscard]] Incident incident_light(const Light& light, const std::optional<glm::dvec3>& position);

/// Share of a light's power that goes along -L: 1, or the cone of a spot light.
[[nodiscard]] double cone_share(const Light& light, const glm::dvec3& to_light);

} // namespace clshade::reference
