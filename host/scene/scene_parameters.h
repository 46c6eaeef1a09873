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

/// F0 of a dielectric: ((n-1)/(n+1))^2 of one or three indices of refraction of at least 1 against air, or of channels
/// that hold them (scale and offset apply to the index; no `convert`).
[[nodiscard]] Parameter read_ior(const TomlValue& value);

/// Absorption of a layer: one or three constants of 0 or more, or one or three channels; no conversion.
[[nodiscard]] Parameter read_absorption(const TomlValue& value);

/// A tangent: three constants that are not all 0 (given back with length 1), or the channels of a role or layer; no
/// conversion, scale or offset.
[[nodiscard]] Parameter read_tangent(const TomlValue& value);

} // namespace clshade
