// [camera] and [gbuffer].
#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_value.h"

namespace clshade {

/// Reads [camera]. Throws for a matrix that is singular, sheared, scaled, mirrored or not affine, naming which.
[[nodiscard]] Camera read_camera(const TomlEntry& entry);

/// Reads [gbuffer]: role overrides, spaces and kinds.
[[nodiscard]] GBufferSettings read_gbuffer(const TomlEntry& entry);

} // namespace clshade
