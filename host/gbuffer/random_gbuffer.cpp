#include "host/gbuffer/random_gbuffer.h"

#include "host/base/error.h"
#include "host/base/rounding.h"
#include "host/gbuffer/random_materials.h"
#include "host/gbuffer/random_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

// "The same bytes on every machine": only + - * / and sqrt, which IEEE 754 fixes to the last bit, and no functions of
// the C library or distributions of the standard library. The build turns contraction into fused operations off.

namespace clshade {

namespace {

glm::dvec3 rounded(const glm::dvec3& v) {
    return {rounded_to_float(v.x), rounded_to_float(v.y), rounded_to_float(v.z)};
}

/// A perspective camera that looks across the origin; nothing about it is exactly representable in single precision.
View random_frame_view(int width, int height) {
    View view;
    view.has_rays = true;
    view.eye = {1.1, -3.7, 2.3};
    view.view_axis = glm::normalize(glm::dvec3(-0.2, 0.9, -0.5));
    const glm::dvec3 right = glm::normalize(glm::cross(view.view_axis, glm::dvec3(0.0, 0.0, 1.0)));
    const glm::dvec3 up = glm::cross(right, view.view_axis);
    view.camera_to_world = glm::dmat3(right, up, -view.view_axis);
    const double half_width = 1.0; // tangent of half the angle of view: 90 degrees over the width
    const double half_height = half_width * height / width;
    view.origin = view.eye;
    view.direction = view.view_axis - half_width * right + half_height * up;
    view.direction_dx = 2.0 * half_width / width * right;
    view.direction_dy = -2.0 * half_height / height * up;
    return view;
}

/// Two distant lights (one from before, one from behind the surfaces), a bulb in the midst of the positions and a lamp.
std::vector<Light> random_frame_lights(const View& view) {
    Light key;
    key.name = "key";
    key.direction = {0.3, 0.5, -0.8};
    key.power = {3.0, 2.85, 2.7};
    Light rim;
    rim.name = "rim";
    rim.direction = {-0.4, -0.9, -0.3};
    rim.power = {1.1, 1.2, 1.3};
    Light bulb;
    bulb.name = "bulb";
    bulb.type = LightType::point;
    bulb.position = view.eye + 5.3 * view.view_axis + glm::dvec3(0.7, 0.1, -0.3);
    bulb.power = {12.0, 14.0, 16.0};
    Light lamp;
    lamp.name = "lamp";
    lamp.type = LightType::spot;
    lamp.position = view.eye + 2.9 * view.view_axis + glm::dvec3(-0.6, 0.2, 3.1);
    lamp.direction = glm::dvec3(0.1, 0.7, -0.6);
    lamp.power = {40.0, 38.0, 36.0};
    lamp.cone_angle = 0.9;
    lamp.cone_softness = 0.35;
    return {key, rim, bulb, lamp};
}

bool near_a_light(const std::vector<Light>& lights, const glm::dvec3& position) {
    return std::any_of(lights.begin(), lights.end(), [&](const Light& light) {
        const glm::dvec3 path = light.position - position;
        return light.type != LightType::distant && glm::dot(path, path) < 0.25;
    });
}

/// Unit vector from the position to the light.
glm::dvec3 to_light(const Light& light, const glm::dvec3& position) {
    return light.type == LightType::distant ? -glm::normalize(light.direction)
                                            : glm::normalize(light.position - position);
}

/// Names planes and draws what is the same for all pixels.
void make_material(Frame& frame, const StackShape& shape, RandomGenerator& random) {
    PlaneNames names(frame.plane_names);
    frame.roles.normal = names.three("Normal", "XYZ");
    frame.roles.position = names.three("Position", "XYZ");
    frame.roles.coverage = names.one("Coverage");
    frame.materials = {random_material(shape, random, names)};
}

void put(Frame& frame, PlaneIndex plane, int x, int y, double value) {
    frame.planes.at(plane, x, y) = static_cast<float>(value);
}

void put(Frame& frame, const std::array<PlaneIndex, 3>& planes, int x, int y, const glm::dvec3& value) {
    for (int i = 0; i < 3; ++i) {
        put(frame, planes[static_cast<std::size_t>(i)], x, y, value[i]);
    }
}

void put(Frame& frame, const BoundParameter& parameter, int x, int y, const glm::dvec3& value) {
    if (!parameter.is_constant()) {
        put(frame, parameter.planes, x, y, value_of(parameter, value));
    }
}

using StackValues = std::array<LayerValues, most_layers>;

/// Shininess of one of the lobes, by chance: the one whose highlight a pixel may show.
double highlight_shininess(const BoundMaterial& material, const StackValues& values, RandomGenerator& random) {
    std::array<std::size_t, most_layers> lobes{};
    int count = 0;
    for (std::size_t k = 0; k < material.layers.size(); ++k) {
        if (material.layers[k].specular != SpecularModel::none) {
            lobes[static_cast<std::size_t>(count++)] = k;
        }
    }
    if (count == 0) {
        return values[material.layers.size() - 1].shininess;
    }
    const std::size_t k = lobes[static_cast<std::size_t>(random.below(count))];
    return lobe_shininess(material.layers[k], values[k], random);
}

/// Is the normal well away from every constant tangent (zero ones aside)? Planes are drawn so that they are.
bool suits_constant_tangents(const BoundMaterial& material, const glm::dvec3& normal) {
    return std::all_of(material.layers.begin(), material.layers.end(), [&](const BoundLayer& layer) {
        return !layer.tangent.is_constant() || is_sound_tangent(layer.tangent.constant, normal);
    });
}

void put_layer(Frame& frame, const BoundLayer& layer, const LayerValues& values, int x, int y, double coverage) {
    put(frame, layer.f0, x, y, values.f0 * coverage);
    put(frame, layer.absorption, x, y, values.absorption * coverage);
    put(frame, layer.shininess, x, y, glm::dvec3(values.shininess * coverage));
    put(frame, layer.shininess_u, x, y, glm::dvec3(values.shininess_u * coverage));
    put(frame, layer.shininess_v, x, y, glm::dvec3(values.shininess_v * coverage));
}

/// `random` alone decides a single isotropic layer, which so is what it was before there were stacks; `coats` decides
/// all that came with them.
void fill_pixel(Frame& frame, const StackShape& shape, RandomGenerator& random, RandomGenerator& coats, int x, int y) {
    const View& view = frame.view;
    const BoundMaterial& material = frame.materials.front();
    const glm::dvec3 ray = view.direction + (x + 0.5) * view.direction_dx + (y + 0.5) * view.direction_dy;
    glm::dvec3 position = rounded(view.origin + random.between(1.5, 9.5) * ray);
    while (near_a_light(frame.lights, position)) {
        position = rounded(view.origin + random.between(1.5, 9.5) * ray);
    }
    StackValues values;
    for (std::size_t k = 0; k < material.layers.size(); ++k) {
        values[k] = random_coat(coats, shape.largest_shininess);
    }
    LayerValues& base = values[material.layers.size() - 1];
    base.shininess = random_shininess(random, shape.largest_shininess);
    const double diffuse_n = random_shininess(random, shape.largest_shininess);
    base.f0 = random_colour(random);
    const glm::dvec3 albedo = random_colour(random);
    const double coverage = random_coverage(random);
    const Light& light = frame.lights[static_cast<std::size_t>(random.below(static_cast<int>(frame.lights.size())))];
    const double length = random.below(10) == 0 ? random.between(0.5, 2.0) : 1.0;
    const glm::dvec3 eye = glm::normalize(view.eye - position);
    const double n = highlight_shininess(material, values, coats);
    glm::dvec3 normal = random_normal(random, eye, to_light(light, position), n);
    while (!suits_constant_tangents(material, normal)) {
        normal = random_normal(random, eye, to_light(light, position), n);
    }

    const double normal2 = glm::dot(normal, normal);
    put(frame, frame.roles.normal, x, y, normal2 > 0.0 ? length / std::sqrt(normal2) * normal : normal);
    put(frame, frame.roles.position, x, y, position);
    put(frame, frame.roles.coverage, x, y, coverage);
    // Parameters are premultiplied, as filtered render passes are.
    put(frame, material.albedo, x, y, albedo * coverage);
    put(frame, material.diffuse_shininess, x, y, glm::dvec3(diffuse_n * coverage));
    for (std::size_t k = 0; k < material.layers.size(); ++k) {
        put_layer(frame, material.layers[k], values[k], x, y, coverage);
        put(frame, material.layers[k].tangent, x, y, random_tangent(coats, normal) * coverage);
    }
}

} // namespace

Frame random_frame(int width, int height, const StackShape& shape, std::uint64_t seed) {
    if (shape.layers.empty() || shape.layers.size() > most_layers) {
        throw UsageError(fmt::format("a random stack has 1 to {} layers, not {}", most_layers, shape.layers.size()));
    }
    Frame frame;
    frame.file = fmt::format("random G-buffer (seed {})", seed);
    frame.data_window = {0, 0, width - 1, height - 1};
    frame.display_window = frame.data_window;
    frame.view = random_frame_view(width, height);
    frame.lights = random_frame_lights(frame.view);
    RandomGenerator random(seed);
    RandomGenerator coats(seed ^ 0x6c61796572656421U); // any other sequence
    make_material(frame, shape, coats);
    frame.planes = PlaneSlab(width, height, static_cast<int>(frame.plane_names.size()));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            fill_pixel(frame, shape, random, coats, x, y);
        }
    }
    return frame;
}

