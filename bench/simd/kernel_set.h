// Names of the functions of one instruction set: CLSHADE_RIVALS(x) is x_<CLSHADE_RIVALS_LEVEL>.
#pragma once

#include "bench/simd/rivals.h"

#ifndef CLSHADE_RIVALS_LEVEL
#define CLSHADE_RIVALS_LEVEL baseline
#endif
#define CLSHADE_RIVALS_JOIN_(name, level) name##_##level
#define CLSHADE_RIVALS_JOIN(name, level) CLSHADE_RIVALS_JOIN_(name, level)
#define CLSHADE_RIVALS(name) CLSHADE_RIVALS_JOIN(name, CLSHADE_RIVALS_LEVEL)

namespace clshade::rivals {

void CLSHADE_RIVALS(openmp_simd)(const Planes& planes, const Scene& scene, size_t begin, size_t end);
void CLSHADE_RIVALS(hand_simd)(const Planes& planes, const Scene& scene, size_t begin, size_t end);
void CLSHADE_RIVALS(stream)(const Planes& planes, size_t begin, size_t end);
void CLSHADE_RIVALS(interleaved)(const float* pixels, const Interleaved& layout, const Scene& scene, float* out,
                                 size_t count);
void CLSHADE_RIVALS(filter)(const SkySource& source, const SkyLobe& lobe, float* out, size_t begin, size_t end);

} // namespace clshade::rivals
