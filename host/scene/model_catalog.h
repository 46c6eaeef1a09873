// What can be shaded with: models, stacks and presets as data, for `clshade models`, for did-you-mean and for `check`.
#pragma once

#include "host/scene/scene.h"

#include <span>
#include <string_view>

namespace clshade {

struct ParameterInfo {
    std::string_view name;
    std::string_view unit; ///< "1", "rad", "W/m2", ...; "-" for names and lists
    std::string_view range;
    std::string_view fallback; ///< default, in words
    std::string_view source;   ///< slide, paper or section of the formula specification
};

struct ModelInfo {
    std::string_view name; ///< as in the scene file
    /// "specular" or "diffuse": a lobe's `model`. "stack": the keys of a material that hold its lobes together.
    std::string_view kind;
    std::string_view summary;
    std::string_view source; ///< slide, paper, section of the formula specification
    std::string_view advice; ///< when to use it, when not
    std::span<const ParameterInfo> parameters;
    std::string_view environment; ///< how an environment lights it: one sentence
};

/// All models, specular before diffuse, then the one entry "layers" of kind "stack". "none", the absence of a lobe, is
/// not listed.
[[nodiscard]] std::span<const ModelInfo> model_catalog();

/// Keys of the scene's [environment], and `background` of [output].
[[nodiscard]] std::span<const ParameterInfo> environment_keys();

/// A material that scenes take by `preset = "NAME"`.
struct PresetInfo {
    std::string_view name;
    std::string_view summary;
    std::string_view source; ///< slide, paper or section of the formula specification that the numbers come from
    /// [material.NAME] as it could stand in a scene file but for `ids` or `names`; constants only, so that it suits any
    /// G-buffer.
    std::string_view toml;
};

[[nodiscard]] std::span<const PresetInfo> preset_catalog();

} // namespace clshade
