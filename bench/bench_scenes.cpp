#include "bench/bench_scenes.h"

#include <utility>

namespace clshade {

BenchScene scene_of(BoundMaterial material, BenchLights lights) {
    return {.materials = {std::move(material)}, .lights = lights};
}

BenchScene bare_scene(DiffuseModel diffuse) {
    BenchScene scene = scene_of(layer_base(diffuse));
    scene.variant = "constant_f0";
    return scene;
}

BenchScene coated_scene(int coats, AbsorptionModel absorption, DiffuseModel diffuse) {
    return scene_of(coated(coats, FresnelModel::constant, absorption, layer_base(diffuse)));
}

BenchScene dual_scene(DiffuseModel diffuse) {
    return coated_scene(1, AbsorptionModel::approximated, diffuse);
}

BenchScene in_studio(BenchScene scene, BenchLights lights) {
    scene.lights = lights;
    scene.environment = true;
    return scene;
}

} // namespace clshade
