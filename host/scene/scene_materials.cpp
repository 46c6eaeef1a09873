#include "host/scene/scene_materials.h"

#include "host/scene/scene_parameters.h"
#include "host/scene/toml_reader.h"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 8> material_keys{"ids",   "names",    "preset", "fresnel", "absorption_model",
                                                        "layer", "specular", "diffuse"};
constexpr std::array<std::string_view, 3> layer_keys{"specular", "diffuse", "absorption"};
constexpr std::array<std::string_view, 7> specular_keys{"model",       "f0",          "ior",  "shininess",
                                                        "shininess_u", "shininess_v", "metal"};
constexpr std::array<std::string_view, 3> diffuse_keys{"model", "albedo", "shininess"};

constexpr std::array<std::string_view, 5> specular_models{"none", "blinn_phong",
                                                          "blinn_phong_exact", // order of SpecularModel
                                                          "blinn_phong_anisotropic", "blinn_phong_spectral"};
constexpr std::size_t specular_models_built = 3;
constexpr std::array<std::string_view, 8> diffuse_models{// order of DiffuseModel
                                                         "none",
                                                         "lambert",
                                                         "oren_nayar",
                                                         "oren_nayar_full",
                                                         "oren_nayar_qualitative",
                                                         "oren_nayar_simplified_1",
                                                         "oren_nayar_simplified_2",
                                                         "oren_nayar_shininess"};
constexpr std::array<std::string_view, 2> fresnel_names{"constant", "exact"};
constexpr std::array<std::string_view, 3> absorption_names{"approximated", "original", "none"};

/// Floats hold every whole number up to here; ids are compared in single precision.
constexpr std::int64_t largest_id = std::int64_t{1} << 24;

/// A lobe's table and what was written in it.
struct SpecularSource {
    Specular specular;
    bool f0_written = false;
    bool shininess_written = false;
};

SpecularSource read_specular(const TomlEntry& entry, const std::string& title) {
    const TableReader table(entry.value, fmt::format("specular of {}", title), specular_keys);
    SpecularSource source;
    if (const TomlEntry* model = table.find("model")) {
        const std::size_t index = as_choice(model->value, "model", specular_models);
        if (index >= specular_models_built) {
            fail_not_built(model->value.where, fmt::format("model '{}' of {}", specular_models.at(index), title),
                           "use blinn_phong or blinn_phong_exact");
        }
        source.specular.model = static_cast<SpecularModel>(index);
    }
    for (const std::string_view key : {"shininess_u", "shininess_v"}) {
        if (const TomlEntry* later = table.find(key)) {
            fail_not_built(later->where, fmt::format("'{}' of {} (blinn_phong_anisotropic)", key, title),
                           "use blinn_phong with 'shininess'");
        }
    }
    if (const TomlEntry* metal = table.find("metal")) {
        fail_not_built(metal->where, fmt::format("'metal' of {} (blinn_phong_spectral)", title),
                       "use blinn_phong with the metal's colour as 'f0'");
    }
    const TomlEntry* f0 = table.find("f0");
    const TomlEntry* ior = table.find("ior");
    if (f0 != nullptr && ior != nullptr) {
        fail(ior->where, fmt::format("specular of {} has both 'f0' and 'ior'; keep one", title));
    }
    if (f0 != nullptr) {
        source.specular.f0 = read_reflectance(f0->value, "f0");
    } else if (ior != nullptr) {
        source.specular.f0 = read_ior(ior->value);
    }
    source.f0_written = f0 != nullptr || ior != nullptr;
    if (const TomlEntry* shininess = table.find("shininess")) {
        source.specular.shininess = read_shininess(shininess->value, "shininess");
        source.shininess_written = true;
    }
    return source;
}

struct DiffuseSource {
    Diffuse diffuse;
    bool albedo_written = false;
};

