#include "tests/reference/random_stacks.h"

#include "host/scene/metal_table.h"
#include "tests/reference/directions.h"

#include <array>
#include <cmath>
#include <numbers>

namespace clshade::reference {

namespace {

const std::array<SpectralMetal, 2>& metals() {
    static const std::array<SpectralMetal, 2> both{SpectralMetal(built_in_metal("gold").value()),
                                                   SpectralMetal(built_in_metal("copper").value())};
    return both;
}

} // namespace

StackGenerator::StackGenerator(std::uint64_t seed) : random_(seed) {}

double StackGenerator::between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11U) * 0x1p-53;
}

glm::dvec3 StackGenerator::direction() {
    return direction_at(std::acos(between(1e-3, 1.0)), between(0.0, 2.0 * std::numbers::pi));
}

double StackGenerator::shininess() {
    return std::exp2(between(-4.0, 16.0));
}

glm::dvec3 StackGenerator::f0() {
    const double grey = between(1e-3, 0.9);
    return chance(0.5) ? glm::dvec3(grey) : glm::dvec3(grey, between(1e-3, 0.9), between(1e-3, 0.9));
}

SpecularModel StackGenerator::lobe() {
    return static_cast<SpecularModel>(static_cast<int>(between(0.0, 5.0)));
}

LayerValues StackGenerator::layer(SpecularModel model) {
    LayerValues layer = model == SpecularModel::blinn_phong_spectral
                            ? layer_of_metal(metals()[chance(0.5) ? 0 : 1], shininess())
                            : layer_of(model, f0(), shininess());
    layer.shininess_v = shininess();
    layer.tangent_read = direction();
    return layer;
}

glm::dvec3 StackGenerator::absorption() {
    return {between(0.0, 0.3), between(0.0, 0.3), 0.0};
}

std::vector<LayerValues> StackGenerator::layers() {
    std::vector<LayerValues> layers;
    const int count = 1 + static_cast<int>(between(0.0, 8.0));
    for (int k = 0; k < count; ++k) {
        LayerValues next = layer(lobe());
        if (next.metal == nullptr && chance(0.3)) {
            glm::dvec3 f0 = next.f0;
            f0[static_cast<int>(between(0.0, 3.0))] = 0.0;
            const double shininess_v = next.shininess_v;
            next = layer_of(next.specular, chance(0.5) ? glm::dvec3(0.0) : f0, next.shininess);
            next.shininess_v = shininess_v;
        }
        if (k + 1 < count && chance(0.7)) {
            next.absorption = absorption();
        }
        layers.push_back(next);
    }
    return layers;
}

} // namespace clshade::reference
