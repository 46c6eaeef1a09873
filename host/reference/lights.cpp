#include "host/reference/lights.h"

#include <algorithm>
#include <cmath>

namespace clshade::reference {

double cone_share(const Light& light, const glm::dvec3& to_light) {
    if (light.type != LightType::spot) {
        return 1.0;
    }
    const glm::dvec3 axis = glm::normalize(light.direction);
    const double angle = std::atan2(glm::length(glm::cross(axis, -to_light)), glm::dot(axis, -to_light));
    if (angle > light.cone_angle) {
        return 0.0;
    }
    const double soft = light.cone_angle * light.cone_softness;
    if (soft <= 0.0) {
        return 1.0;
    }
    // Smoothstep over the angle, 1 inside cone_angle (1 - softness), 0 at cone_angle.
    const double t = std::clamp((light.cone_angle - angle) / soft, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

Incident incident_light(const Light& light, const std::optional<glm::dvec3>& position) {
    Incident incident;
    if (light.type == LightType::distant) {
        incident.direction = -glm::normalize(light.direction);
        incident.irradiance = light.power;
        return incident;
    }
    if (!position) {
        return incident;
    }
    const glm::dvec3 path = light.position - *position;
    const double distance2 = glm::dot(path, path);
    if (!(distance2 > 0.0) || std::isinf(distance2)) {
        return incident;
    }
    incident.direction = path / std::sqrt(distance2);
    incident.irradiance = light.power / distance2 * cone_share(light, incident.direction);
    return incident;
}

} // namespace clshade::reference
