// What the benches shade: a smooth made-up picture, and the variants of scene that the rows ask for.
#pragma once

#include "host/gbuffer/frame.h"

#include <cstdint>
#include <vector>

namespace clshade {

/// Planes of the bench frame in order: normal 0-2, position 3-5, albedo 6-8, f0 9-11, shininess 12, material id 13.
/// Rows with one material read the first 13.
inline constexpr int bench_parameter_planes = 13;
inline constexpr int bench_planes = 14;

enum class BenchLights { distant1, distant8, point1, spot1 };

/// The scene side of a row.
struct BenchScene {
    SpecularModel specular = SpecularModel::blinn_phong;
    DiffuseModel diffuse = DiffuseModel::lambert;
    BenchLights lights = BenchLights::distant1;
    bool mixed = false; ///< four materials by id in 16x16 tiles; the models above are not used
};

/// Waves and a grid of spheres seen in perspective; no coverage and no depth plane, every pixel has a surface. Smooth
/// albedo and F0, shininess 8 to 256 evenly in its logarithm. The same seed gives the same picture at one size.
[[nodiscard]] Frame make_bench_frame(int width, int height, std::uint64_t seed);

/// Puts a row's lights and materials into a bench frame; the planes stay as they are.
void apply_scene(Frame& frame, const BenchScene& scene);

} // namespace clshade
