#include "bench/batch_sequence.h"

#include "host/images/image_writer.h"

#include <glm/glm.hpp>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 16> channels{"N.X",  "N.Y",       "N.Z",      "P.X",        "P.Y",  "P.Z",
                                                    "Z",    "albedo.R",  "albedo.G", "albedo.B",   "f0.R", "f0.G",
                                                    "f0.B", "roughness", "coverage", "material_id"};

constexpr float sky_depth = 65504.0F; ///< the largest half; beyond 6e4 is background
constexpr float far_ground = 40.0F;
constexpr double fov_y = 0.7;

/// Where a frame is seen from.
struct Eye {
    glm::dvec3 place;
    glm::dmat3 axes; ///< right, up, forward
};

Eye eye_of(int index) {
    const double azimuth = 0.02 * index;
    const glm::dvec3 target(0.0, 0.0, 0.9);
    const glm::dvec3 place = target + glm::dvec3(7.0 * std::sin(azimuth), -7.0 * std::cos(azimuth), 1.6);
    const glm::dvec3 forward = glm::normalize(target - place);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 0.0, 1.0)));
    return {place, {right, glm::cross(right, forward), forward}};
}

std::uint32_t scrambled(std::uint32_t x) {
    x ^= x >> 16U;
    x *= 0x7feb352dU;
    x ^= x >> 15U;
    x *= 0x846ca68bU;
    return x ^ (x >> 16U);
}

/// -1..1 for every whole point.
float noise_at(int x, int y) {
    const std::uint32_t bits = scrambled(static_cast<std::uint32_t>(x) * 0x9e3779b9U + static_cast<std::uint32_t>(y));
    return static_cast<float>(bits >> 8U) * 0x1p-23F - 1.0F;
}

/// -1..1, smooth between whole points.
float smooth_noise(glm::vec2 at) {
    const glm::vec2 cell = glm::floor(at);
    const glm::vec2 f = at - cell;
    const glm::vec2 w = f * f * (3.0F - 2.0F * f);
    const int x = static_cast<int>(cell.x);
    const int y = static_cast<int>(cell.y);
    return glm::mix(glm::mix(noise_at(x, y), noise_at(x + 1, y), w.x),
                    glm::mix(noise_at(x, y + 1), noise_at(x + 1, y + 1), w.x), w.y);
}

/// Each octave half as strong.
float layered_noise(glm::vec2 at) {
    return 0.5F * smooth_noise(at) + 0.25F * smooth_noise(2.0F * at) + 0.125F * smooth_noise(4.0F * at) +
           0.0625F * smooth_noise(8.0F * at);
}

struct Sphere {
    glm::vec3 centre;
    float radius;
    glm::vec3 albedo;
    glm::vec3 f0;
    float roughness;
};

/// They stand in two rings on the ground.
std::array<Sphere, 9> make_spheres() {
    std::array<Sphere, 9> spheres{};
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const auto k = static_cast<float>(i);
        const bool outer = i >= 4;
        const float angle = 2.39996F * k;
        const float ring = outer ? 3.4F : 1.5F;
        const float radius = outer ? 0.5F + 0.08F * (k - 4.0F) : 0.7F;
        const bool metal = i % 3 == 1;
        const glm::vec3 hue(0.5F + 0.45F * std::sin(k), 0.5F + 0.45F * std::sin(k + 2.1F),
                            0.5F + 0.45F * std::sin(k + 4.2F));
        spheres[i] = {{ring * std::cos(angle), ring * std::sin(angle), radius},
                      radius,
                      metal ? glm::vec3(0.02F) : hue,
                      metal ? glm::mix(hue, glm::vec3(1.0F), 0.5F) : glm::vec3(0.04F),
                      0.25F + 0.07F * k};
    }
    return spheres;
}

/// One pixel's values.
struct Texel {
    glm::vec3 normal{0.0F};
    glm::vec3 position{0.0F};
    float depth = sky_depth;
    glm::vec3 albedo{0.0F};
    glm::vec3 f0{0.0F};
    float roughness = 0.0F;
    float coverage = 0.0F;
    float material = 0.0F;
};

class Picture {
  public:
    Picture(int width, int height, int index)
        : width_(width), height_(height), index_(index), eye_(eye_of(index)), spheres_(make_spheres()) {}

    [[nodiscard]] Texel at(int x, int y) const {
        const double scale = 2.0 * std::tan(0.5 * fov_y) / height_;
        const glm::dvec3 in_camera((x + 0.5 - 0.5 * width_) * scale, (0.5 * height_ - y - 0.5) * scale, 1.0);
        const glm::vec3 ray(eye_.axes * in_camera); // one unit of depth
        const glm::vec3 from(eye_.place);
        float depth = ray.z < 0.0F ? -from.z / ray.z : far_ground;
        const Sphere* sphere = nullptr;
        for (const Sphere& each : spheres_) {
            const glm::vec3 to_eye = from - each.centre;
            const float a = glm::dot(ray, ray);
            const float b = glm::dot(to_eye, ray);
            const float c = glm::dot(to_eye, to_eye) - each.radius * each.radius;
            const float root = b * b - a * c;
            const float near = root > 0.0F ? (-b - std::sqrt(root)) / a : depth;
            if (near > 0.0F && near < depth) {
                depth = near;
                sphere = &each;
            }
        }
        if (depth >= far_ground) {
            return {};
        }
        const glm::vec3 point = from + depth * ray;
        return sphere != nullptr ? on_sphere(*sphere, point, depth, grain(x, y)) : on_ground(point, depth, grain(x, y));
    }

