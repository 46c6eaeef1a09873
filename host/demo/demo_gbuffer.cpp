#include "host/demo/demo_gbuffer.h"

#include "host/demo/demo_stage.h"
#include "host/demo/demo_tracer.h"

#include <glm/gtc/constants.hpp>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace clshade {

namespace {

using demo::Hit;
using demo::Look;
using demo::Stage;

/// Planes in the order of plane_names.
enum Plane : int {
    normal_x,
    normal_y,
    normal_z,
    position_x,
    position_y,
    position_z,
    depth_z,
    albedo_r,
    albedo_g,
    albedo_b,
    f0_r,
    f0_g,
    f0_b,
    roughness_v,
    material_v,
    coverage_a,
    plane_count
};

/// Blender's depth where there is nothing.
constexpr float background_depth = 1e10F;

/// Samples along each side of a pixel that needs more than one.
constexpr int sample_side = 4;

/// Looks from the front, slightly above, and swings about the stage: 20 degrees over the sequence.
Camera demo_camera(int index, int count) {
    const double place = count > 1 ? static_cast<double>(index - 1) / (count - 1) - 0.5 : 0.0;
    const double azimuth = glm::radians(20.0) * place;
    const double elevation = glm::radians(20.0);
    const double distance = 12.2;
    const glm::dvec3 target(0.0, -0.15, 0.22);
    const glm::dvec3 back(std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation),
                          std::sin(elevation)); // from the target to the eye: the camera's +Z
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 0.0, 1.0), back));
    const glm::dvec3 up = glm::cross(back, right);
    Camera camera;
    camera.matrix_world = glm::dmat4(glm::dvec4(right, 0.0), glm::dvec4(up, 0.0), glm::dvec4(back, 0.0),
                                     glm::dvec4(target + distance * back, 1.0));
    camera.lens = Lens::fov_y;
    camera.lens_value = glm::radians(27.0);
    return camera;
}

/// Rays through the picture, x to the right and y downwards in pixels.
class RayMaker {
  public:
    RayMaker(const Camera& camera, int width, int height)
        : eye_(camera.matrix_world[3]), axis_(-glm::dvec3(camera.matrix_world[2])) {
        const double pixel = 2.0 * std::tan(0.5 * camera.lens_value) / height;
        dx_ = pixel * glm::dvec3(camera.matrix_world[0]);
        dy_ = -pixel * glm::dvec3(camera.matrix_world[1]);
        corner_ = axis_ - 0.5 * width * dx_ - 0.5 * height * dy_;
    }
    [[nodiscard]] glm::vec3 eye() const { return eye_; }
    [[nodiscard]] glm::vec3 axis() const { return axis_; }
    [[nodiscard]] glm::vec3 direction(double x, double y) const { return glm::normalize(corner_ + x * dx_ + y * dy_); }

  private:
    glm::dvec3 eye_, axis_, dx_{}, dy_{}, corner_{};
};

/// What one ray adds to the planes that renderers filter.
struct Sample {
    glm::vec3 normal{0.0F};
    Look look{glm::vec3(0.0F), glm::vec3(0.0F), 0.0F};
    float coverage = 0.0F;
};

Sample sample_of(const Stage& stage, const Hit& hit) {
    if (hit.object == nullptr) {
        return {};
    }
    Sample sample{hit.normal, demo::look_of(*hit.object, hit.point), 1.0F};
    const float open = stage.openness(hit.point, hit.normal);
    sample.look.albedo *= open;
    sample.look.f0 *= open;
    return sample;
}

/// One ray through the centre of every pixel.
struct CentrePass {
    int width;
    int height;
    std::vector<Hit> hits;
    std::vector<Sample> samples;

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// Whether two neighbouring pixels look so alike that one ray each is enough.
bool alike(const CentrePass& pass, std::size_t a, std::size_t b) {
    if (pass.hits[a].object != pass.hits[b].object) {
        return false;
    }
    if (pass.hits[a].object == nullptr) {
        return true;
    }
    const Sample& left = pass.samples[a];
    const Sample& right = pass.samples[b];
    return glm::dot(left.normal, right.normal) > 0.97F && glm::length(left.look.albedo - right.look.albedo) < 0.02F &&
           std::abs(left.look.roughness - right.look.roughness) < 0.03F;
}

bool needs_more_samples(const CentrePass& pass, int x, int y) {
    const std::size_t here = pass.index(x, y);
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, pass.height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, pass.width - 1); ++u) {
            if (!alike(pass, here, pass.index(u, v))) {
                return true;
            }
        }
    }
    return false;
}

