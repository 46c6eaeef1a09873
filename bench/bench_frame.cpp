#include "bench/bench_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

namespace clshade {

namespace {

constexpr double picture_height = 4.0; ///< world units across the picture's height
constexpr double eye_distance = 6.0;
constexpr int id_tile = 16;
constexpr int id_count = 4;

/// A sum of three waves along one axis, and its slope, for each pixel of that axis.
struct Waves {
    std::vector<double> height;
    std::vector<double> slope;
};

/// Numbers in [0, 1) that are the same on every machine.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double next() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }

  private:
    std::mt19937_64 engine_;
};

/// Waves of 2, 4 and 8 periods over the extent, slopes up to about 45 degrees together.
Waves make_waves(int pixels, double extent, Random& random) {
    Waves waves{std::vector<double>(static_cast<std::size_t>(pixels)),
                std::vector<double>(static_cast<std::size_t>(pixels))};
    for (const double periods : {2.0, 4.0, 8.0}) {
        const double wave_number = 2.0 * std::numbers::pi * periods / extent;
        const double amplitude = 0.35 / wave_number;
        const double phase = 2.0 * std::numbers::pi * random.next();
        for (int i = 0; i < pixels; ++i) {
            const double angle = wave_number * extent * (i + 0.5) / pixels + phase;
            waves.height[static_cast<std::size_t>(i)] += amplitude * std::sin(angle);
            waves.slope[static_cast<std::size_t>(i)] += amplitude * wave_number * std::cos(angle);
        }
    }
    return waves;
}

/// 0..1, smooth along one axis: for the materials.
std::vector<double> make_blend(int pixels, double periods, Random& random) {
    std::vector<double> blend(static_cast<std::size_t>(pixels));
    const double phase = random.next();
    for (int i = 0; i < pixels; ++i) {
        blend[static_cast<std::size_t>(i)] =
            0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * (periods * (i + 0.5) / pixels + phase));
    }
    return blend;
}

struct SurfacePoint {
    glm::dvec3 position;
    glm::dvec3 normal;
};

/// The wavy ground, or the sphere of the grid cell (edge 1, radius 0.35) that covers the point.
SurfacePoint surface_at(double x, double y, double height, double slope_x, double slope_y) {
    const double cell_x = x - std::floor(x) - 0.5;
    const double cell_y = y - std::floor(y) - 0.5;
    const double from_centre = cell_x * cell_x + cell_y * cell_y;
    constexpr double radius = 0.35;
    if (from_centre < radius * radius) {
        const double rise = std::sqrt(radius * radius - from_centre);
        return {{x, y, 0.3 + rise}, glm::dvec3(cell_x, cell_y, rise) / radius};
    }
    return {{x, y, height}, glm::normalize(glm::dvec3(-slope_x, -slope_y, 1.0))};
}

View bench_view(int width, int height) {
    View view;
    view.has_rays = true;
    view.eye = {0.0, 0.0, eye_distance};
    view.view_axis = {0.0, 0.0, -1.0};
    view.origin = view.eye;
    const double step = picture_height / height / eye_distance;
    view.direction = {-0.5 * width * step, 0.5 * height * step, -1.0};
    view.direction_dx = {step, 0.0, 0.0};
    view.direction_dy = {0.0, -step, 0.0};
    return view;
}

Light light_of(LightType type, const std::string& name, glm::dvec3 direction, glm::dvec3 power) {
    Light light;
    light.name = name;
    light.type = type;
    light.direction = direction;
    light.power = power;
    return light;
}

std::vector<Light> lights_of(BenchLights lights) {
    switch (lights) {
    case BenchLights::none:
        return {};
    case BenchLights::distant1:
        return {light_of(LightType::distant, "key", {0.4, -0.5, -0.8}, {3.0, 2.9, 2.7})};
    case BenchLights::distant8: {
        std::vector<Light> ring;
        for (int i = 0; i < 8; ++i) {
            const double azimuth = 2.0 * std::numbers::pi * (i + 0.25) / 8.0;
            ring.push_back(light_of(LightType::distant, fmt::format("ring{}", i + 1),
                                    {0.8 * std::cos(azimuth), 0.8 * std::sin(azimuth), -0.4 - 0.1 * i},
                                    {0.3 + 0.05 * i, 0.5, 0.7 - 0.05 * i}));
        }
        return ring;
    }
    case BenchLights::point1: {
        Light lamp = light_of(LightType::point, "lamp", {0.0, 0.0, -1.0}, {30.0, 28.0, 24.0});
        lamp.position = {-1.0, 1.0, 3.0};
        return {lamp};
    }
    case BenchLights::spot1: {
        Light lamp = light_of(LightType::spot, "spot", {0.2, -0.2, -1.0}, {40.0, 40.0, 36.0});
        lamp.position = {-0.6, 0.6, 3.5};
        lamp.cone_angle = 0.6;
        lamp.cone_softness = 0.3;
        return {lamp};
    }
    }
    return {};
}

} // namespace