  private:
    /// The pixel's own noise, -1..1.
    [[nodiscard]] float grain(int x, int y) const { return noise_at(x + 16411 * index_, y + 65537); }

    [[nodiscard]] static Texel on_sphere(const Sphere& sphere, glm::vec3 point, float depth, float grain) {
        const glm::vec3 normal = (point - sphere.centre) / sphere.radius;
        const glm::vec2 place(3.0F * std::atan2(normal.y, normal.x), 6.0F * normal.z);
        const float detail = layered_noise(8.0F * place);
        const glm::vec3 bump = 0.06F * glm::vec3(detail, layered_noise(8.0F * place + 17.0F), 0.002F * grain);
        return {glm::normalize(normal + bump),
                point,
                depth,
                glm::clamp(sphere.albedo * (0.85F + 0.25F * detail + 0.004F * grain), 0.0F, 1.0F),
                sphere.f0,
                std::clamp(sphere.roughness * (1.0F + 0.2F * detail) + 0.001F * grain, 0.2F, 1.0F),
                1.0F,
                static_cast<float>(2 + static_cast<int>(8.0F * sphere.radius) % 4)};
    }

    [[nodiscard]] static Texel on_ground(glm::vec3 point, float depth, float grain) {
        const glm::vec2 place(point.x, point.y);
        const float detail = layered_noise(6.0F * place);
        const bool tile = (static_cast<int>(std::floor(point.x)) + static_cast<int>(std::floor(point.y))) % 2 == 0;
        const glm::vec3 colour = tile ? glm::vec3(0.55F, 0.5F, 0.42F) : glm::vec3(0.2F, 0.22F, 0.26F);
        return {
            glm::normalize(glm::vec3(0.1F * detail, 0.1F * layered_noise(6.0F * place + 31.0F), 1.0F + 0.002F * grain)),
            point,
            depth,
            colour * (0.9F + 0.2F * detail + 0.004F * grain),
            glm::vec3(0.04F),
            std::clamp(0.45F + 0.15F * detail + 0.001F * grain, 0.2F, 1.0F),
            1.0F,
            1.0F};
    }

    int width_;
    int height_;
    int index_;
    Eye eye_;
    std::array<Sphere, 9> spheres_;
};

/// Row vectors: element [row][column] as EXR stores it. The camera looks along +z, +x right, +y up (conventions of the
/// standard attribute).
glm::dmat4 world_to_camera(const Eye& eye) {
    glm::dmat4 rows(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 3; ++i) {
            rows[i][axis] = eye.axes[axis][i];
        }
        rows[3][axis] = -glm::dot(eye.axes[axis], eye.place);
    }
    rows[3][3] = 1.0;
    return rows;
}

/// The standard's worldToNDC: (0, 0) upper left to (1, 1) lower right.
glm::dmat4 world_to_ndc(const glm::dmat4& to_camera, double aspect) {
    constexpr double near = 0.1;
    constexpr double far = 1000.0;
    const double half_height = std::tan(0.5 * fov_y);
    glm::dmat4 projection(0.0);
    projection[0][0] = 0.5 / (half_height * aspect);
    projection[1][1] = -0.5 / half_height;
    projection[2] = {0.5, 0.5, far / (far - near), 1.0};
    projection[3][2] = -far * near / (far - near);
    return projection * to_camera; // glm's product of columns is the product of rows in the other order
}

void store(PlaneSlab& planes, int x, int y, const Texel& texel) {
    const std::array<float, channels.size()> values{
        texel.normal.x, texel.normal.y,  texel.normal.z, texel.position.x, texel.position.y, texel.position.z,
        texel.depth,    texel.albedo.r,  texel.albedo.g, texel.albedo.b,   texel.f0.r,       texel.f0.g,
        texel.f0.b,     texel.roughness, texel.coverage, texel.material};
    for (std::size_t p = 0; p < values.size(); ++p) {
        planes.at(static_cast<int>(p), x, y) = values[p];
    }
}

OutputImage header_of(const SequenceFormat& format, int index) {
    OutputImage image;
    image.data_window = {0, 0, format.width - 1, format.height - 1};
    image.display_window = image.data_window;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        image.channels.push_back({std::string(channels[i]), nullptr, static_cast<int>(i), false});
    }
    const glm::dmat4 to_camera = world_to_camera(eye_of(index));
    image.matrices["worldToCamera"] = to_camera;
    image.matrices["worldToNDC"] = world_to_ndc(to_camera, static_cast<double>(format.width) / format.height);
    return image;
}

} // namespace

std::span<const std::string_view> sequence_channels() {
    return channels;
}

void fill_sequence_band(PlaneSlab& planes, int first_row, int height, int index) {
    const Picture picture(planes.width(), height, index);
    tbb::parallel_for(0, planes.height(), [&](int row) {
        for (int x = 0; x < planes.width(); ++x) {
            store(planes, x, row, picture.at(x, first_row + row));
        }
    });
}

void write_sequence_frame(const std::filesystem::path& file, const SequenceFormat& format, int index) {
    OutputImage image = header_of(format, index);
    ExrSettings settings;
    settings.half = format.half;
    settings.compression = format.compression;
    ExrWriter writer(file, image, settings);
    const int block = writer.band_rows();
    const int band = block * std::max(1, 256 / block);
    for (int first = 0; first < format.height; first += band) {
        const int rows = std::min(band, format.height - first);
        PlaneSlab planes(format.width, rows, static_cast<int>(channels.size()));
        fill_sequence_band(planes, first, format.height, index);
        for (OutputChannel& channel : image.channels) {
            channel.slab = &planes;
        }
        writer.write(image.channels, 0, rows);
    }
    (void)writer.commit();
}

} // namespace clshade
