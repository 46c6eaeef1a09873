// What `models` prints and reports: the catalogue of models and presets in words.
#pragma once

#include "host/scene/model_catalog.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace clshade::cli {

/// What `models` calls the page of environments.
inline constexpr std::string_view environment_name = "environment";

/// Lobes, diffuse models, keys of stacks and of environments, and presets, one line each.
[[nodiscard]] std::string catalog_text();
/// The keys of a scene's [environment].
[[nodiscard]] std::string environment_page();
/// A model with every parameter: unit, range, default, source.
[[nodiscard]] std::string page_of(const ModelInfo& model);
/// A preset with its TOML and where its picture lies.
[[nodiscard]] std::string page_of(const PresetInfo& preset);

[[nodiscard]] nlohmann::json json_of(const ModelInfo& model);
[[nodiscard]] nlohmann::json json_of(const PresetInfo& preset);
[[nodiscard]] nlohmann::json environment_json();

} // namespace clshade::cli
