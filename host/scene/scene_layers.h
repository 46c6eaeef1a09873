// The stack of layers a material is.
#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_reader.h"

#include <filesystem>

namespace clshade {

/// Reads layers and diffuse part of a material's table into `material`. `folder`: where paths of metal tables start.
/// `automatic`: what nobody wrote of the base is chosen from the roles; an absent lobe of the base is then Blinn-Phong
/// or Lambert, not "none". Returns which parameters of the base are to be chosen so.
[[nodiscard]] AutomaticParameters read_stack(const TableReader& table, const std::filesystem::path& folder,
                                             bool automatic, Material& material);

} // namespace clshade
