#include "host/scene/scene_layers.h"

#include "host/scene/scene_lobes.h"
#include "host/scene/scene_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 3> layer_keys{"specular", "diffuse", "absorption"};

/// The tables that hold the lobes, top first: the [[layer]] list, or the material itself as a stack of one.
std::vector<TableReader> layer_tables(const TableReader& material) {
    const TomlEntry* layers = material.find("layer");
    if (layers == nullptr) {
        return {material};
    }
    for (const std::string_view key : {"specular", "diffuse"}) {
        if (const TomlEntry* lobe = material.find(key)) {
            fail(lobe->where,
                 fmt::format("{} has both '{}' and [[layer]]; write the lobes in the layer", material.title(), key));
        }
    }
    const TomlArray* list = layers->value.array();
    if (list == nullptr || list->empty()) {
        fail(layers->where,
             fmt::format("'layer' of {} is not a list of tables; write at least one [[material.NAME.layer]]",
                         material.title()));
    }
    if (list->size() > most_layers) {
        fail((*list)[most_layers].where, fmt::format("{} has {} layers; remove some: a stack has one to {}",
                                                     material.title(), list->size(), most_layers));
    }
    std::vector<TableReader> tables;
    for (const TomlValue& layer : *list) {
        const std::string title = list->size() == 1
                                      ? fmt::format("the layer of {}", material.title())
                                      : fmt::format("layer {} of {}", tables.size() + 1, material.title());
        tables.emplace_back(layer, title, layer_keys);
    }
    return tables;
}

void check_layer_above_base(const TableReader& layer, std::size_t layers) {
    if (const TomlEntry* diffuse = layer.find("diffuse")) {
        fail(diffuse->where, fmt::format("{} (counted from the top) has 'diffuse', which only the last layer, the "
                                         "base, may have; move it to layer {}",
                                         layer.title(), layers));
    }
    if (!layer.has("specular") && !layer.has("absorption")) {
        fail(layer.where(), fmt::format("{} has neither 'specular' nor 'absorption'; give it one, or remove the layer",
                                        layer.title()));
    }
}

void check_base(const TableReader& base, std::size_t layers, bool automatic) {
    if (const TomlEntry* absorption = base.find("absorption")) {
        fail(absorption->where,
             fmt::format("'absorption' of {} dims what lies below, and below it lies nothing; {}", base.title(),
                         layers > 1 ? "move it to the layer above"
                                    : "remove it, or write a second [[material.NAME.layer]]"));
    }
    if (!base.has("specular") && !base.has("diffuse") && !automatic) {
        fail(base.where(), fmt::format("{} has neither 'specular' nor 'diffuse'; write for instance "
                                       "diffuse = {{ model = \"lambert\", albedo = 0.5 }}",
                                       base.title()));
    }
}

Layer read_upper_layer(const TableReader& table, const std::filesystem::path& folder) {
    Layer layer;
    layer.where = table.where();
    layer.specular.model = SpecularModel::none;
    if (const TomlEntry* specular = table.find("specular")) {
        layer.specular = read_specular(*specular, table.title(), folder).specular;
    }
    if (const TomlEntry* absorption = table.find("absorption")) {
        layer.absorption = read_absorption(absorption->value);
    }
    return layer;
}

/// What an Oren-Nayar model without a shininess takes it from must exist.
void check_roughness(const TableReader& base, const Material& material, bool shininess_written) {
    if (!is_rough(material.diffuse.model) || material.diffuse.shininess.has_value()) {
        return;
    }
    const SpecularModel lobe = material.base().model;
    const TomlEntry* diffuse = base.find("diffuse");
    const SourceLocation& where = diffuse == nullptr ? base.where() : diffuse->value.where;
    if (lobe == SpecularModel::blinn_phong_anisotropic) {
        fail(where, fmt::format("diffuse of {}: {} needs a shininess, and the anisotropic lobe has two; add shininess "
                                "to diffuse",
                                base.title(), name_of(material.diffuse.model)));
    }
    if (lobe == SpecularModel::none && !shininess_written) {
        fail(where,
             fmt::format("diffuse of {}: {} needs a shininess, and there is no specular lobe to take it from; add "
                         "shininess to diffuse",
                         base.title(), name_of(material.diffuse.model)));
    }
}

/// Reads the last layer and the diffuse part.
AutomaticParameters read_base(const TableReader& table, const std::filesystem::path& folder, bool automatic,
                              Material& material) {
    SpecularSource specular;
    DiffuseSource diffuse;
    if (const TomlEntry* entry = table.find("specular")) {
        specular = read_specular(*entry, table.title(), folder);
    } else if (!automatic) {
        specular.specular.model = SpecularModel::none;
    }
    if (const TomlEntry* entry = table.find("diffuse")) {
        diffuse = read_diffuse(*entry, table.title());
    } else if (!automatic) {
        diffuse.diffuse.model = DiffuseModel::none;
    }
    Layer base;
    base.where = table.where();
    base.specular = std::move(specular.specular);
    material.layers.push_back(std::move(base));
    material.diffuse = std::move(diffuse.diffuse);
    check_roughness(table, material, specular.shininess_written);
    const SpecularModel lobe = material.base().model;
    AutomaticParameters flags;
    flags.albedo = automatic && !diffuse.albedo_written;
    flags.f0 = automatic && !specular.f0_written && lobe != SpecularModel::blinn_phong_spectral;
    flags.shininess = automatic && !specular.shininess_written && lobe != SpecularModel::blinn_phong_anisotropic;
    return flags;
}

bool is_none(const Layer& layer) {
    return layer.specular.model == SpecularModel::none;
}

void check_stack(const TableReader& table, const Material& material) {
    const std::vector<Layer>& layers = material.layers;
    if (material.diffuse.model == DiffuseModel::none && std::all_of(layers.begin(), layers.end(), is_none)) {
        fail(table.where(),
             layers.size() == 1
                 ? fmt::format("{} has model 'none' for both lobes and would be black; give one a model", table.title())
                 : fmt::format("{} has no lobe and no diffuse part in any of its {} layers and would be "
                               "black; give one a model",
                               table.title(), layers.size()));
    }
    // A metal's reflectance against the layer above is a table that is made before pixels are seen.
    for (std::size_t metal = 0; metal < layers.size(); ++metal) {
        if (layers[metal].specular.model != SpecularModel::blinn_phong_spectral) {
            continue;
        }
        for (std::size_t above = 0; above < metal; ++above) {
            const Specular& specular = layers[above].specular;
            if (specular.model != SpecularModel::none && specular.model != SpecularModel::blinn_phong_spectral &&
                !specular.f0.is_constant()) {
                fail(specular.f0.where,
                     fmt::format("layer {} of {} lies above the blinn_phong_spectral of layer {}, which needs a "
                                 "constant index above it; write numbers for its 'f0' or 'ior'",
                                 above + 1, table.title(), metal + 1));
            }
        }
    }
}

} // namespace

AutomaticParameters read_stack(const TableReader& table, const std::filesystem::path& folder, bool automatic,
                               Material& material) {
    const std::vector<TableReader> tables = layer_tables(table);
    material.layers.clear();
    for (std::size_t k = 0; k + 1 < tables.size(); ++k) {
        check_layer_above_base(tables[k], tables.size());
        material.layers.push_back(read_upper_layer(tables[k], folder));
    }
    check_base(tables.back(), tables.size(), automatic);
    const AutomaticParameters flags = read_base(tables.back(), folder, automatic, material);
    check_stack(table, material);
    return flags;
}

} // namespace clshade
