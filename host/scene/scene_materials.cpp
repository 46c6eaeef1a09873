#include "host/scene/scene_materials.h"

#include "host/scene/scene_claims.h"
#include "host/scene/scene_layers.h"
#include "host/scene/toml_reader.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 10> material_keys{
    "ids",   "names",    "preset", "fresnel", "absorption_model", "absorption_ibl", "transmittance_ibl",
    "layer", "specular", "diffuse"};

/// A likely place for `absorption`, which the list of known keys would call a misspelt `absorption_model`.
void refuse_absorption(const TomlEntry& material, const std::string& title) {
    const TomlTable* table = material.value.table();
    const TomlEntry* absorption = table == nullptr ? nullptr : table->find("absorption");
    if (absorption != nullptr) {
        fail(absorption->where, fmt::format("'absorption' of {} belongs to a layer that has one below it; write the "
                                            "material as a list of [[material.{}.layer]]",
                                            title, material.key));
    }
}

Material read_material(const TomlEntry& entry, const std::filesystem::path& folder, bool automatic,
                       AutomaticParameters& flags) {
    const std::string title = fmt::format("material '{}'", entry.key);
    refuse_absorption(entry, title);
    const TableReader table(entry.value, title, material_keys);
    Material material;
    material.name = entry.key;
    material.where = entry.where;
    if (const TomlEntry* fresnel = table.find("fresnel")) {
        material.fresnel = as_enum(fresnel->value, "fresnel", all_fresnel_models);
    }
    if (const TomlEntry* model = table.find("absorption_model")) {
        material.absorption_model = as_enum(model->value, "absorption_model", all_absorption_models);
    }
    if (const TomlEntry* absorption = table.find("absorption_ibl")) {
        material.absorption_ibl = as_enum(absorption->value, "absorption_ibl", all_ambient_absorptions);
    }
    if (const TomlEntry* transmittance = table.find("transmittance_ibl")) {
        material.transmittance_ibl = as_enum(transmittance->value, "transmittance_ibl", all_ambient_transmittances);
    }
    read_claims(table, material);
    flags = read_stack(table, folder, automatic, material);
    return material;
}

} // namespace

void read_materials(const TomlEntry* entry, bool default_written, Scene& scene) {
    scene.automatic = {true, true, true};
    scene.materials = {Material{}};
    if (entry == nullptr) {
        scene.automatic_material = true;
        return;
    }
    const TomlTable* table = entry->value.table();
    if (table == nullptr) {
        fail(entry->value.where, "'material' is not a table; write materials as [material.NAME], one table each");
    }
    const std::filesystem::path folder = std::filesystem::path(scene.file).parent_path();
    scene.automatic_material = table->find("default") == nullptr;
    for (const TomlEntry& named : table->entries) {
        if (named.key == "default") {
            scene.materials.front() = read_material(named, folder, !default_written, scene.automatic);
        } else {
            AutomaticParameters none;
            scene.materials.push_back(read_material(named, folder, false, none));
        }
    }
    check_claims(*table, scene.materials);
}

} // namespace clshade
