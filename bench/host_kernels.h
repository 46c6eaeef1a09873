// The C++ rivals' functions, by instruction set.
#pragma once

#include "bench/simd/rivals.h"

#include <string_view>
#include <vector>

namespace clshade {

/// The rivals of one instruction set.
struct HostKernels {
    std::string_view instruction_set;
    rivals::ShadeRange openmp_simd;
    rivals::ShadeRange hand_simd;
    rivals::StreamRange stream;
    rivals::FilterRange filter;
    rivals::InterleavedRange interleaved;
};

/// The instruction sets that were compiled and that this processor runs, widest first: "x86-64-v4" (AVX-512),
/// "x86-64-v3" (AVX2), "baseline".
[[nodiscard]] std::vector<std::string_view> instruction_sets();

/// One of them, empty for the widest; throws std::invalid_argument for another.
[[nodiscard]] const HostKernels& host_kernels(std::string_view instruction_set = {});

/// 0 stands for all processors.
[[nodiscard]] int threads_or_all(int threads);

} // namespace clshade
