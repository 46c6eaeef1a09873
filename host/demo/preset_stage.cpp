#include "host/demo/preset_stage.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace clshade {

namespace {

enum Plane : int { normal_x, position_x = 3, albedo_r = 6, material_v = 9, plane_count };

/// Union of two shapes with a fillet of size k between them.
double smooth_min(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - 0.25 * h * h * k;
}

/// What b cuts out of a, edges rounded.
double smooth_cut(double a, double b, double k) {
    return -smooth_min(-a, b, k);
}

/// A disc about the axis with rounded edges, in the plane (distance from the axis, height).
double disc(glm::dvec2 q, double height, double radius, double half_height, double rounding) {
    const glm::dvec2 d(q.x - radius + rounding, std::abs(q.y - height) - half_height + rounding);
    return std::min(std::max(d.x, d.y), 0.0) + glm::length(glm::max(d, glm::dvec2(0.0))) - rounding;
}

/// A ball with a groove and a belt, on a foot: signed distance, turned about Z.
double body(const glm::dvec3& p) {
    const glm::dvec2 q(glm::length(glm::dvec2(p)), p.z);
    const glm::dvec2 centre(0.0, 1.22);
    const auto ring = [&](double latitude_degrees, double radius) {
        const double latitude = glm::radians(latitude_degrees);
        return glm::length(q - centre - glm::dvec2(std::cos(latitude), std::sin(latitude))) - radius;
    };
    double distance = glm::length(q - centre) - 1.0;
    distance = smooth_cut(distance, ring(38.0, 0.085), 0.05);
    distance = smooth_min(distance, ring(-16.0, 0.085), 0.06);
    return smooth_min(distance, disc(q, 0.14, 0.78, 0.14, 0.06), 0.08);
}

constexpr double wall_distance = 4.5;

/// Floor and back wall with a round corner, as in a photographer's studio.
double room(const glm::dvec3& p) {
    return smooth_min(p.z, wall_distance - p.y, 5.0);
}

double stage(const glm::dvec3& p) {
    return std::min(body(p), room(p));
}

glm::dvec3 normal_at(const glm::dvec3& p) {
    constexpr double step = 1e-4; // of a body of size 2: round-off and curvature both stay below 1e-7
    const glm::dvec3 dx(step, 0.0, 0.0);
    const glm::dvec3 dy(0.0, step, 0.0);
    const glm::dvec3 dz(0.0, 0.0, step);
    return glm::normalize(
        glm::dvec3(stage(p + dx) - stage(p - dx), stage(p + dy) - stage(p - dy), stage(p + dz) - stage(p - dz)));
}

/// The first surface along a ray; rays of this camera all meet something.
glm::dvec3 meet(const glm::dvec3& origin, const glm::dvec3& direction) {
    constexpr int most_steps = 400;
    constexpr double close = 1e-6;
    double t = 0.0;
    for (int step = 0; step < most_steps; ++step) {
        const double distance = stage(origin + t * direction);
        if (distance < close) {
            break;
        }
        t += 0.9 * distance; // fillets stretch distances a little
    }
    return origin + t * direction;
}

const glm::dvec3 to_key = glm::normalize(glm::dvec3(-0.62, -0.62, 0.78));

/// 0..1: how much of the key light's soft box a point of the floor sees past the body (Quilez, "Soft shadows in ray
/// marched SDFs").
double seen_of_key(const glm::dvec3& p) {
    constexpr double width = 0.22; // of the box, as an angle
    double seen = 1.0;
    double t = 0.02;
    while (t < 8.0 && seen > 0.0) {
        const double distance = body(p + t * to_key);
        seen = std::min(seen, 0.5 + 0.5 * distance / (width * t));
        t += std::clamp(0.5 * std::abs(distance), 0.02, 0.2);
    }
    seen = std::max(seen, 0.0);
    return seen * seen * (3.0 - 2.0 * seen);
}

/// 0..1: how open the room is above a point of the floor.
double openness(const glm::dvec3& p, const glm::dvec3& normal) {
    double blocked = 0.0;
    double weight = 0.5;
    for (const double reach : {0.06, 0.15, 0.35, 0.8}) {
        blocked += weight * std::max(reach - body(p + reach * normal), 0.0) / reach;
        weight *= 0.8;
    }
    return std::clamp(1.0 - 0.75 * blocked, 0.1, 1.0);
}

/// Punctual lights cast no shadows: they are painted on the floor.
double floor_albedo(const glm::dvec3& p, const glm::dvec3& normal) {
    constexpr double share_of_key = 0.6;
    return 0.42 * openness(p, normal) * (1.0 - share_of_key + share_of_key * seen_of_key(p));
}

Camera stage_camera() {
    const double elevation = glm::radians(16.0);
    const double distance = 8.6;
    const glm::dvec3 target(0.0, 0.0, 1.06);
    const glm::dvec3 back(0.0, -std::cos(elevation), std::sin(elevation));
    const glm::dvec3 right(1.0, 0.0, 0.0);
    Camera camera;
    camera.matrix_world = glm::dmat4(glm::dvec4(right, 0.0), glm::dvec4(glm::cross(back, right), 0.0),
                                     glm::dvec4(back, 0.0), glm::dvec4(target + distance * back, 1.0));
    camera.lens = Lens::fov_y;
    camera.lens_value = glm::radians(19.0);
    return camera;
}

void store(PlaneSlab& planes, int first, int x, int y, const glm::dvec3& value) {
    for (int c = 0; c < 3; ++c) {
        planes.at(first + c, x, y) = static_cast<float>(value[c]);
    }
}

void render_row(PlaneSlab& planes, const Camera& camera, int y) {
    const int size = planes.width();
    const glm::dvec3 eye(camera.matrix_world[3]);
    const double half = std::tan(0.5 * camera.lens_value);
    for (int x = 0; x < size; ++x) {
        const double u = (2.0 * (x + 0.5) / size - 1.0) * half;
        const double v = (1.0 - 2.0 * (y + 0.5) / size) * half;
        const glm::dvec3 point = meet(eye, glm::normalize(glm::dmat3(camera.matrix_world) * glm::dvec3(u, v, -1.0)));
        const glm::dvec3 normal = normal_at(point);
        const bool is_body = body(point) < room(point);
        store(planes, normal_x, x, y, normal);
        store(planes, position_x, x, y, point);
        store(planes, albedo_r, x, y, glm::dvec3(is_body ? 0.0 : floor_albedo(point, normal)));
        planes.at(material_v, x, y) = is_body ? 1.0F : 0.0F;
    }
}

/// 1 within `inner` of zero, 0 from `outer` on, smooth between.
double window_of(double x, double inner, double outer) {
    const double t = std::clamp((outer - std::abs(x)) / (outer - inner), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// A rectangular box of light about the direction `centre`, edges along the horizon; half sizes are tangents.
double soft_box(const glm::dvec3& direction, const glm::dvec3& centre, double half_width, double half_height) {
    const glm::dvec3 right = glm::normalize(glm::cross(centre, glm::dvec3(0.0, 0.0, 1.0)));
    const glm::dvec3 up = glm::cross(right, centre);
    const double depth = glm::dot(direction, centre);
    if (depth <= 0.0) {
        return 0.0;
    }
    return window_of(glm::dot(direction, right) / depth, 0.8 * half_width, 1.2 * half_width) *
           window_of(glm::dot(direction, up) / depth, 0.8 * half_height, 1.2 * half_height);
}

/// What the studio sends from a direction (pointing away from the body): radiance.
glm::dvec3 studio(const glm::dvec3& direction) {
    const glm::dvec3 rim = glm::normalize(glm::dvec3(0.9, 0.7, 0.35));
    const glm::dvec3 back = glm::normalize(glm::dvec3(-0.95, 0.75, 0.5));
    const glm::dvec3 fill = glm::normalize(glm::dvec3(0.9, -0.8, 0.2));
    const double height = direction.z;
    glm::dvec3 light = height > 0.0 ? glm::mix(glm::dvec3(0.08, 0.085, 0.09), glm::dvec3(0.34, 0.35, 0.37), height)
                                    : glm::mix(glm::dvec3(0.08, 0.076, 0.07), glm::dvec3(0.16, 0.15, 0.135), -height);
    light += 3.2 * soft_box(direction, to_key, 0.62, 0.66) * glm::dvec3(1.0, 0.975, 0.94);
    light += 3.4 * soft_box(direction, rim, 0.22, 1.0) * glm::dvec3(0.94, 0.97, 1.0);
    light += 2.4 * soft_box(direction, back, 0.2, 0.9) * glm::dvec3(0.94, 0.97, 1.0);
    light += 0.8 * soft_box(direction, fill, 0.35, 0.8) * glm::dvec3(0.96, 0.98, 1.0);
    return light;
}

} // namespace

DemoFrame render_preset_stage(int size, int threads) {
    DemoFrame frame;
    frame.camera = stage_camera();
    frame.planes = PlaneSlab(size, size, plane_count);
    frame.plane_names = {"Normal.X",   "Normal.Y", "Normal.Z", "Position.X", "Position.Y",
                         "Position.Z", "Albedo.R", "Albedo.G", "Albedo.B",   "MaterialID.V"};
    tbb::task_arena arena(std::clamp(threads, 1, tbb::info::default_concurrency()));
    arena.execute([&] { tbb::parallel_for(0, size, [&](int y) { render_row(frame.planes, frame.camera, y); }); });
    return frame;
}

std::string preset_stage_materials(std::string_view preset) {
    return fmt::format("version = 1\n"
                       "[material.default]\n"
                       "diffuse = {{ model = \"lambert\", albedo = \"albedo\" }}\n"
                       "[material.body]\n"
                       "ids = [1]\n"
                       "preset = \"{}\"\n"
                       "[[light]] # replaced by those of the studio\n"
                       "type = \"distant\"\ndirection = [0, 0, -1]\nirradiance = 1.0\n",
                       preset);
}

std::vector<Light> preset_stage_lights() {
    // Directions on a spiral cover the sphere evenly (Swinbank and Purser, "Fibonacci grids", 2006): 6400 lie 2.5
    // degrees apart. The sharpest preset (shininess 2048) has highlights 6 degrees wide, narrower towards grazing
    // angles.
    constexpr int count = 6400;
    const double golden_angle = glm::pi<double>() * (3.0 - std::sqrt(5.0));
    std::vector<Light> lights;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / count;
        const double r = std::sqrt(1.0 - z * z);
        const glm::dvec3 direction(r * std::cos(golden_angle * i), r * std::sin(golden_angle * i), z);
        Light light;
        light.name = fmt::format("studio{}", i + 1);
        light.direction = -direction;
        light.power = 4.0 * glm::pi<double>() / count * studio(direction);
        lights.push_back(light);
    }
    return lights;
}

} // namespace clshade
