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

void add_material(Description& description, const MaterialValues& material) {
    if (material.specular != SpecularModel::none) {
        add_vector(description, "f0", material.f0, "RGB");
        description.emplace_back("shininess", material.shininess);
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
    if (!all_finite(frame, planes_to_be_finite(frame), x, y)) {
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
    add_material(description, read_material(frame, *surface, x, y));
    for (const Light& light : frame.lights) {
        add_light(description, light, *surface);
    }
    return description;
}

} // namespace clshade::reference
