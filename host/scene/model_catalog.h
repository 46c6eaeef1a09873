// What can be shaded with: the models as data, for `clshade models`, for did-you-mean and for `check`.
#pragma once

#include "host/scene/scene.h"

#include <span>
#include <string_view>

namespace clshade {

struct ParameterInfo {
    std::string_view name;
    std::string_view unit; ///< "1", "rad", "W/m2", ...
    std::string_view range;
    std::string_view fallback; ///< default, in words
};

struct ModelInfo {
    std::string_view name; ///< as in the scene file
    std::string_view kind; ///< "specular" or "diffuse"
    bool available;        ///< false: a name of a later release, refused with "not built yet"
    std::string_view summary;
    std::string_view source; ///< slide, paper, section of the formula specification
    std::string_view advice; ///< when to use it, when not
    std::span<const ParameterInfo> parameters;
};

/// All models, specular before diffuse, available ones first in each kind. "none", the absence of a lobe, is not
/// listed.
[[nodiscard]] std::span<const ModelInfo> model_catalog();

} // namespace clshade