Frame random_frame(int width, int height, SpecularModel specular, DiffuseModel diffuse, std::uint64_t seed) {
    StackShape shape;
    shape.layers = {specular};
    shape.diffuse = diffuse;
    return random_frame(width, height, shape, seed);
}

StackShape random_shape(std::uint64_t seed) {
    RandomGenerator random(seed);
    const auto one_of = [&](const auto& choices) {
        return choices[static_cast<std::size_t>(random.below(static_cast<int>(choices.size())))];
    };
    StackShape shape;
    shape.layers.resize(1 + static_cast<std::size_t>(random.below(static_cast<int>(most_layers))));
    for (SpecularModel& lobe : shape.layers) {
        lobe = one_of(all_specular_models);
    }
    shape.diffuse = one_of(all_diffuse_models);
    shape.fresnel = random.below(2) == 0 ? FresnelModel::constant : FresnelModel::exact;
    shape.absorption = one_of(all_absorption_models);
    shape.some_constant = random.below(2) == 0;
    while (shape.layers.back() == SpecularModel::none && shape.diffuse == DiffuseModel::none) {
        shape.layers.back() = one_of(all_specular_models);
    }
    shape.absorption_ibl = one_of(all_ambient_absorptions);
    shape.transmittance_ibl = one_of(all_ambient_transmittances);
    shape.ambient = one_of(all_ambient_diffuses);
    return shape;
}

void add_random_environment(Frame& frame, std::shared_ptr<const LatLong> image, AmbientSource diffuse,
                            std::uint64_t seed) {
    RandomGenerator random(seed ^ 0x656e7669726f6e21U); // any other sequence than random_frame's
    BoundEnvironment environment;
    environment.world_to_image = random_rotation(random);
    for (int i = 0; i < 3; ++i) {
        environment.intensity[i] = random.between(0.5, 2.0);
    }
    environment.diffuse = diffuse;
    environment.image = std::move(image);
    frame.environment = std::move(environment);
}

} // namespace clshade
