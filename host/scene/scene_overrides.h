// --set and --model: changes to the TOML tree before anything is validated.
#pragma once

#include "host/scene/toml_value.h"

#include <string>
#include <string_view>

namespace clshade {

/// Applies "a.b.c=value". The value is TOML; a bare word is a string. Tables on the way are created; lists are entered
/// by index from 0, lists of tables also by the `name` of an element. The diffuse part of a material written as layers
/// is that of its base; its specular lobe is asked for by layer if there are several. The value's place is
/// "--set a.b.c=value". Throws UsageError for a malformed assignment or a path that leads through something else.
void apply_override(TomlTable& root, const std::string& assignment);

/// Whether the assignment is "material.NAME.preset=...". Throws UsageError for a malformed assignment.
[[nodiscard]] bool chooses_preset(const std::string& assignment);

/// Sets the specular or diffuse model of material.default. Throws UsageError for an unknown name (with a suggestion),
/// and for a specular model if the material has several layers.
void apply_model(TomlTable& root, std::string_view model);

} // namespace clshade
