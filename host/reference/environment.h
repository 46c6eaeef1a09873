// A frame's environment in world space, with its intensity (rules 11 and 12 of host/gbuffer/frame.h).
#pragma once

#include "host/gbuffer/frame.h"
#include "host/reference/environment_map.h"

#include <glm/glm.hpp>

#include <memory>

namespace clshade::reference {

/// E/pi of a normal, in parts: what Oren-Nayar weighs one by one. Times intensity.
struct DiffuseLight {
    glm::dvec3 constant{0.0}; ///< e0
    glm::dvec3 linear{0.0};   ///< e1
    glm::dvec3 rest{0.0};     ///< e - e0 - e1
    glm::dvec3 tangent{0.0};  ///< t.v

    [[nodiscard]] glm::dvec3 all() const { return constant + linear + rest; }
};

class PreparedEnvironment {
  public:
    /// Refers to it.
    explicit PreparedEnvironment(const BoundEnvironment& bound);

    /// L(R, n); R of any length.
    [[nodiscard]] glm::dvec3 radiance(const glm::dvec3& direction, double shininess) const;
    /// N unit; t is the unit vector of rule 11, or 0.
    [[nodiscard]] DiffuseLight diffuse_light(const glm::dvec3& normal, const glm::dvec3& tangent) const;
    /// Rule 12: L(d). There must be a picture.
    [[nodiscard]] glm::dvec3 background(const glm::dvec3& direction) const;
    /// Mean radiance.
    [[nodiscard]] glm::dvec3 mean() const { return map_->mean() * bound_->intensity; }

    [[nodiscard]] const BoundEnvironment& bound() const { return *bound_; }
    [[nodiscard]] const EnvironmentMap& map() const { return *map_; }

  private:
    const BoundEnvironment* bound_;
    std::shared_ptr<const EnvironmentMap> map_;
};

} // namespace clshade::reference
