// The benchmark's materials are what the deck's table compares, and nothing in them can be left out.
#include "bench/bench_frame.h"
#include "bench/bench_materials.h"
#include "host/reference/reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace clshade {
namespace {

using ::testing::Each;
using ::testing::Ge;

TEST(BenchMaterials, TheDecksStacksShareTheBaseOfTheSingleLayer) {
    const BoundMaterial single = layer_base();
    EXPECT_NEAR(single.base().f0.constant.r, 1.0 / 9.0, 1e-15); // index 2
    for (const AbsorptionModel absorption :
         {AbsorptionModel::none, AbsorptionModel::approximated, AbsorptionModel::original}) {
        const BoundMaterial dual = coated(1, FresnelModel::constant, absorption);
        ASSERT_EQ(dual.layers.size(), 2U);
        EXPECT_EQ(dual.absorption, absorption);
        EXPECT_EQ(dual.base().specular, single.base().specular);
        EXPECT_TRUE(dual.base().f0.is_constant());
        EXPECT_EQ(dual.base().f0.constant, single.base().f0.constant);
        EXPECT_EQ(dual.base().shininess.planes, single.base().shininess.planes);
        EXPECT_EQ(dual.albedo.planes, single.albedo.planes);
        EXPECT_EQ(dual.diffuse, DiffuseModel::lambert);
        const BoundLayer& coat = dual.layers[0];
        EXPECT_TRUE(coat.f0.is_constant() && coat.shininess.is_constant() && coat.absorption.is_constant());
        EXPECT_NEAR(coat.f0.constant.r, 0.04, 1e-15); // index 1.5
        EXPECT_EQ(coat.shininess.constant.r, 512.0);
    }
}

TEST(BenchMaterials, EveryAbsorptionModelGivesTheSameColourAlongTheNormal) {
    const auto absorption = [](AbsorptionModel model) {
        return coated(1, FresnelModel::constant, model).layers[0].absorption.constant;
    };
    EXPECT_EQ(absorption(AbsorptionModel::none), glm::dvec3(0.0));
    const glm::dvec3 approximated = absorption(AbsorptionModel::approximated);
    EXPECT_EQ(approximated, glm::dvec3(0.02, 0.05, 0.10));
    const glm::dvec3 original = absorption(AbsorptionModel::original);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(std::exp(-2.0 * original[c]), 1.0 - 2.0 * approximated[c], 1e-15); // models.md section 5
    }
}

TEST(BenchMaterials, NoCoatCanBeLeftOut) {
    const BoundMaterial deepest = coated(most_coats, FresnelModel::constant, AbsorptionModel::approximated);
    ASSERT_EQ(deepest.layers.size(), most_layers);
    for (std::size_t k = 0; k + 1 < deepest.layers.size(); ++k) {
        const BoundLayer& coat = deepest.layers[k];
        EXPECT_GT(coat.f0.constant.r, 0.0) << k;
        EXPECT_GT(coat.absorption.constant.r, 0.0) << k;
        for (std::size_t other = 0; other < k; ++other) {
            // Equal indices would reflect nothing, equal lobes and tints would be computed once.
            EXPECT_NE(coat.f0.constant, deepest.layers[other].f0.constant) << k << " and " << other;
            EXPECT_NE(coat.shininess.constant, deepest.layers[other].shininess.constant) << k << " and " << other;
            EXPECT_NE(coat.absorption.constant, deepest.layers[other].absorption.constant) << k << " and " << other;
        }
    }
}

TEST(BenchMaterials, StacksAreOneToEightLayers) {
    constexpr auto constant = FresnelModel::constant;
    EXPECT_THROW((void)coated(0, constant, AbsorptionModel::none), std::invalid_argument);
    EXPECT_THROW((void)coated(8, constant, AbsorptionModel::none), std::invalid_argument);
}

TEST(BenchMaterials, SkinIsThatOfSection10) {
    const BoundMaterial material = skin();
    ASSERT_EQ(material.layers.size(), 2U);
    EXPECT_NEAR(material.layers[0].f0.constant.r, std::pow(0.47 / 2.47, 2), 1e-15);
    EXPECT_EQ(material.layers[0].absorption.constant.r, 0.02);
    EXPECT_NEAR(material.base().f0.constant.r, std::pow(0.40 / 2.40, 2), 1e-15);
    EXPECT_NEAR(material.diffuse_shininess.constant.r, 5.945, 5e-4);
    EXPECT_EQ(material.diffuse, DiffuseModel::oren_nayar);
}

/// Mean radiance of a small bench picture under one material.
glm::dvec3 mean_radiance(const BoundMaterial& material) {
    constexpr int width = 64;
    constexpr int height = 36;
    Frame frame = make_bench_frame(width, height, 1);
    apply_scene(frame, {.materials = {material}});
    glm::dvec3 sum(0.0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            sum += reference::shade_pixel(frame, x, y, {}).radiance;
        }
    }
    return sum / static_cast<double>(width * height);
}

TEST(BenchMaterials, EachMoreLayerTakesLightFromTheDiffusePart) {
    double above = mean_radiance(single_layer()).b;
    for (int coats = 1; coats <= most_coats; ++coats) {
        const double here = mean_radiance(coated(coats, FresnelModel::constant, AbsorptionModel::approximated)).b;
        EXPECT_LT(here, above) << coats << " coats";
        above = here;
    }
    EXPECT_GT(above, 0.0);
}

TEST(BenchMaterials, GoldIsYellow) {
    const glm::dvec3 colour = mean_radiance(single_layer(SpecularModel::blinn_phong_spectral, DiffuseModel::none));
    EXPECT_GT(colour.r, colour.g);
    EXPECT_GT(colour.g, 1.5 * colour.b);
    EXPECT_THAT((std::array{colour.r, colour.g, colour.b}), Each(Ge(0.0)));
}

TEST(BenchMaterials, TheAnisotropicLobeIsRougherAlongItsTangent) {
    const BoundMaterial material = single_layer(SpecularModel::blinn_phong_anisotropic);
    const BoundLayer& base = material.base();
    EXPECT_EQ(base.shininess_u.planes, base.shininess_v.planes);
    EXPECT_LT(base.shininess_u.scale, base.shininess_v.scale);
    EXPECT_TRUE(base.tangent.is_constant());
    EXPECT_EQ(glm::length(base.tangent.constant), 1.0);
}

} // namespace
} // namespace clshade
