// Finds where a ray meets the stage, by sphere tracing.
#pragma once

#include "host/demo/demo_stage.h"

#include <glm/glm.hpp>

namespace clshade::demo {

struct Hit {
    const Object* object = nullptr; ///< null: the ray misses everything
    float distance = 0.0F;          ///< along the ray
    glm::vec3 point{0.0F};
    glm::vec3 normal{0.0F};
};

/// The nearest surface along a ray; `direction` has length 1.
[[nodiscard]] Hit trace(const Stage& stage, glm::vec3 origin, glm::vec3 direction);

} // namespace clshade::demo
