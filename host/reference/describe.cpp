#include "host/reference/angles.h"
#include "host/reference/environment_light.h"
#include "host/reference/lights.h"
#include "host/reference/radiance_filter.h"
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

/// What rule 11 looks up.
void add_environment(Description& description, const PreparedEnvironment& environment, const MaterialValues& material,
                     const Surface& surface) {
    const double x = std::max(glm::dot(surface.normal, surface.eye), 1e-4);
    description.emplace_back("environment.NE", x);
    add_vector(description, "environment.R", 2.0 * x * surface.normal - surface.eye, "XYZ");
    const glm::dvec3 irradiance = environment.diffuse_light(surface.normal, glm::dvec3(0.0)).all();
    add_vector(description, "environment.E/pi", irradiance, "RGB");
    const auto layers = material.layers();
    for (std::size_t k = 0; k < layers.size(); ++k) {
        if (layers[k].specular == SpecularModel::none) {
            continue;
        }
        const std::string name = fmt::format("layer{}", k + 1);
        description.emplace_back(name + ".mip", mip_of_shininess(ambient_shininess(layers[k]), sharpest_shininess,
                                                                 radiance_levels - 1, 1.0));
        add_vector(description, name + ".L", gathered_radiance(layers[k], environment, surface.normal, surface.eye),
                   "RGB");
    }
}

Description describe_empty(const PreparedFrame& prepared, int x, int y) {
    Description description{{"surface", 0.0}};
    if (prepared.environment() != nullptr && prepared.environment()->bound().background) {
        add_vector(description, "ray", ray_direction(prepared.frame(), x, y), "XYZ");
    }
    return description;
}

} // namespace

std::vector<std::pair<std::string, double>> describe_pixel(const Frame& frame, int x, int y) {
    const PreparedFrame prepared(frame);
    if (!all_finite(prepared, x, y)) {
        return {{"nonfinite", 1.0}};
    }
    const std::optional<Surface> surface = read_surface(frame, x, y);
    if (!surface) {
        return describe_empty(prepared, x, y);
    }
    Description description{{"coverage", surface->coverage}};
    add_vector(description, "N", surface->normal, "XYZ");
    add_vector(description, "E", surface->eye, "XYZ");
    if (surface->position) {
        add_vector(description, "position", *surface->position, "XYZ");
    }
    description.emplace_back("material", surface->material);
    const MaterialValues material = read_material(prepared, *surface, x, y);
    add_material(description, material);
    for (const Light& light : frame.lights) {
        add_light(description, light, *surface);
    }
    if (const PreparedEnvironment* environment = prepared.environment()) {
        add_environment(description, *environment, material, *surface);
    }
    return description;
}

} // namespace clshade::reference