Frame make_bench_frame(int width, int height, std::uint64_t seed) {
    Frame frame;
    frame.file = "bench";
    frame.data_window = {0, 0, width - 1, height - 1};
    frame.display_window = frame.data_window;
    frame.planes = PlaneSlab(width, height, bench_planes);
    frame.plane_names = {"N.X",      "N.Y",  "N.Z",  "P.X",  "P.Y",       "P.Z", "albedo.R",    "albedo.G",
                         "albedo.B", "f0.R", "f0.G", "f0.B", "shininess", "id",  "id.scattered"};
    frame.roles.normal = {bench_normal, bench_normal + 1, bench_normal + 2};
    frame.roles.position = {bench_position, bench_position + 1, bench_position + 2};
    frame.view = bench_view(width, height);

    Random random(seed);
    const double picture_width = picture_height * width / height;
    const Waves along_x = make_waves(width, picture_width, random);
    const Waves along_y = make_waves(height, picture_height, random);
    std::array<std::vector<double>, 4> blend_x;
    std::array<std::vector<double>, 4> blend_y;
    for (std::size_t i = 0; i < blend_x.size(); ++i) {
        blend_x[i] = make_blend(width, 1.0 + 0.7 * static_cast<double>(i), random);
        blend_y[i] = make_blend(height, 1.3 + 0.5 * static_cast<double>(i), random);
    }

    Random scatter(seed + 1);
    for (int y = 0; y < height; ++y) {
        const auto row = static_cast<std::size_t>(y);
        for (int x = 0; x < width; ++x) {
            const auto column = static_cast<std::size_t>(x);
            const auto blend = [&](std::size_t i) { return 0.5 * (blend_x[i][column] + blend_y[i][row]); };
            const SurfacePoint point =
                surface_at(picture_width * ((x + 0.5) / width - 0.5), picture_height * (0.5 - (y + 0.5) / height),
                           along_x.height[column] + along_y.height[row], along_x.slope[column], -along_y.slope[row]);
            // Seen in perspective: the height moves the point along its pixel's ray.
            const glm::dvec3 on_ground(point.position.x, point.position.y, 0.0);
            const glm::dvec3 position = glm::mix(on_ground, frame.view.eye, point.position.z / eye_distance);
            const glm::dvec3 albedo = 0.05 + 0.85 * glm::dvec3(blend(0), blend(1), blend(2));
            const double metal = blend(3);
            const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), glm::dvec3(0.95, 0.8, 0.5), metal * metal);
            const double shininess = std::exp2(3.0 + 5.0 * blend(1));
            const std::array<double, bench_planes> values = {
                point.normal.x,
                point.normal.y,
                point.normal.z,
                position.x,
                position.y,
                position.z,
                albedo.r,
                albedo.g,
                albedo.b,
                f0.r,
                f0.g,
                f0.b,
                shininess,
                static_cast<double>((x / id_tile + 3 * (y / id_tile)) % id_count + 1),
                1.0 + std::floor(id_count * scatter.next())};
            for (int p = 0; p < bench_planes; ++p) {
                frame.planes.at(p, x, y) = static_cast<float>(values[static_cast<std::size_t>(p)]);
            }
        }
    }
    apply_scene(frame, {});
    return frame;
}

void apply_scene(Frame& frame, const BenchScene& scene, const std::optional<BoundEnvironment>& environment) {
    if (scene.environment && !environment) {
        throw std::invalid_argument("a bench scene with an environment needs one");
    }
    frame.environment = scene.environment ? environment : std::nullopt;
    frame.lights = lights_of(scene.lights);
    frame.materials = scene.materials;
    frame.roles.material_id = no_plane;
    if (scene.materials.size() > 1) {
        frame.roles.material_id = scene.ids == BenchIds::tiles ? bench_tile_ids : bench_scattered_ids;
        for (std::size_t i = 0; i < frame.materials.size(); ++i) {
            frame.materials[i].ids = {static_cast<std::int64_t>(i) + 1};
        }
    }
}

} // namespace clshade
