// The scenes that rows and tables share.
#pragma once

#include "bench/bench_frame.h"

namespace clshade {

[[nodiscard]] BenchScene scene_of(BoundMaterial material, BenchLights lights = BenchLights::distant1);

/// The base of the layer tables alone: what coated rows are measured against.
[[nodiscard]] BenchScene bare_scene(DiffuseModel diffuse = DiffuseModel::lambert);

/// The same under coats, Fresnel terms constant.
[[nodiscard]] BenchScene coated_scene(int coats, AbsorptionModel absorption,
                                      DiffuseModel diffuse = DiffuseModel::lambert);

/// The deck's dual layer: one coat, approximated absorption.
[[nodiscard]] BenchScene dual_scene(DiffuseModel diffuse = DiffuseModel::lambert);

/// The scene in the studio, under these lights.
[[nodiscard]] BenchScene in_studio(BenchScene scene, BenchLights lights);

} // namespace clshade
