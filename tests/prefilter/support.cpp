#include "tests/prefilter/support.h"

#include "host/shading/kernel_library.h"
#include "host/shading/shader.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace clshade::tests {

namespace {
constexpr double pi = std::numbers::pi;
}

Device& cpu_device() {
    static Device device(select_device(list_devices(), "cpu"));
    return device;
}

Prefilter prefilter_of(int lanes) {
    return {cpu_device(), kernel_sources(), ProgramCache::standard(),
            lanes == 0 ? automatic_lanes(cpu_device().info()) : lanes};
}

LatLong picture(int height, const std::function<glm::dvec3(int, int)>& value) {
    LatLong image;
    image.name = "test";
    image.width = 2 * height;
    image.height = height;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < 2 * height; ++x) {
            const glm::dvec3 texel = value(x, y);
            for (int c = 0; c < 3; ++c) {
                image.rgb.push_back(static_cast<float>(texel[c]));
            }
        }
    }
    return image;
}

LatLong random_picture(int height, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> radiance(0.0, 2.0);
    return picture(height, [&](int /*x*/, int /*y*/) {
        const double r = radiance(random);
        const double g = radiance(random);
        return glm::dvec3(r, g, radiance(random));
    });
}

LatLong black_picture(int height) {
    return picture(height, [](int /*x*/, int /*y*/) { return glm::dvec3(0.0); });
}

void set_texel(LatLong& image, int x, int y, const glm::dvec3& value) {
    for (int c = 0; c < 3; ++c) {
        image.rgb[3 * static_cast<std::size_t>(y * image.width + x) + static_cast<std::size_t>(c)] =
            static_cast<float>(value[c]);
    }
}

LatLong turned(const LatLong& image, int columns) {
    LatLong result = image;
    for (int y = 0; y < image.height; ++y) {
        const auto row = result.rgb.begin() + std::ptrdiff_t{3} * y * image.width;
        std::rotate(row, row + std::ptrdiff_t{3} * (image.width - columns), row + std::ptrdiff_t{3} * image.width);
    }
    return result;
}

glm::dvec3 texel_direction(int width, int height, double x, double y) {
    const double phi = 2.0 * pi * (0.5 - x / width);
    const double theta = pi * y / height;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

glm::dvec3 vertex_direction(int cells, int i, int j) {
    double x = 2.0 * i / cells - 1.0;
    double y = 2.0 * j / cells - 1.0;
    const double z = 1.0 - std::abs(x) - std::abs(y);
    if (z < 0.0) {
        const double folded = (1.0 - std::abs(y)) * (x < 0.0 ? -1.0 : 1.0);
        y = (1.0 - std::abs(x)) * (y < 0.0 ? -1.0 : 1.0);
        x = folded;
    }
    return glm::normalize(glm::dvec3(x, y, z));
}

glm::dvec3 vertex_value(const std::vector<float>& grid, int cells, int i, int j) {
    const auto at = 3 * static_cast<std::size_t>(j * (cells + 1) + i);
    return {grid[at], grid[at + 1], grid[at + 2]};
}

glm::dvec3 filtered(const LatLong& source, const glm::dvec3& direction, const std::function<double(double)>& lobe) {
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (int y = 0; y < source.height; ++y) {
        const double solid_angle =
            2.0 * pi / source.width * (std::cos(pi * y / source.height) - std::cos(pi * (y + 1) / source.height));
        for (int x = 0; x < source.width; ++x) {
            const double c = glm::dot(direction, texel_direction(source.width, source.height, x + 0.5, y + 0.5));
            const double weight = lobe(c) * solid_angle;
            sum += weight * vertex_value(source.rgb, source.width - 1, x, y);
            weights += weight;
        }
    }
    return sum / weights;
}

std::function<double(double)> power_lobe(double shininess) {
    return [shininess](double c) { return std::pow(std::max(0.0, (1.0 + c) / 2.0), shininess / 2.0); };
}

double cosine_lobe(double c) {
    return std::max(0.0, c);
}

double relative_difference(const glm::dvec3& a, const glm::dvec3& b) {
    const double scale = std::max({std::abs(b.x), std::abs(b.y), std::abs(b.z)});
    const glm::dvec3 d = glm::abs(a - b);
    return std::max({d.x, d.y, d.z}) / scale;
}

} // namespace clshade::tests
