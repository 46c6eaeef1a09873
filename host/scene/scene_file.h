// Reading scenes: TOML text to Scene, with the place of every mistake.
#pragma once

#include "host/scene/scene.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace clshade {

/// Reads and validates a scene. `overrides` are "--set" assignments such as
/// "material.default.specular.shininess=32", applied to the TOML tree before validation so that they obey the same
/// rules; `model` (may be empty) is the argument of --model, short for the specular or diffuse model of `default`.
/// Throws UsageError "FILE:LINE:COL: ..." for syntax, unknown keys (with a suggestion), wrong types, values out of
/// range, NaN, duplicate ids, a singular camera, and for names of models, presets and sections that are not built yet;
/// RuntimeFailure if the file cannot be read.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides,
                               std::string_view model);

/// The same for text in memory; `file` only names it in messages.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& file, std::span<const std::string> overrides,
                                std::string_view model);

/// The default scene with overrides (no --scene given).
[[nodiscard]] Scene default_scene(std::span<const std::string> overrides, std::string_view model);

} // namespace clshade
