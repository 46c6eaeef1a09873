#include "host/gbuffer/frame.h"

#include <fmt/format.h>

#include <algorithm>

namespace clshade {

namespace {

void add_colour(std::vector<std::string>& names, const std::string& layer) {
    for (const char* component : {".R", ".G", ".B"}) {
        names.push_back(layer + component);
    }
}

/// "blinn_phong", or "blinn_phong+blinn_phong_exact" where the layers differ.
std::string lobes_key(const std::vector<BoundLayer>& layers) {
    const auto same = [&](const BoundLayer& layer) { return layer.specular == layers.front().specular; };
    if (std::all_of(layers.begin(), layers.end(), same)) {
        return std::string(name_of(layers.front().specular));
    }
    std::vector<std::string_view> names(layers.size());
    std::transform(layers.begin(), layers.end(), names.begin(),
                   [](const BoundLayer& layer) { return name_of(layer.specular); });
    return fmt::format("{}", fmt::join(names, "+"));
}

} // namespace

std::string model_key(const BoundMaterial& material) {
    const std::string lobes = fmt::format("{}.{}", lobes_key(material.layers), name_of(material.diffuse));
    if (material.layers.size() == 1) {
        return material.fresnel == FresnelModel::constant ? lobes : lobes + ".exact";
    }
    return fmt::format("layers{}.{}.{}.{}", material.layers.size(), lobes, name_of(material.fresnel),
                       name_of(material.absorption));
}

std::vector<std::string> output_plane_names(const Frame& frame, const AovSelection& aovs) {
    std::vector<std::string> names{"R", "G", "B", "A"};
    if (aovs.diffuse) {
        add_colour(names, "diffuse");
    }
    if (aovs.specular) {
        add_colour(names, "specular");
    }
    if (aovs.lights) {
        for (const Light& light : frame.lights) {
            add_colour(names, "light." + light.name);
        }
    }
    if (aovs.environment && frame.environment) {
        add_colour(names, "environment");
    }
    return names;
}

} // namespace clshade
