// Presets: materials that a scene takes by name and changes key by key.
#pragma once

#include "host/scene/toml_value.h"

namespace clshade {

/// Replaces the key `preset` of every material by what the preset says (Origin::preset, with the place of the key).
/// Keys written beside it win, table by table:
///   - a list `layer` replaces the preset's layers wholly,
///   - `diffuse` beside a preset of several layers changes the diffuse part of its base,
///   - `specular` beside a preset of several layers is an error: it could mean any of them.
/// Returns whether material.default got one. Throws UsageError for an unknown preset, with a suggestion.
bool expand_presets(TomlTable& root);

} // namespace clshade
