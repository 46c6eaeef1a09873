#include "host/scene/scene_presets.h"

#include "host/base/suggest.h"
#include "host/scene/model_catalog.h"
#include "host/scene/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace clshade {

namespace {

const PresetInfo& find_preset(const TomlValue& value) {
    const std::string& name = as_text(value, "preset");
    std::vector<std::string_view> names;
    for (const PresetInfo& preset : preset_catalog()) {
        if (preset.name == name) {
            return preset;
        }
        names.push_back(preset.name);
    }
    std::string advice = did_you_mean(name, names);
    if (advice.empty()) {
        advice = fmt::format("; write one of {}", quoted_list(names));
    }
    fail(value.where, fmt::format("preset '{}' is unknown{}", name, advice));
}

/// The preset's table of keys, as if it stood where `preset` is written.
TomlTable table_of(const PresetInfo& preset, const SourceLocation& where) {
    TomlTable root = parse_toml(preset.toml, fmt::format("preset {}", preset.name));
    auto& material = std::get<TomlTable>(root.entries.at(0).value.data); // [material]
    TomlValue& body = material.entries.at(0).value;                      // [material.NAME]
    set_place(body, where, Origin::preset);
    return std::move(std::get<TomlTable>(body.data));
}

void remove_key(TomlTable& table, std::string_view key) {
    std::erase_if(table.entries, [&](const TomlEntry& entry) { return entry.key == key; });
}

/// Adds to `target` what it lacks of `source`; of two tables under one key likewise.
void fill(TomlTable& target, TomlTable source) {
    for (TomlEntry& entry : source.entries) {
        TomlEntry* written = target.find(entry.key);
        if (written == nullptr) {
            target.entries.push_back(std::move(entry));
        } else if (written->value.table() != nullptr && entry.value.table() != nullptr) {
            fill(std::get<TomlTable>(written->value.data), std::move(std::get<TomlTable>(entry.value.data)));
        }
    }
}

/// What `material` has beside a preset of several layers: a lobe for all of them makes no sense, a diffuse part belongs
/// to the base.
void settle_lobes(const std::string& name, std::string_view preset, TomlTable& material, TomlTable& filling) {
    TomlEntry* layers = filling.find("layer");
    if (layers == nullptr) {
        return;
    }
    auto& list = std::get<TomlArray>(layers->value.data);
    if (const TomlEntry* specular = material.find("specular")) {
        fail(specular->where,
             fmt::format("'specular' of material '{0}' could mean any of the {1} layers of preset '{2}'; write the "
                         "layers as [[material.{0}.layer]], or change one with "
                         "--set material.{0}.layer.0.specular.KEY=VALUE",
                         name, list.size(), preset));
    }
    if (const TomlEntry* diffuse = material.find("diffuse")) {
        TomlTable base;
        base.entries.push_back(*diffuse);
        remove_key(material, "diffuse");
        fill(base, std::move(std::get<TomlTable>(list.back().data)));
        list.back().data = std::move(base);
    }
}

/// Returns whether the material had a preset.
bool expand_material(const std::string& name, TomlTable& material) {
    const TomlEntry* key = material.find("preset");
    if (key == nullptr) {
        return false;
    }
    const PresetInfo& preset = find_preset(key->value);
    TomlTable filling = table_of(preset, key->value.where);
    remove_key(material, "preset");
    if (material.find("layer") != nullptr) {
        for (const std::string_view replaced : {"layer", "specular", "diffuse"}) {
            remove_key(filling, replaced);
        }
    }
    settle_lobes(name, preset.name, material, filling);
    fill(material, std::move(filling));
    return true;
}

} // namespace

bool expand_presets(TomlTable& root) {
    TomlEntry* materials = root.find("material");
    TomlTable* table = materials == nullptr ? nullptr : materials->value.table();
    if (table == nullptr) {
        return false;
    }
    bool default_expanded = false;
    for (TomlEntry& material : table->entries) {
        if (TomlTable* keys = material.value.table()) {
            default_expanded |= expand_material(material.key, *keys) && material.key == "default";
        }
    }
    return default_expanded;
}

} // namespace clshade
