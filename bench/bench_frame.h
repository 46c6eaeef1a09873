// What the benches shade: a smooth made-up picture, and the variants of scene that the rows ask for.
#pragma once

#include "bench/bench_materials.h"
#include "host/gbuffer/frame.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace clshade {

// Planes of the bench frame: first one of each parameter. Rows with one material read some of the first 13, rows with
// several one of the id planes too.
inline constexpr int bench_normal = 0;
inline constexpr int bench_position = 3;
inline constexpr int bench_albedo = 6;
inline constexpr int bench_f0 = 9;
inline constexpr int bench_shininess = 12;
inline constexpr int bench_parameter_planes = 13;
inline constexpr int bench_tile_ids = 13;      ///< 1 to 4, each tile of 16x16 pixels has one
inline constexpr int bench_scattered_ids = 14; ///< 1 to 4 by chance, each pixel its own
inline constexpr int bench_planes = 15;
inline constexpr int bench_outputs = 4; ///< R, G, B and alpha

enum class BenchLights { none, distant1, distant8, point1, spot1 };

/// Which pixels have which material, where there are several: the plane of ids that the frame reads.
enum class BenchIds { tiles, scattered };

/// The scene side of a row.
struct BenchScene {
    std::vector<BoundMaterial> materials = {single_layer()}; ///< several: the first takes the pixels with id 1, ...
    BenchLights lights = BenchLights::distant1;
    BenchIds ids = BenchIds::tiles; ///< of no meaning for one material
    std::string variant = {};       ///< tells apart rows of one model: where its F0 comes from
    bool environment = false;       ///< the studio of bench_environment.h all around
};

/// Waves and a grid of spheres seen in perspective; no coverage and no depth plane, every pixel has a surface. Smooth
/// albedo and F0, shininess 8 to 256 evenly in its logarithm. The same seed gives the same picture at one size.
[[nodiscard]] Frame make_bench_frame(int width, int height, std::uint64_t seed);

/// Puts a row's lights and materials into a bench frame, and `environment` where the scene has one (without it:
/// std::invalid_argument). The planes stay as they are.
void apply_scene(Frame& frame, const BenchScene& scene, const std::optional<BoundEnvironment>& environment = {});

} // namespace clshade
