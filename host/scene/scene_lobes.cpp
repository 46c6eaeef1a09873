#include "host/scene/scene_lobes.h"

#include "host/scene/metal_table.h"
#include "host/scene/model_catalog.h"
#include "host/scene/scene_parameters.h"
#include "host/scene/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 8> specular_keys{"model",       "f0",          "ior",   "shininess",
                                                        "shininess_u", "shininess_v", "metal", "tangent"};
constexpr std::array<std::string_view, 4> diffuse_keys{"model", "albedo", "shininess", "ambient"};

/// The specular models that have a parameter. "none" keeps a shininess for the diffuse part of its layer.
std::vector<std::string_view> models_with(std::string_view key) {
    std::vector<std::string_view> names;
    for (const ModelInfo& model : model_catalog()) {
        const auto is_key = [&](const ParameterInfo& parameter) { return parameter.name == key; };
        if (model.kind == "specular" && std::any_of(model.parameters.begin(), model.parameters.end(), is_key)) {
            names.push_back(model.name);
        }
    }
    if (key == "shininess") {
        names.push_back("none");
    }
    return names;
}

/// What was written for a lobe and concerns its model.
class LobeKeys {
  public:
    /// Throws for keys that the model lacks.
    LobeKeys(const TableReader& table, SpecularModel default_model) : table_(&table), model_(default_model) {
        if (const TomlEntry* model = table.find("model")) {
            model_ = as_enum(model->value, "model", all_specular_models);
            model_origin_ = model->origin;
            where_ = model->value.where;
        } else {
            where_ = table.where();
        }
        for (const std::string_view key : specular_keys) {
            const TomlEntry* entry = table.find(key);
            if (key != "model" && entry != nullptr && !is_known(key) && entry->origin >= model_origin_) {
                fail_unknown(*entry);
            }
        }
    }

    /// Null where the key is absent or was written for another model.
    [[nodiscard]] const TomlEntry* find(std::string_view key) const {
        return is_known(key) ? table_->find(key) : nullptr;
    }

    [[nodiscard]] const TomlValue& require(std::string_view key, std::string_view example) const {
        const TomlEntry* entry = find(key);
        if (entry == nullptr) {
            fail(where_, fmt::format("{} lacks '{}', which {} needs; write for instance {}", table_->title(), key,
                                     name_of(model_), example));
        }
        return entry->value;
    }

    [[nodiscard]] SpecularModel model() const { return model_; }

  private:
    [[nodiscard]] bool is_known(std::string_view key) const {
        const std::vector<std::string_view> owners = models_with(key);
        return std::find(owners.begin(), owners.end(), name_of(model_)) != owners.end();
    }

    [[noreturn]] void fail_unknown(const TomlEntry& entry) const {
        if (model_ == SpecularModel::blinn_phong_anisotropic && entry.key == "shininess") {
            fail(entry.where, fmt::format("{}: blinn_phong_anisotropic has two exponents; write 'shininess_u' (along "
                                          "the tangent) and 'shininess_v' (across it) in place of 'shininess'",
                                          table_->title()));
        }
        fail(entry.where,
             fmt::format("{}: '{}' does nothing with model {}; remove it, or choose a model that has it: "
                         "{}",
                         table_->title(), entry.key, name_of(model_), quoted_list(models_with(entry.key))));
    }

    const TableReader* table_;
    SpecularModel model_;
    Origin model_origin_ = Origin::preset; ///< of the default model: gives way to nothing
    SourceLocation where_;
};

/// `f0` or `ior`, whichever was written last in rank.
const TomlEntry* reflectance_of(const LobeKeys& keys, const std::string& title) {
    const TomlEntry* f0 = keys.find("f0");
    const TomlEntry* ior = keys.find("ior");
    if (f0 == nullptr || ior == nullptr) {
        return f0 == nullptr ? ior : f0;
    }
    if (f0->origin == ior->origin) {
        fail(ior->where, fmt::format("{} has both 'f0' and 'ior'; keep one", title));
    }
    return f0->origin > ior->origin ? f0 : ior;
}

void read_anisotropy(const LobeKeys& keys, Specular& specular) {
    constexpr std::string_view example = "shininess_u = 16, shininess_v = 512";
    specular.shininess_u = read_shininess(keys.require("shininess_u", example), "shininess_u");
    specular.shininess_v = read_shininess(keys.require("shininess_v", example), "shininess_v");
    if (const TomlEntry* tangent = keys.find("tangent")) {
        specular.tangent = read_tangent(tangent->value);
    }
}

/// `ambient` of a model that has none is a mistake, unless a higher rank chose the model.
void read_ambient(const TableReader& table, Diffuse& diffuse) {
    const TomlEntry* ambient = table.find("ambient");
    if (ambient == nullptr) {
        return;
    }
    if (is_rough(diffuse.model)) {
        diffuse.ambient = as_enum(ambient->value, "ambient", all_ambient_diffuses);
        return;
    }
    const TomlEntry* model = table.find("model");
    if (model == nullptr || ambient->origin >= model->origin) {
        fail(ambient->where, fmt::format("{}: 'ambient' does nothing with model {}; remove it, or choose an Oren-Nayar "
                                         "model such as 'oren_nayar'",
                                         table.title(), name_of(diffuse.model)));
    }
}

} // namespace

SpecularSource read_specular(const TomlEntry& entry, const std::string& title, const std::filesystem::path& folder) {
    const std::string lobe_title = fmt::format("specular of {}", title);
    const TableReader table(entry.value, lobe_title, specular_keys);
    const LobeKeys keys(table, SpecularModel::blinn_phong);
    SpecularSource source;
    Specular& specular = source.specular;
    specular.model = keys.model();
    if (const TomlEntry* reflectance = reflectance_of(keys, lobe_title)) {
        specular.f0 =
            reflectance->key == "f0" ? read_reflectance(reflectance->value, "f0") : read_ior(reflectance->value);
        source.f0_written = true;
    }
    if (const TomlEntry* shininess = keys.find("shininess")) {
        specular.shininess = read_shininess(shininess->value, "shininess");
        source.shininess_written = true;
    }
    if (specular.model == SpecularModel::blinn_phong_anisotropic) {
        read_anisotropy(keys, specular);
    }
    if (specular.model == SpecularModel::blinn_phong_spectral) {
        const TomlValue& metal = keys.require("metal", "metal = \"gold\"");
        specular.metal = find_metal(as_text(metal, "metal"), folder, metal.where);
    }
    return source;
}

DiffuseSource read_diffuse(const TomlEntry& entry, const std::string& title) {
    const TableReader table(entry.value, fmt::format("diffuse of {}", title), diffuse_keys);
    DiffuseSource source;
    if (const TomlEntry* model = table.find("model")) {
        source.diffuse.model = as_enum(model->value, "model", all_diffuse_models);
    }
    if (const TomlEntry* albedo = table.find("albedo")) {
        source.diffuse.albedo = read_reflectance(albedo->value, "albedo");
        source.albedo_written = true;
    }
    if (const TomlEntry* shininess = table.find("shininess")) {
        source.diffuse.shininess = read_shininess(shininess->value, "shininess");
    }
    read_ambient(table, source.diffuse);
    return source;
}

bool is_rough(DiffuseModel model) {
    return model != DiffuseModel::none && model != DiffuseModel::lambert;
}

} // namespace clshade
