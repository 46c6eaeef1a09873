#include "host/reference/environment.h"

#include "host/reference/picture.h"

namespace clshade::reference {

PreparedEnvironment::PreparedEnvironment(const BoundEnvironment& bound)
    : bound_(&bound),
      map_(bound.image ? environment_map_of(bound.image) : std::make_shared<const EnvironmentMap>(bound.maps)) {}

glm::dvec3 PreparedEnvironment::radiance(const glm::dvec3& direction, double shininess) const {
    return map_->radiance(bound_->world_to_image * direction, shininess) * bound_->intensity;
}

DiffuseLight PreparedEnvironment::diffuse_light(const glm::dvec3& normal, const glm::dvec3& tangent) const {
    const ShRadiance& sh = map_->sh();
    const glm::dvec3 n = bound_->world_to_image * normal;
    DiffuseLight light;
    light.constant = sh_irradiance_band(sh, 0, n);
    light.linear = sh_irradiance_band(sh, 1, n);
    switch (bound_->diffuse) {
    case AmbientSource::sh2:
        break;
    case AmbientSource::sh3:
        light.rest = sh_irradiance_band(sh, 2, n);
        break;
    case AmbientSource::irradiance_map:
        light.rest = map_->irradiance_over_pi(n) - light.constant - light.linear;
        break;
    }
    light.tangent = sh_linear(sh, bound_->world_to_image * tangent);
    for (glm::dvec3* part : {&light.constant, &light.linear, &light.rest, &light.tangent}) {
        *part *= bound_->intensity;
    }
    return light;
}

glm::dvec3 PreparedEnvironment::background(const glm::dvec3& direction) const {
    return radiance_along(*map_->image(), bound_->world_to_image * direction) * bound_->intensity;
}

} // namespace clshade::reference
