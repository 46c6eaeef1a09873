// Material parameters: a number, three numbers, a role or layer name, or { channel, convert, scale, offset }.
#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_value.h"

#include <string_view>

namespace clshade {

/// A reflectance: one or three constants from 0 to 1, or one or three channels; no conversion.
[[nodiscard]] Parameter read_reflectance(const TomlValue& value, std::string_view key);

/// A shininess: a constant from 0 to 65536 or one channel with any conversion.
[[nodiscard]] Parameter read_shininess(const TomlValue& value, std::string_view key);

/// F0 of a dielectric: ((n-1)/(n+1))^2 for an index of refraction of at least 1, one or three numbers.
[[nodiscard]] Parameter read_ior(const TomlValue& value);

} // namespace clshade
