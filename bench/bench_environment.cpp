#include "bench/bench_environment.h"

#include "host/prefilter/prefilter.h"
#include "host/shading/kernel_library.h"
#include "host/shading/shader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

namespace clshade {

namespace {

constexpr int studio_height = 256;

struct Sun {
    glm::dvec3 direction;
    glm::dvec3 radiance;
    double radius; ///< of the disc [rad]
};

constexpr double sun_radius = 0.00465; // of the sun seen from the earth

const std::array<Sun, 3> suns = {
    Sun{glm::normalize(glm::dvec3(0.5, 0.3, 0.6)), {2.0e5, 1.8e5, 1.5e5}, sun_radius},
    Sun{glm::normalize(glm::dvec3(-0.7, 0.2, 0.1)), {3.0e3, 1.5e3, 6.0e2}, 4.0 * sun_radius},
    Sun{glm::normalize(glm::dvec3(0.1, -0.2, -0.9)), {2.0e4, 3.0e4, 5.0e4}, 2.0 * sun_radius},
};

glm::dvec3 sky_along(const glm::dvec3& d) {
    const double hills = 0.08 * std::sin(5.0 * std::atan2(d.y, d.x)) * (1.0 - d.z * d.z);
    if (d.z < hills) {
        return glm::dvec3(0.12, 0.10, 0.06) * (1.2 + std::sin(9.0 * d.x) * std::cos(11.0 * d.y));
    }
    return glm::mix(glm::dvec3(1.2, 1.1, 1.0), glm::dvec3(0.2, 0.4, 0.9), std::sqrt(std::max(d.z, 0.0)));
}

} // namespace

const BoundEnvironment& BenchStudio::environment() {
    if (!environment_) {
        const int lanes = lanes_ > 0 ? lanes_ : automatic_lanes(device_->info());
        Prefilter prefilter(*device_, kernel_sources(kernel_dir_), ProgramCache::standard(), lanes);
        BoundEnvironment studio;
        studio.image = std::make_shared<const LatLong>(built_in_studio(studio_height));
        studio.maps = std::make_shared<const FilteredSet>(prefilter.filter(*studio.image, {}));
        studio.world_to_image = world_to_image(UpAxis::y, 0.0); // the bench camera looks along -Z too
        environment_ = std::move(studio);
    }
    return *environment_;
}

LatLong sunny_sky(int height, std::uint64_t seed) {
    constexpr double pi = std::numbers::pi;
    LatLong sky;
    sky.name = "bench";
    sky.width = 2 * height;
    sky.height = height;
    sky.rgb.reserve(static_cast<std::size_t>(height) * static_cast<std::size_t>(sky.width) * 3);
    std::mt19937_64 random(seed);
    for (int y = 0; y < height; ++y) {
        const double theta = pi * (y + 0.5) / height;
        for (int x = 0; x < sky.width; ++x) {
            const double phi = pi * (1.0 - 2.0 * (x + 0.5) / sky.width);
            const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            const double grain = 0.8 + 0.4 * static_cast<double>(random() >> 11U) * 0x1.0p-53;
            glm::dvec3 radiance = grain * sky_along(d);
            for (const Sun& sun : suns) {
                // At least one texel has it, however coarse the picture is.
                const double radius = std::max(sun.radius, 0.75 * pi / height);
                if (glm::distance(d, sun.direction) < radius) {
                    radiance += sun.radiance;
                }
            }
            for (int c = 0; c < 3; ++c) {
                sky.rgb.push_back(static_cast<float>(radiance[c]));
            }
        }
    }
    return sky;
}

} // namespace clshade
