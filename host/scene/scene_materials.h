// [material.*] tables.
#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_value.h"

namespace clshade {

/// Reads the value of the key `material` (may be null: none written) into scene.materials, `default` first, and sets
/// scene.automatic. `default_written`: the file itself has [material.default]; if not, what overrides left alone in it
/// is automatic and an absent lobe is Blinn-Phong or Lambert, not "none".
void read_materials(const TomlEntry* entry, bool default_written, Scene& scene);

} // namespace clshade
