#include "host/scene/scene_overrides.h"

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/scene/model_catalog.h"
#include "host/scene/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace clshade {

namespace {

using Path = std::span<const std::string>;

/// The keys of a dotted path; the TOML parser knows how they may be quoted.
std::vector<std::string> split_path(std::string_view path, const SourceLocation& where) {
    std::vector<std::string> keys;
    try {
        TomlTable tree = parse_toml(fmt::format("{} = 0", path), {});
        const TomlTable* level = &tree;
        while (level != nullptr && level->entries.size() == 1) {
            keys.push_back(level->entries.front().key);
            level = level->entries.front().value.table();
        }
        if (level != nullptr) { // more than one key, or none: a line break or comment was smuggled in
            keys.clear();
        }
    } catch (const UsageError&) {
        keys.clear();
    }
    if (keys.empty()) {
        fail(where, fmt::format("'{}' is not a path of keys; write for instance material.default.specular.shininess=32",
                                path));
    }
    return keys;
}

/// TOML, or else a bare word such as oren_nayar, studio.hdr or camera.####.json.
TomlValue parse_value(std::string_view text, const SourceLocation& where) {
    try {
        TomlTable tree = parse_toml(fmt::format("value = {}", text), {});
        if (tree.entries.size() == 1) {
            TomlValue value = std::move(tree.entries.front().value);
            set_place(value, where, Origin::command_line);
            return value;
        }
    } catch (const UsageError&) {
        const bool bare = !text.empty() && text.find_first_of("'\"[]{}=,\n\r") == std::string_view::npos &&
                          text.front() != ' ' && text.back() != ' ' && text.find(" #") == std::string_view::npos;
        if (bare) {
            return {std::string(text), where};
        }
    }
    fail(where,
         fmt::format("'{}' is not a TOML value; write a number, true or false, \"text\", [1, 2, 3] or a word", text));
}

std::optional<std::size_t> index_from(const std::string& key) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (error != std::errc() || end != key.data() + key.size()) {
        return std::nullopt;
    }
    return index;
}

const std::string* name_of_element(const TomlValue& element) {
    const TomlTable* table = element.table();
    const TomlEntry* name = table == nullptr ? nullptr : table->find("name");
    return name == nullptr ? nullptr : name->value.text();
}

TomlValue& element_of(TomlArray& list, const std::string& key, std::string_view list_key, const SourceLocation& where) {
    std::vector<std::string> names;
    for (TomlValue& element : list) {
        if (const std::string* name = name_of_element(element)) {
            if (*name == key) {
                return element;
            }
            names.push_back(*name);
        }
    }
    const std::optional<std::size_t> index = index_from(key);
    if (index.has_value() && *index < list.size()) {
        return list[*index];
    }
    fail(where, fmt::format("'{}' has no element '{}'{}; it has {}, counted from 0", list_key, key,
                            did_you_mean(key, std::span<const std::string>(names)), list.size()));
}

void set_in_value(TomlValue& target, std::string_view target_key, Path path, TomlValue value);

void set_in_table(TomlTable& table, Path path, TomlValue value) {
    const std::string& key = path.front();
    TomlEntry* entry = table.find(key);
    if (entry == nullptr) {
        table.entries.push_back({key, value.where, TomlValue{TomlTable{}, value.where}});
        entry = &table.entries.back();
    }
    entry->where = value.where;
    entry->origin = Origin::command_line;
    set_in_value(entry->value, key, path.subspan(1), std::move(value));
}

void set_in_value(TomlValue& target, std::string_view target_key, Path path, TomlValue value) {
    if (path.empty()) {
        target = std::move(value);
    } else if (TomlTable* table = target.table()) {
        set_in_table(*table, path, std::move(value));
    } else if (TomlArray* list = target.array()) {
        const SourceLocation where = value.where;
        set_in_value(element_of(*list, path.front(), target_key, where), path.front(), path.subspan(1),
                     std::move(value));
    } else {
        fail(value.where,
             fmt::format("'{}' is {} and has no key '{}'; set it as a whole", target_key, target.kind(), path.front()));
    }
}