DiffuseSource read_diffuse(const TomlEntry& entry, const std::string& title) {
    const TableReader table(entry.value, fmt::format("diffuse of {}", title), diffuse_keys);
    DiffuseSource source;
    if (const TomlEntry* model = table.find("model")) {
        source.diffuse.model = static_cast<DiffuseModel>(as_choice(model->value, "model", diffuse_models));
    }
    if (const TomlEntry* albedo = table.find("albedo")) {
        source.diffuse.albedo = read_reflectance(albedo->value, "albedo");
        source.albedo_written = true;
    }
    if (const TomlEntry* shininess = table.find("shininess")) {
        source.diffuse.shininess = read_shininess(shininess->value, "shininess");
    }
    return source;
}

/// Reads both lobes of one layer. Returns which parameters nobody wrote.
AutomaticParameters read_lobes(const TableReader& layer, const std::string& title, bool automatic, Material& material) {
    const TomlEntry* specular = layer.find("specular");
    const TomlEntry* diffuse = layer.find("diffuse");
    if (specular == nullptr && diffuse == nullptr && !automatic) {
        fail(layer.where(), fmt::format("{} has neither 'specular' nor 'diffuse'; write for instance "
                                        "diffuse = {{ model = \"lambert\", albedo = 0.5 }}",
                                        title));
    }
    SpecularSource specular_source;
    DiffuseSource diffuse_source;
    if (specular != nullptr) {
        specular_source = read_specular(*specular, title);
    } else if (!automatic) {
        specular_source.specular.model = SpecularModel::none;
    }
    if (diffuse != nullptr) {
        diffuse_source = read_diffuse(*diffuse, title);
    } else if (!automatic) {
        diffuse_source.diffuse.model = DiffuseModel::none;
    }
    material.base() = std::move(specular_source.specular);
    material.diffuse = std::move(diffuse_source.diffuse);
    if (material.base().model == SpecularModel::none && material.diffuse.model == DiffuseModel::none) {
        fail(layer.where(),
             fmt::format("{} has model 'none' for both lobes and would be black; give one a model", title));
    }
    const bool rough = material.diffuse.model != DiffuseModel::none && material.diffuse.model != DiffuseModel::lambert;
    const bool has_shininess = material.base().model != SpecularModel::none || specular_source.shininess_written;
    if (rough && !material.diffuse.shininess.has_value() && !has_shininess) {
        fail(diffuse == nullptr ? layer.where() : diffuse->value.where,
             fmt::format("diffuse of {}: {} needs a shininess, and there is no specular lobe to take it from; add "
                         "shininess to diffuse",
                         title, name_of(material.diffuse.model)));
    }
    return {automatic && !diffuse_source.albedo_written, automatic && !specular_source.f0_written,
            automatic && !specular_source.shininess_written};
}

void refuse_what_is_not_built(const TableReader& table) {
    if (const TomlEntry* preset = table.find("preset")) {
        fail_not_built(preset->where, fmt::format("'preset' of {}", table.title()), "write specular and diffuse");
    }
    if (const TomlEntry* names = table.find("names")) {
        fail_not_built(names->where, fmt::format("'names' (Cryptomatte) of {}", table.title()),
                       "use 'ids' and the material_id plane");
    }
    if (const TomlEntry* fresnel = table.find("fresnel")) {
        if (as_choice(fresnel->value, "fresnel", fresnel_names) != 0) {
            fail_not_built(fresnel->where, fmt::format("fresnel = \"exact\" of {}", table.title()), "remove the key");
        }
    }
    if (const TomlEntry* absorption = table.find("absorption_model")) {
        (void)as_choice(absorption->value, "absorption_model", absorption_names);
        fail_not_built(absorption->where, fmt::format("'absorption_model' of {}", table.title()), "remove the key");
    }
}

