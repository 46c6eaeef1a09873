#include "host/cli/models_text.h"

#include "host/cli/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>

namespace clshade::cli {

namespace {

constexpr std::size_t text_width = 100;
constexpr std::size_t label_width = 10;

std::string picture_of(const PresetInfo& preset) {
    return fmt::format("docs/presets/{}.png", preset.name);
}

// "label   text", wrapped, everything `indent` blanks to the right.
std::string labelled(std::string_view label, std::string_view text, std::size_t indent = 0) {
    if (text.empty()) {
        return {};
    }
    const std::size_t column = indent + label_width;
    return fmt::format("{:{}}{:<{}}{}\n", "", indent, label, label_width, wrap(text, text_width - column, column));
}

struct Entry {
    std::string_view name;
    std::string_view text;
};

std::string section(std::string_view heading, std::string_view use, const std::vector<Entry>& entries) {
    constexpr std::size_t indent = 2;
    std::size_t longest = 0;
    for (const Entry& entry : entries) {
        longest = std::max(longest, entry.name.size());
    }
    const std::size_t column = indent + longest + 2;
    std::string text = fmt::format("{} - {}\n", heading, use);
    for (const Entry& entry : entries) {
        text += fmt::format("{:{}}{:<{}}{}\n", "", indent, entry.name, longest + 2,
                            wrap(entry.text, text_width - column, column));
    }
    return text + "\n";
}

std::vector<Entry> models_of(std::string_view kind) {
    std::vector<Entry> entries;
    for (const ModelInfo& model : model_catalog()) {
        if (model.kind == kind) {
            entries.push_back({model.name, model.summary});
        }
    }
    return entries;
}

std::vector<Entry> stack_keys() {
    std::vector<Entry> entries;
    for (const ModelInfo& model : model_catalog()) {
        if (model.kind == "stack") {
            for (const ParameterInfo& key : model.parameters) {
                entries.push_back({key.name, key.range});
            }
        }
    }
    return entries;
}

std::vector<Entry> keys_of_environment() {
    std::vector<Entry> entries;
    for (const ParameterInfo& key : environment_keys()) {
        entries.push_back({key.name, key.range});
    }
    return entries;
}

std::string parameter_text(std::span<const ParameterInfo> parameters) {
    constexpr std::size_t indent = 4;
    std::string text;
    for (const ParameterInfo& parameter : parameters) {
        text += fmt::format("  {}\n", parameter.name);
        text += labelled("unit", parameter.unit, indent) + labelled("range", parameter.range, indent) +
                labelled("default", parameter.fallback, indent) + labelled("source", parameter.source, indent);
    }
    return text;
}

nlohmann::json json_of(std::span<const ParameterInfo> parameters) {
    nlohmann::json all = nlohmann::json::array();
    for (const ParameterInfo& parameter : parameters) {
        all.push_back({{"name", parameter.name},
                       {"unit", parameter.unit},
                       {"range", parameter.range},
                       {"default", parameter.fallback},
                       {"source", parameter.source}});
    }
    return all;
}

constexpr std::string_view environment_summary =
    "Light from all around a scene: a lat-long picture, a set that `clshade prefilter` wrote, or the built-in studio.";

std::vector<Entry> presets() {
    std::vector<Entry> entries;
    for (const PresetInfo& preset : preset_catalog()) {
        entries.push_back({preset.name, preset.summary});
    }
    return entries;
}

std::string indented(std::string_view text, std::string_view indent) {
    std::string result;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        result += end > 0 ? fmt::format("{}{}\n", indent, text.substr(0, end)) : "\n";
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return result;
}

} // namespace

std::string catalog_text() {
    return section("Lobes", R"(specular = { model = "NAME", ... } in any layer)", models_of("specular")) +
           section("Diffuse models", R"(diffuse = { model = "NAME", ... } in the base)", models_of("diffuse")) +
           section("Stacks", "keys of a material; more under `clshade models layers`", stack_keys()) +
           section("Environment", "keys of [environment]; more under `clshade models environment`",
                   keys_of_environment()) +
           section("Presets", R"(preset = "NAME" in a material; keys written beside it override)", presets()) +
           "The model \"none\" leaves a lobe or the diffuse part out.\n"
           "`clshade models NAME` shows parameters, units, ranges, defaults and sources; of a preset its TOML.\n";
}

std::string page_of(const ModelInfo& model) {
    std::string page = fmt::format("{} ({})\n\n", model.name, model.kind);
    page += labelled("what", model.summary) + labelled("when", model.advice) + labelled("ambient", model.environment) +
            labelled("source", model.source);
    page += model.kind == "stack" ? "\nKeys of a material:\n" : "\nParameters:\n";
    return page + parameter_text(model.parameters);
}

std::string environment_page() {
    return fmt::format("{} (scene)\n\n{}\nKeys of [environment]:\n{}", environment_name,
                       labelled("what", environment_summary), parameter_text(environment_keys()));
}

std::string page_of(const PresetInfo& preset) {
    std::string page = fmt::format("{} (preset)\n\n", preset.name);
    page +=
        labelled("what", preset.summary) + labelled("source", preset.source) + labelled("picture", picture_of(preset));
    page += fmt::format("\nIn a scene file:\n  [material.mine]\n  preset = \"{}\"\n"
                        "  ids = [1]                         # or names = [...], for Cryptomatte\n",
                        preset.name);
    return page + "\nWhat it stands for, to be copied and changed:\n" + indented(preset.toml, "  ");
}

nlohmann::json json_of(const ModelInfo& model) {
    return {{"model", model.name},
            {"kind", model.kind},
            {"summary", model.summary},
            {"source", model.source},
            {"advice", model.advice},
            {"environment", model.environment},
            {"parameters", json_of(model.parameters)}};
}

nlohmann::json environment_json() {
    return {{"model", environment_name},
            {"kind", "scene"},
            {"summary", environment_summary},
            {"source", "models.md section 6"},
            {"parameters", json_of(environment_keys())}};
}

nlohmann::json json_of(const PresetInfo& preset) {
    return {{"model", preset.name},    {"kind", "preset"},    {"summary", preset.summary},
            {"source", preset.source}, {"toml", preset.toml}, {"picture", picture_of(preset)}};
}

} // namespace clshade::cli