/// The mean over the pixel; what a miss adds is zero, so that the mean is premultiplied by coverage.
Sample filtered_sample(const Stage& stage, const RayMaker& rays, int x, int y) {
    Sample sum;
    for (int j = 0; j < sample_side; ++j) {
        for (int i = 0; i < sample_side; ++i) {
            const glm::vec3 direction = rays.direction(x + (i + 0.5) / sample_side, y + (j + 0.5) / sample_side);
            const Sample sample = sample_of(stage, demo::trace(stage, rays.eye(), direction));
            sum.normal += sample.normal;
            sum.look.albedo += sample.look.albedo;
            sum.look.f0 += sample.look.f0;
            sum.look.roughness += sample.look.roughness;
            sum.coverage += sample.coverage;
        }
    }
    constexpr float share = 1.0F / (sample_side * sample_side);
    return {share * sum.normal,
            {share * sum.look.albedo, share * sum.look.f0, share * sum.look.roughness},
            share * sum.coverage};
}

void store(PlaneSlab& planes, int first, int x, int y, glm::vec3 value) {
    for (int c = 0; c < 3; ++c) {
        planes.at(first + c, x, y) = value[c];
    }
}

void store_pixel(PlaneSlab& planes, int x, int y, const Hit& centre, const Sample& filtered, const RayMaker& rays) {
    store(planes, normal_x, x, y, filtered.normal);
    store(planes, albedo_r, x, y, filtered.look.albedo);
    store(planes, f0_r, x, y, filtered.look.f0);
    planes.at(roughness_v, x, y) = filtered.look.roughness;
    planes.at(coverage_a, x, y) = filtered.coverage;
    const bool surface = centre.object != nullptr;
    store(planes, position_x, x, y, centre.point);
    planes.at(depth_z, x, y) = surface ? glm::dot(centre.point - rays.eye(), rays.axis()) : background_depth;
    planes.at(material_v, x, y) = surface ? static_cast<float>(centre.object->substance) : 0.0F;
}

void render(PlaneSlab& planes, const RayMaker& rays) {
    const Stage stage = demo::build_stage();
    CentrePass pass{planes.width(), planes.height(), {}, {}};
    const std::size_t pixels = static_cast<std::size_t>(pass.width) * static_cast<std::size_t>(pass.height);
    pass.hits.resize(pixels);
    pass.samples.resize(pixels);
    tbb::parallel_for(0, pass.height, [&](int y) {
        for (int x = 0; x < pass.width; ++x) {
            const std::size_t i = pass.index(x, y);
            pass.hits[i] = demo::trace(stage, rays.eye(), rays.direction(x + 0.5, y + 0.5));
            pass.samples[i] = sample_of(stage, pass.hits[i]);
        }
    });
    tbb::parallel_for(0, pass.height, [&](int y) {
        for (int x = 0; x < pass.width; ++x) {
            const std::size_t i = pass.index(x, y);
            const Sample filtered =
                needs_more_samples(pass, x, y) ? filtered_sample(stage, rays, x, y) : pass.samples[i];
            store_pixel(planes, x, y, pass.hits[i], filtered, rays);
        }
    });
}

} // namespace

DemoFrame render_demo_frame(int width, int height, int index, int count, int threads) {
    DemoFrame frame;
    frame.camera = demo_camera(index, count);
    frame.planes = PlaneSlab(width, height, plane_count);
    frame.plane_names = {"Normal.X", "Normal.Y",    "Normal.Z",     "Position.X", "Position.Y", "Position.Z",
                         "Depth.Z",  "Albedo.R",    "Albedo.G",     "Albedo.B",   "F0.R",       "F0.G",
                         "F0.B",     "Roughness.V", "MaterialID.V", "UV.A"};
    const RayMaker rays(frame.camera, width, height);
    // Every pixel is computed on its own, so that the number of threads does not change a byte.
    tbb::task_arena arena(std::clamp(threads, 1, tbb::info::default_concurrency()));
    arena.execute([&] { render(frame.planes, rays); });
    return frame;
}

} // namespace clshade
