#include "host/gbuffer/random_gbuffer.h"

#include "host/base/rounding.h"

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

/// splitmix64 (Steele, Lea, Flood 2014).
class Generator {
  public:
    explicit Generator(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() {
        state_ += 0x9e3779b97f4a7c15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31U);
    }
    /// 0 <= x < 1, multiples of 2^-53.
    double unit() { return static_cast<double>(next() >> 11U) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
    glm::dvec3 in_unit_ball() {
        for (;;) {
            const double x = between(-1.0, 1.0);
            const double y = between(-1.0, 1.0);
            const double z = between(-1.0, 1.0);
            if (x * x + y * y + z * z <= 1.0) {
                return {x, y, z};
            }
        }
    }
    glm::dvec3 direction() {
        for (;;) {
            const glm::dvec3 v = in_unit_ball();
            if (glm::dot(v, v) > 1e-4) {
                return glm::normalize(v);
            }
        }
    }

  private:
    std::uint64_t state_;
};

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

/// 0 and 65536 each in one pixel of 16; else log-uniform (uniform within each octave) from 2^-4 to 2^16.
double random_shininess(Generator& random) {
    const int end = random.below(16);
    const int octave = random.below(20);
    double n = (1.0 + random.unit()) / 16.0;
    for (int i = 0; i < octave; ++i) {
        n *= 2.0;
    }
    if (end == 0) {
        return 0.0;
    }
    return end == 1 ? 65536.0 : n;
}

/// 0 and 1 each in one pixel of 10, equal components in three, else anything in 0..1.
glm::dvec3 random_colour(Generator& random) {
    const int kind = random.below(10);
    const glm::dvec3 colour{random.unit(), random.unit(), random.unit()}; // braces: evaluated in this order
    if (kind < 2) {
        return glm::dvec3(kind);
    }
    return kind < 5 ? glm::dvec3(colour.x) : colour;
}

/// 0 in one pixel of 20, partial in five, else 1.
double random_coverage(Generator& random) {
    const int kind = random.below(20);
    const double partial = random.between(1.0 / 256.0, 1.0);
    if (kind == 0) {
        return 0.0;
    }
    return kind < 6 ? rounded_to_float(partial) : 1.0;
}

/// A vector at right angles to `axis`, pushed towards it by up to `reach` either way.
glm::dvec3 grazing(Generator& random, const glm::dvec3& axis, double reach) {
    const glm::dvec3 any = random.direction();
    const double push = random.between(-reach, reach);
    return any - glm::dot(any, axis) * axis + push * axis;
}

/// The normal that mirrors E into L, off by a few widths 1/sqrt(n) of the lobe.
glm::dvec3 near_mirror(Generator& random, const glm::dvec3& eye, const glm::dvec3& light, double n) {
    const double spread = random.between(0.0, 3.0) / std::sqrt(n + 1.0);
    const glm::dvec3 aside = random.in_unit_ball();
    const glm::dvec3 half = eye + light;
    if (glm::dot(half, half) < 1e-4) {
        return eye + spread * aside;
    }
    return glm::normalize(half) + spread * aside;
}

glm::dvec3 random_normal(Generator& random, const glm::dvec3& eye, const glm::dvec3& light, double n) {
    const int kind = random.below(50);
    if (kind == 0) {
        return glm::dvec3(0.0);
    }
    if (kind < 6) {
        return grazing(random, eye, kind < 4 ? 0.1 : 0.001);
    }
    if (kind < 12) {
        return grazing(random, light, kind < 10 ? 0.1 : 0.001);
    }
    if (kind < 32) {
        return near_mirror(random, eye, light, n);
    }
    const glm::dvec3 any = random.direction();
    const bool back_facing = kind < 36;
    return (glm::dot(any, eye) < 0.0) == back_facing ? any : -any;
}

/// Adds planes to a frame under construction.
class PlaneNames {
  public:
    explicit PlaneNames(std::vector<std::string>& names) : names_(&names) {}
    PlaneIndex one(const std::string& name) {
        names_->push_back(name);
        return static_cast<PlaneIndex>(names_->size()) - 1;
    }
    std::array<PlaneIndex, 3> three(const std::string& layer, const char* suffixes) {
        std::array<PlaneIndex, 3> planes{};
        for (std::size_t i = 0; i < planes.size(); ++i) {
            planes[i] = one(layer + "." + suffixes[i]);
        }
        return planes;
    }