/// The table that holds the lobes: the material itself or its only [[layer]].
TableReader layer_of(const TableReader& table) {
    const TomlEntry* layers = table.find("layer");
    if (layers == nullptr) {
        return table;
    }
    for (const std::string_view key : {"specular", "diffuse"}) {
        if (const TomlEntry* lobe = table.find(key)) {
            fail(lobe->where,
                 fmt::format("{} has both '{}' and [[layer]]; write the lobes in the layer", table.title(), key));
        }
    }
    const TomlArray* list = layers->value.array();
    if (list == nullptr || list->empty()) {
        fail(layers->where,
             fmt::format("'layer' of {} is not a list of tables; write at least one [[material.NAME.layer]]",
                         table.title()));
    }
    if (list->size() > 1) {
        fail_not_built((*list)[1].where, fmt::format("a stack of {} layers ({})", list->size(), table.title()),
                       "keep one layer");
    }
    TableReader layer(list->front(), fmt::format("the layer of {}", table.title()), layer_keys);
    if (const TomlEntry* absorption = layer.find("absorption")) {
        fail_not_built(absorption->where, fmt::format("'absorption' of {}", table.title()), "remove the key");
    }
    return layer;
}

std::vector<std::int64_t> read_ids(const TomlValue& value, const std::string& title) {
    const TomlArray* list = value.array();
    if (list == nullptr) {
        fail_type(value, "ids", "a list of whole numbers such as [3, 7]");
    }
    if (list->empty()) {
        fail(value.where, fmt::format("'ids' of {} is empty, so that it claims no pixel; list the values of the "
                                      "material_id plane",
                                      title));
    }
    std::vector<std::int64_t> ids;
    for (const TomlValue& element : *list) {
        const auto* id = std::get_if<std::int64_t>(&element.data);
        if (id == nullptr) {
            fail_type(element, "ids", "a list of whole numbers");
        }
        if (*id < -largest_id || *id > largest_id) {
            fail(element.where,
                 fmt::format("id {} of {} cannot be told apart in a plane of floats; write ids within +-{}", *id, title,
                             largest_id));
        }
        ids.push_back(*id);
    }
    return ids;
}

Material read_material(const TomlEntry& entry, bool automatic, AutomaticParameters& flags) {
    const std::string title = fmt::format("material '{}'", entry.key);
    const TableReader table(entry.value, title, material_keys);
    Material material;
    material.name = entry.key;
    material.where = entry.where;
    refuse_what_is_not_built(table);
    const TomlEntry* ids = table.find("ids");
    if (entry.key == "default") {
        if (ids != nullptr) {
            fail(ids->where, "material 'default' takes every id that no other material claims; remove 'ids'");
        }
    } else if (ids == nullptr) {
        fail(table.where(), fmt::format("{} lacks 'ids', so that it claims no pixel; write for instance ids = [3, 7], "
                                        "or call it 'default'",
                                        title));
    } else {
        material.ids = read_ids(ids->value, title);
    }
    flags = read_lobes(layer_of(table), title, automatic, material);
    return material;
}

void check_ids(const TomlTable& table, const std::vector<Material>& materials) {
    std::map<std::int64_t, std::string> owners;
    for (const Material& material : materials) {
        for (const std::int64_t id : material.ids) {
            const auto [owner, is_new] = owners.emplace(id, material.name);
            if (!is_new) {
                const TomlEntry* entry = table.find(material.name);
                const TomlEntry* ids = entry->value.table()->find("ids");
                fail(ids->value.where,
                     fmt::format("id {} is claimed twice, by material '{}' and material '{}'; keep one", id,
                                 owner->second, material.name));
            }
        }
    }
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
    scene.automatic_material = table->find("default") == nullptr;
    for (const TomlEntry& named : table->entries) {
        if (named.key == "default") {
            scene.materials.front() = read_material(named, !default_written, scene.automatic);
        } else {
            AutomaticParameters none;
            scene.materials.push_back(read_material(named, false, none));
        }
    }
    check_ids(*table, scene.materials);
}

} // namespace clshade
