#include "bench/host_rivals.h"

#include "bench/bench_frame.h"
#include "bench/host_kernels.h"

#include <stdexcept>

namespace clshade {

namespace {

/// Pixels that a thread takes at a time: 32 KiB of each plane, enough to amortise the counter and to keep the hardware
/// prefetchers on their streams.
constexpr std::size_t chunk = 8192;

} // namespace

std::vector<rivals::DistantLight> distant_lights(const Frame& frame) {
    std::vector<rivals::DistantLight> lights;
    for (const Light& light : frame.lights) {
        if (light.type != LightType::distant) {
            throw std::invalid_argument("the C++ rivals know distant lights only");
        }
        const glm::vec3 to_light = -glm::normalize(light.direction);
        const glm::vec3 irradiance = light.power;
        lights.push_back({{to_light.x, to_light.y, to_light.z}, {irradiance.r, irradiance.g, irradiance.b}});
    }
    return lights;
}

HostRivals::HostRivals(const Frame& frame, PlaneSlab& output, int threads, std::string_view instruction_set)
    : frame_(&frame), kernels_(&host_kernels(instruction_set)), output_(&output), pool_(threads_or_all(threads)) {}

double HostRivals::openmp_simd(const std::vector<rivals::DistantLight>& lights, int planes_out) {
    return shade(kernels_->openmp_simd, lights, planes_out);
}

double HostRivals::hand_simd(const std::vector<rivals::DistantLight>& lights, int planes_out) {
    return shade(kernels_->hand_simd, lights, planes_out);
}

double HostRivals::stream(int planes_in, int planes_out) {
    const rivals::Planes where = planes(planes_in, planes_out);
    return pool_.run(output_->padded_pixels(), chunk,
                     [this, &where](std::size_t begin, std::size_t end) { kernels_->stream(where, begin, end); });
}

std::string_view HostRivals::instruction_set() const {
    return kernels_->instruction_set;
}

rivals::Planes HostRivals::planes(int planes_in, int planes_out) {
    rivals::Planes where;
    where.in = frame_->planes.data();
    where.in_stride = frame_->planes.stride();
    where.planes_in = planes_in;
    where.out = output_->data();
    where.out_stride = output_->stride();
    where.planes_out = planes_out;
    return where;
}

double HostRivals::shade(rivals::ShadeRange work, const std::vector<rivals::DistantLight>& lights, int planes_out) {
    const rivals::Planes where = planes(bench_parameter_planes, planes_out);
    const glm::vec3 eye = frame_->view.eye;
    const rivals::Scene scene{{eye.x, eye.y, eye.z}, lights.data(), static_cast<int>(lights.size())};
    return pool_.run(output_->padded_pixels(), chunk,
                     [&](std::size_t begin, std::size_t end) { work(where, scene, begin, end); });
}

} // namespace clshade
