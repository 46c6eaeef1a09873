#include "bench/host_kernels.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <thread>

namespace clshade {

namespace rivals {

// One function of each kind per instruction set, made by bench/simd with CLSHADE_RIVALS_LEVEL.
void openmp_simd_baseline(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void hand_simd_baseline(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void stream_baseline(const Planes& planes, std::size_t begin, std::size_t end);
void interleaved_baseline(const float* pixels, const Interleaved& layout, const Scene& scene, float* out,
                          std::size_t count);
void filter_baseline(const SkySource& source, const SkyLobe& lobe, float* out, std::size_t begin, std::size_t end);
#ifdef CLSHADE_RIVALS_X86
void openmp_simd_x86_64_v3(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void hand_simd_x86_64_v3(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void stream_x86_64_v3(const Planes& planes, std::size_t begin, std::size_t end);
void interleaved_x86_64_v3(const float* pixels, const Interleaved& layout, const Scene& scene, float* out,
                           std::size_t count);
void filter_x86_64_v3(const SkySource& source, const SkyLobe& lobe, float* out, std::size_t begin, std::size_t end);
void openmp_simd_x86_64_v4(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void hand_simd_x86_64_v4(const Planes& planes, const Scene& scene, std::size_t begin, std::size_t end);
void stream_x86_64_v4(const Planes& planes, std::size_t begin, std::size_t end);
void interleaved_x86_64_v4(const float* pixels, const Interleaved& layout, const Scene& scene, float* out,
                           std::size_t count);
void filter_x86_64_v4(const SkySource& source, const SkyLobe& lobe, float* out, std::size_t begin, std::size_t end);
#endif

} // namespace rivals

namespace {

/// What this processor runs, widest first.
const std::vector<HostKernels>& usable_kernels() {
    static const std::vector<HostKernels> usable = [] {
        std::vector<HostKernels> sets;
#ifdef CLSHADE_RIVALS_X86
        if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
            __builtin_cpu_supports("avx512cd") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
            __builtin_cpu_supports("avx512vl") != 0) {
            sets.push_back({"x86-64-v4", rivals::openmp_simd_x86_64_v4, rivals::hand_simd_x86_64_v4,
                            rivals::stream_x86_64_v4, rivals::filter_x86_64_v4, rivals::interleaved_x86_64_v4});
        }
        if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
            __builtin_cpu_supports("bmi2") != 0) {
            sets.push_back({"x86-64-v3", rivals::openmp_simd_x86_64_v3, rivals::hand_simd_x86_64_v3,
                            rivals::stream_x86_64_v3, rivals::filter_x86_64_v3, rivals::interleaved_x86_64_v3});
        }
#endif
        sets.push_back({"baseline", rivals::openmp_simd_baseline, rivals::hand_simd_baseline, rivals::stream_baseline,
                        rivals::filter_baseline, rivals::interleaved_baseline});
        return sets;
    }();
    return usable;
}

} // namespace

const HostKernels& host_kernels(std::string_view instruction_set) {
    for (const HostKernels& set : usable_kernels()) {
        if (instruction_set.empty() || set.instruction_set == instruction_set) {
            return set;
        }
    }
    throw std::invalid_argument("no rivals for this instruction set");
}

std::vector<std::string_view> instruction_sets() {
    std::vector<std::string_view> names;
    for (const HostKernels& set : usable_kernels()) {
        names.push_back(set.instruction_set);
    }
    return names;
}

int threads_or_all(int threads) {
    return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

} // namespace clshade
