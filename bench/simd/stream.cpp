// The same bytes as a shading kernel, and next to no arithmetic, with streamed stores: the limit that memory sets.
#include "bench/simd/kernel_set.h"
#include "bench/simd/lanes.h"

namespace clshade::rivals {

namespace {

/// The number of planes is a constant so that the reads stand side by side, as in a shading kernel.
template <int PlanesIn>
void stream_planes(const Planes& planes, size_t begin, size_t end) {
    for (size_t i = begin; i < end; i += lane_count) {
        Real sum = load(planes.in + i);
#pragma GCC unroll 32
        for (int p = 1; p < PlanesIn; ++p) {
            sum += load(planes.in + p * planes.in_stride + i);
        }
        Real value = sum;
        for (int p = 0; p < planes.planes_out; ++p) {
            stream(planes.out + p * planes.out_stride + i, value);
            value += sum;
        }
    }
    finish_streams();
}

/// Any number of planes, for kernels that read neither 13 nor 14.
void stream_any(const Planes& planes, size_t begin, size_t end) {
    for (size_t i = begin; i < end; i += lane_count) {
        Real sum = load(planes.in + i);
        for (int p = 1; p < planes.planes_in; ++p) {
            sum += load(planes.in + p * planes.in_stride + i);
        }
        Real value = sum;
        for (int p = 0; p < planes.planes_out; ++p) {
            stream(planes.out + p * planes.out_stride + i, value);
            value += sum;
        }
    }
    finish_streams();
}

} // namespace

void CLSHADE_RIVALS(stream)(const Planes& planes, size_t begin, size_t end) {
    switch (planes.planes_in) {
    case 13:
        return stream_planes<13>(planes, begin, end);
    case 14:
        return stream_planes<14>(planes, begin, end);
    default:
        return stream_any(planes, begin, end);
    }
}

} // namespace clshade::rivals
