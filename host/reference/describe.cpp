#include "host/reference/angles.h"
#include "host/reference/lights.h"
#include "host/reference/reference.h"
#include "host/reference/surface.h"

#include <fmt/format.h>

#include <algorithm>

namespace clshade::reference {

namespace {

using Description = std::vector<std::pair<std::string, double>>;

void add_vector(Description& description, const std::string& name, const glm::dvec3& v, const char* suffixes) {
    for (int i = 0; i < 3; ++i) {
        description.emplace_back(fmt::format("{}.{}", name, suffixes[i]), v[i]);
    }
}

void add_layer(Description& description, const LayerValues& layer, const std::string& name, bool absorbs) {
    switch (layer.specular) {
    case SpecularModel::none:
        break;
    case SpecularModel::blinn_phong:
    case SpecularModel::blinn_phong_exact:
    case SpecularModel::blinn_phong_spectral:
        add_vector(description, name + ".f0", layer.f0, "RGB");
        description.emplace_back(name + ".shininess", layer.shininess);
        break;
    case SpecularModel::blinn_phong_anisotropic:
        add_vector(description, name + ".f0", layer.f0, "RGB");
        description.emplace_back(name + ".shininess_u", layer.shininess_u);
        description.emplace_back(name + ".shininess_v", layer.shininess_v);
        add_vector(description, name + ".T", layer.frame.tangent, "XYZ");
        break;
    }
    if (absorbs) {
        add_vector(description, name + ".absorption", layer.absorption, "RGB");
    }
}

void add_material(Description& description, const MaterialValues& material) {
    const auto layers = material.layers();
    for (std::size_t k = 0; k < layers.size(); ++k) {
        const bool absorbs = material.absorption != AbsorptionModel::none && k + 1 < layers.size();
        add_layer(description, layers[k], fmt::format("layer{}", k + 1), absorbs);
    }
    if (material.diffuse != DiffuseModel::none) {
        add_vector(description, "albedo", material.albedo, "RGB");
    }
    if (uses_diffuse_shininess(material.diffuse)) {
        description.emplace_back("diffuse_shininess", material.diffuse_shininess);
    }
}

void add_light(Description& description, const Light& light, const Surface& surface) {
    const Incident incident = incident_light(light, surface.position);
    const Angles angles = angles_between(surface.normal, surface.eye, incident.direction);
    description.emplace_back(light.name + ".NL", angles.nl);
    description.emplace_back(light.name + ".NE", angles.ne);
    description.emplace_back(light.name + ".NH", angles.nh);
    description.emplace_back(light.name + ".EH", angles.eh);
    add_vector(description, light.name + ".E0", incident.irradiance, "RGB");
}

} // namespace

std::vector<std::pair<std::string, double>> describe_pixel(const Frame& frame, int x, int y) {
    const PreparedFrame prepared(frame);
    if (!all_finite(prepared, x, y)) {
        return {{"nonfinite", 1.0}};
    }
    const std::optional<Surface> surface = read_surface(frame, x, y);
    if (!surface) {
        return {{"surface", 0.0}};
    }
    Description description{{"coverage", surface->coverage}};
    add_vector(description, "N", surface->normal, "XYZ");
    add_vector(description, "E", surface->eye, "XYZ");
    if (surface->position) {
        add_vector(description, "position", *surface->position, "XYZ");
    }
    description.emplace_back("material", surface->material);
    add_material(description, read_material(prepared, *surface, x, y));
    for (const Light& light : frame.lights) {
        add_light(description, light, *surface);
    }
    return description;
}

} // namespace clshade::reference
