// The tables `specular` and `diffuse` of a layer.
#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_value.h"

#include <filesystem>
#include <string>

namespace clshade {

struct SpecularSource {
    Specular specular;
    bool f0_written = false; ///< as `f0` or `ior`
    bool shininess_written = false;
};

/// Reads `specular` of what `title` names. `folder`: where paths of metal tables start. Throws UsageError for a key
/// that the model lacks, naming the models that have it, unless the model was chosen by a higher rank (Origin).
[[nodiscard]] SpecularSource read_specular(const TomlEntry& entry, const std::string& title,
                                           const std::filesystem::path& folder);

struct DiffuseSource {
    Diffuse diffuse;
    bool albedo_written = false;
};

/// Reads `diffuse` of what `title` names.
[[nodiscard]] DiffuseSource read_diffuse(const TomlEntry& entry, const std::string& title);

/// Whether the model takes a shininess: every Oren-Nayar model.
[[nodiscard]] bool is_rough(DiffuseModel model);

} // namespace clshade
