// [[light]] tables.
#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_value.h"

#include <vector>

namespace clshade {

/// Reads the value of the key `light`. Lights without a name are called "light1", "light2", ... by their place.
[[nodiscard]] std::vector<Light> read_lights(const TomlValue& value);

} // namespace clshade