  private:
    std::vector<std::string>* names_;
};

BoundParameter bound_to(const std::array<PlaneIndex, 3>& planes) {
    BoundParameter parameter;
    parameter.planes = planes;
    return parameter;
}

BoundParameter bound_to(PlaneIndex plane) {
    return bound_to(std::array<PlaneIndex, 3>{plane, plane, plane});
}

void name_planes(Frame& frame, SpecularModel specular, DiffuseModel diffuse) {
    PlaneNames names(frame.plane_names);
    frame.roles.normal = names.three("Normal", "XYZ");
    frame.roles.position = names.three("Position", "XYZ");
    frame.roles.coverage = names.one("Coverage");
    BoundMaterial material;
    material.name = "default";
    material.specular = specular;
    material.diffuse = diffuse;
    if (diffuse != DiffuseModel::none) {
        material.albedo = bound_to(names.three("Albedo", "RGB"));
    }
    if (specular != SpecularModel::none) {
        material.f0 = bound_to(names.three("F0", "RGB"));
        material.shininess = bound_to(names.one("Shininess"));
    }
    if (diffuse != DiffuseModel::none && diffuse != DiffuseModel::lambert) {
        material.diffuse_shininess = bound_to(names.one("DiffuseShininess"));
    }
    frame.materials = {std::move(material)};
}

void put(Frame& frame, PlaneIndex plane, int x, int y, double value) {
    if (plane != no_plane) {
        frame.planes.at(plane, x, y) = static_cast<float>(value);
    }
}

void put(Frame& frame, const std::array<PlaneIndex, 3>& planes, int x, int y, const glm::dvec3& value) {
    for (int i = 0; i < 3; ++i) {
        put(frame, planes[static_cast<std::size_t>(i)], x, y, value[i]);
    }
}

void fill_pixel(Frame& frame, Generator& random, int x, int y) {
    const View& view = frame.view;
    const glm::dvec3 ray = view.direction + (x + 0.5) * view.direction_dx + (y + 0.5) * view.direction_dy;
    glm::dvec3 position = rounded(view.origin + random.between(1.5, 9.5) * ray);
    while (near_a_light(frame.lights, position)) {
        position = rounded(view.origin + random.between(1.5, 9.5) * ray);
    }
    const double n = random_shininess(random);
    const double diffuse_n = random_shininess(random);
    const glm::dvec3 f0 = random_colour(random);
    const glm::dvec3 albedo = random_colour(random);
    const double coverage = random_coverage(random);
    const Light& light = frame.lights[static_cast<std::size_t>(random.below(static_cast<int>(frame.lights.size())))];
    const double length = random.below(10) == 0 ? random.between(0.5, 2.0) : 1.0;
    const glm::dvec3 eye = glm::normalize(view.eye - position);
    const glm::dvec3 normal = random_normal(random, eye, to_light(light, position), n);

    const BoundMaterial& material = frame.materials.front();
    const double normal2 = glm::dot(normal, normal);
    put(frame, frame.roles.normal, x, y, normal2 > 0.0 ? length / std::sqrt(normal2) * normal : normal);
    put(frame, frame.roles.position, x, y, position);
    put(frame, frame.roles.coverage, x, y, coverage);
    // Parameters are premultiplied, as filtered render passes are.
    put(frame, material.albedo.planes, x, y, albedo * coverage);
    put(frame, material.f0.planes, x, y, f0 * coverage);
    put(frame, material.shininess.planes[0], x, y, n * coverage);
    put(frame, material.diffuse_shininess.planes[0], x, y, diffuse_n * coverage);
}

} // namespace

Frame random_frame(int width, int height, SpecularModel specular, DiffuseModel diffuse, std::uint64_t seed) {
    Frame frame;
    frame.file = fmt::format("random G-buffer (seed {})", seed);
    frame.data_window = {0, 0, width - 1, height - 1};
    frame.display_window = frame.data_window;
    frame.view = random_frame_view(width, height);
    frame.lights = random_frame_lights(frame.view);
    name_planes(frame, specular, diffuse);
    frame.planes = PlaneSlab(width, height, static_cast<int>(frame.plane_names.size()));
    Generator random(seed);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            fill_pixel(frame, random, x, y);
        }
    }
    return frame;
}

} // namespace clshade
