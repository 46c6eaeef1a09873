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

/// Gives a value and all it holds one place.
void set_place(TomlValue& value, const SourceLocation& where) {
    value.where = where;
    if (TomlArray* list = value.array()) {
        for (TomlValue& element : *list) {
            set_place(element, where);
        }
    } else if (TomlTable* table = value.table()) {
        for (TomlEntry& entry : table->entries) {
            entry.where = where;
            set_place(entry.value, where);
        }
    }
}

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

/// TOML, or else a bare word such as oren_nayar or studio.hdr.
TomlValue parse_value(std::string_view text, const SourceLocation& where) {
    try {
        TomlTable tree = parse_toml(fmt::format("value = {}", text), {});
        if (tree.entries.size() == 1) {
            TomlValue value = std::move(tree.entries.front().value);
            set_place(value, where);
            return value;
        }
    } catch (const UsageError&) {
        const bool bare = !text.empty() && text.find_first_of("'\"[]{}=,#\n\r") == std::string_view::npos &&
                          text.front() != ' ' && text.back() != ' ';
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

/// The material's only layer, where the default material is written as a stack of one.
TomlTable* single_layer(TomlTable& root) {
    TomlTable* table = &root;
    for (const std::string_view key : {"material", "default"}) {
        TomlEntry* entry = table->find(key);
        table = entry == nullptr ? nullptr : entry->value.table();
        if (table == nullptr) {
            return nullptr;
        }
    }
    TomlEntry* layers = table->find("layer");
    TomlArray* list = layers == nullptr ? nullptr : layers->value.array();
    return list != nullptr && list->size() == 1 ? list->front().table() : nullptr;
}

} // namespace

void apply_override(TomlTable& root, const std::string& assignment) {
    const SourceLocation where{fmt::format("--set {}", assignment), 0, 0};
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
        fail(where, "the assignment has no '='; write for instance material.default.specular.shininess=32");
    }
    const std::vector<std::string> path = split_path(std::string_view(assignment).substr(0, equals), where);
    set_in_table(root, path, parse_value(std::string_view(assignment).substr(equals + 1), where));
}

void apply_model(TomlTable& root, std::string_view model) {
    const SourceLocation where{fmt::format("--model {}", model), 0, 0};
    std::vector<std::string_view> names;
    for (const ModelInfo& info : model_catalog()) {
        if (info.name == model) {
            TomlValue value{std::string(model), where};
            if (TomlTable* layer = single_layer(root)) {
                const std::vector<std::string> path{std::string(info.kind), "model"};
                set_in_table(*layer, path, std::move(value));
            } else {
                const std::vector<std::string> path{"material", "default", std::string(info.kind), "model"};
                set_in_table(root, path, std::move(value));
            }
            return;
        }
        names.push_back(info.name);
    }
    if (model == "none") {
        fail(where, "'none' may mean either lobe; write --set material.default.specular.model=none or "
                    "--set material.default.diffuse.model=none");
    }
    std::string advice = did_you_mean(model, names);
    if (advice.empty()) {
        advice = fmt::format("; write one of {}", quoted_list(names));
    }
    fail(where, fmt::format("unknown model{}", advice));
}

} // namespace clshade
