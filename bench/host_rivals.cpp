#include "bench/host_rivals.h"

#include "bench/bench_frame.h"

#include <algorithm>
#include <stdexcept>
#include <thread>

namespace clshade {

namespace rivals {

// One function of each kind per instruction set, made by bench/simd with CLSHADE_RIVALS_LEVEL.
void openmp_simd_baseline(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void hand_simd_baseline(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void stream_baseline(const Planes& planes, std::size_t begin, std::size_t end);
#ifdef CLSHADE_RIVALS_X86
void openmp_simd_x86_64_v3(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void hand_simd_x86_64_v3(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void stream_x86_64_v3(const Planes& planes, std::size_t begin, std::size_t end);
void openmp_simd_x86_64_v4(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void hand_simd_x86_64_v4(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void stream_x86_64_v4(const Planes& planes, std::size_t begin, std::size_t end);
#endif

} // namespace rivals

/// The rivals of one instruction set.
struct HostKernels {
    std::string_view instruction_set;
    rivals::ShadeRange openmp_simd;
    rivals::ShadeRange hand_simd;
    rivals::StreamRange stream;
};

namespace {

/// What this processor runs, widest first.
const std::vector<HostKernels>& usable_kernels() {
    static const std::vector<HostKernels> usable = [] {
        std::vector<HostKernels> sets;
#ifdef CLSHADE_RIVALS_X86
        if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
            __builtin_cpu_supports("avx512cd") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
            __builtin_cpu_supports("avx512vl") != 0) {
            sets.push_back(
                {"x86-64-v4", rivals::openmp_simd_x86_64_v4, rivals::hand_simd_x86_64_v4, rivals::stream_x86_64_v4});
        }
        if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
            __builtin_cpu_supports("bmi2") != 0) {
            sets.push_back(
                {"x86-64-v3", rivals::openmp_simd_x86_64_v3, rivals::hand_simd_x86_64_v3, rivals::stream_x86_64_v3});
        }
#endif
        sets.push_back({"baseline", rivals::openmp_simd_baseline, rivals::hand_simd_baseline, rivals::stream_baseline});
        return sets;
    }();
    return usable;
}

const HostKernels& kernels_named(std::string_view instruction_set) {
    for (const HostKernels& set : usable_kernels()) {
        if (instruction_set.empty() || set.instruction_set == instruction_set) {
            return set;
        }
    }
    throw std::invalid_argument("no rivals for this instruction set");
}

/// Pixels that a thread takes at a time: 32 KiB of each plane, enough to amortise the counter and to keep the hardware
/// prefetchers on their streams.
constexpr std::size_t chunk = 8192;

int threads_or_all(int threads) {
    return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

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

std::vector<std::string_view> instruction_sets() {
    std::vector<std::string_view> names;
    for (const HostKernels& set : usable_kernels()) {
        names.push_back(set.instruction_set);
    }
    return names;
}

HostRivals::HostRivals(const Frame& frame, PlaneSlab& output, int threads, std::string_view instruction_set)
    : frame_(&frame), kernels_(&kernels_named(instruction_set)), output_(&output), pool_(threads_or_all(threads)) {}

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
