// What `models` prints and reports: the catalogue of models and presets in words.
#pragma once

#include "host/scene/model_catalog.h"

#include <nlohmann/json.hpp>

#include <string>

namespace clshade::cli {

/// Lobes, diffuse models, keys of stacks and presets, one line each.
[[nodiscard]] std::string catalog_text();
/// A model with every parameter: unit, range, default, source.
[[nodiscard]] std::string page_of(const ModelInfo& model);
/// A preset with its TOML and where its picture lies.
[[nodiscard]] std::string page_of(const PresetInfo& preset);

[[nodiscard]] nlohmann::json json_of(const ModelInfo& model);
[[nodiscard]] nlohmann::json json_of(const PresetInfo& preset);

} // namespace clshade::cli