/// The list of tables that a material is written as; null if it is written without layers.
TomlArray* layers_of(TomlTable& root, const std::string& material) {
    TomlTable* table = &root;
    for (const std::string& key : {std::string("material"), material}) {
        TomlEntry* entry = table->find(key);
        table = entry == nullptr ? nullptr : entry->value.table();
        if (table == nullptr) {
            return nullptr;
        }
    }
    TomlEntry* layers = table->find("layer");
    TomlArray* list = layers == nullptr ? nullptr : layers->value.array();
    return list == nullptr || list->empty() ? nullptr : list;
}

/// Leads material.NAME.diffuse (and material.NAME.specular of a single layer) to the layer that has it. Throws where
/// the path leads into layers that the material lacks, or could mean several.
std::vector<std::string> into_layers(TomlTable& root, std::vector<std::string> path, const SourceLocation& where) {
    if (path.size() < 3 || path[0] != "material") {
        return path;
    }
    const TomlArray* layers = layers_of(root, path[1]);
    if (layers == nullptr && path[2] == "layer" && path.size() > 3) {
        fail(where, fmt::format("material '{0}' is not written as layers; write material.{0}.specular or "
                                "material.{0}.diffuse, or set all layers at once: material.{0}.layer=[{{...}}, ...]",
                                path[1]));
    }
    if (path[2] != "specular" && path[2] != "diffuse") {
        return path;
    }
    if (layers == nullptr) {
        return path;
    }
    if (path[2] == "specular" && layers->size() > 1) {
        fail(where, fmt::format("material '{0}' has {1} layers, each with its own specular lobe; write for instance "
                                "material.{0}.layer.0.specular.model=blinn_phong, layers counted from 0 = top",
                                path[1], layers->size()));
    }
    const std::vector<std::string> detour{"layer", fmt::format("{}", layers->size() - 1)};
    path.insert(path.begin() + 2, detour.begin(), detour.end());
    return path;
}

struct Assignment {
    SourceLocation where;
    std::vector<std::string> path;
    std::string_view value;
};

Assignment split(const std::string& assignment) {
    SourceLocation where{fmt::format("--set {}", assignment), 0, 0};
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
        fail(where, "the assignment has no '='; write for instance material.default.specular.shininess=32");
    }
    const std::string_view text = assignment;
    std::vector<std::string> path = split_path(text.substr(0, equals), where);
    return {std::move(where), std::move(path), text.substr(equals + 1)};
}

/// How --model can be misunderstood; otherwise a suggestion.
[[noreturn]] void fail_model(const SourceLocation& where, std::string_view model,
                             std::span<const std::string_view> names) {
    if (model == "none") {
        fail(where, "'none' may mean either lobe; write --set material.default.specular.model=none or "
                    "--set material.default.diffuse.model=none");
    }
    for (const PresetInfo& preset : preset_catalog()) {
        if (preset.name == model) {
            fail(where, fmt::format("'{0}' is a preset, not a model; write --set material.default.preset={0}", model));
        }
    }
    std::string advice = did_you_mean(model, names);
    if (advice.empty()) {
        advice = fmt::format("; write one of {}", quoted_list(names));
    }
    fail(where, fmt::format("unknown model{}", advice));
}

} // namespace

void apply_override(TomlTable& root, const std::string& assignment) {
    Assignment parts = split(assignment);
    const std::vector<std::string> path = into_layers(root, std::move(parts.path), parts.where);
    set_in_table(root, path, parse_value(parts.value, parts.where));
}

bool chooses_preset(const std::string& assignment) {
    const std::vector<std::string> path = split(assignment).path;
    return path.size() == 3 && path[0] == "material" && path[2] == "preset";
}

void apply_model(TomlTable& root, std::string_view model) {
    const SourceLocation where{fmt::format("--model {}", model), 0, 0};
    std::vector<std::string_view> names;
    for (const ModelInfo& info : model_catalog()) {
        if (info.kind != "specular" && info.kind != "diffuse") {
            continue;
        }
        if (info.name == model) {
            const std::vector<std::string> path =
                into_layers(root, {"material", "default", std::string(info.kind), "model"}, where);
            set_in_table(root, path, TomlValue{std::string(model), where});
            return;
        }
        names.push_back(info.name);
    }
    fail_model(where, model, names);
}

} // namespace clshade
