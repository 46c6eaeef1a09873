// Random frames of stacks: what they bind, the ranges of their values, and that they never change.
#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/gbuffer/random_gbuffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace clshade {
namespace {

StackShape shape_of(const std::vector<SpecularModel>& layers, AbsorptionModel absorption = AbsorptionModel::none) {
    StackShape shape;
    shape.layers = layers;
    shape.absorption = absorption;
    return shape;
}

constexpr int side = 128;

/// A coat with everything, a brushed layer, a metal, a plain base.
StackShape rich_shape() {
    return shape_of({SpecularModel::blinn_phong, SpecularModel::blinn_phong_anisotropic,
                     SpecularModel::blinn_phong_spectral, SpecularModel::blinn_phong_exact},
                    AbsorptionModel::original);
}

std::string hash_of(const Frame& frame) {
    return hash_hex(std::as_bytes(frame.planes.all()));
}

/// Values at the covered pixels, as an evaluator reads them.
std::vector<glm::dvec3> values_of(const Frame& frame, const BoundParameter& parameter) {
    std::vector<glm::dvec3> values;
    for (int y = 0; y < frame.planes.height(); ++y) {
        for (int x = 0; x < frame.planes.width(); ++x) {
            const double coverage = static_cast<double>(frame.planes.at(frame.roles.coverage, x, y));
            if (coverage == 0.0) {
                continue;
            }
            glm::dvec3 value = parameter.constant;
            for (int i = 0; i < 3 && !parameter.is_constant(); ++i) {
                value[i] = static_cast<double>(frame.planes.at(parameter.planes[static_cast<std::size_t>(i)], x, y)) /
                           coverage;
            }
            values.push_back(value);
        }
    }
    return values;
}

template <typename Predicate>
double share_of(const std::vector<glm::dvec3>& values, Predicate predicate) {
    return static_cast<double>(std::count_if(values.begin(), values.end(), predicate)) /
           static_cast<double>(values.size());
}

bool is_zero(const glm::dvec3& v) {
    return v == glm::dvec3(0.0);
}

double largest_of(const std::vector<glm::dvec3>& values) {
    double largest = 0.0;
    for (const glm::dvec3& v : values) {
        largest = std::max({largest, v.x, v.y, v.z});
    }
    return largest;
}

TEST(RandomStacks, BindOnlyWhatTheLobesNeed) {
    const Frame frame = random_frame(8, 8, rich_shape(), 1);
    EXPECT_EQ(frame.planes.count(), static_cast<int>(frame.plane_names.size()));
    const std::vector<std::string> expected{"Normal.X",
                                            "Normal.Y",
                                            "Normal.Z",
                                            "Position.X",
                                            "Position.Y",
                                            "Position.Z",
                                            "Coverage",
                                            "Albedo.R",
                                            "Albedo.G",
                                            "Albedo.B",
                                            "Layer1.Shininess",
                                            "Layer1.Absorption.R",
                                            "Layer1.Absorption.G",
                                            "Layer1.Absorption.B",
                                            "Layer2.ShininessU",
                                            "Layer2.ShininessV",
                                            "Layer2.Tangent.X",
                                            "Layer2.Tangent.Y",
                                            "Layer2.Tangent.Z",
                                            "Layer2.Absorption.R",
                                            "Layer2.Absorption.G",
                                            "Layer2.Absorption.B",
                                            "Layer3.Shininess",
                                            "Layer3.Absorption.R",
                                            "Layer3.Absorption.G",
                                            "Layer3.Absorption.B",
                                            "Layer4.F0.R",
                                            "Layer4.F0.G",
                                            "Layer4.F0.B",
                                            "Layer4.Shininess"};
    EXPECT_EQ(frame.plane_names, expected);
    const BoundMaterial& material = frame.materials.at(0);
    EXPECT_EQ(material.absorption, AbsorptionModel::original);
    EXPECT_TRUE(material.layers[0].f0.is_constant()); // a spectral layer lies below
    EXPECT_TRUE(material.layers[1].f0.is_constant());
    EXPECT_TRUE(material.layers[1].shininess.is_constant());
    EXPECT_EQ(material.layers[1].shininess.constant, glm::dvec3(0.0));
    EXPECT_FALSE(material.layers[1].tangent.is_constant());
    EXPECT_GE(material.layers[2].metal.samples.size(), 2U);
    EXPECT_TRUE(material.layers[3].metal.samples.empty());
    EXPECT_EQ(material.base().absorption.constant, glm::dvec3(0.0));
}

TEST(RandomStacks, TakeFresnelAndAbsorptionFromTheShape) {
    StackShape shape = shape_of({SpecularModel::blinn_phong, SpecularModel::none}, AbsorptionModel::approximated);
    shape.fresnel = FresnelModel::exact;
    const BoundMaterial two = random_frame(4, 4, shape, 1).materials.at(0);
    EXPECT_EQ(two.fresnel, FresnelModel::exact);
    EXPECT_EQ(two.absorption, AbsorptionModel::approximated);
    shape.layers = {SpecularModel::blinn_phong}; // nothing above the base absorbs
    EXPECT_EQ(random_frame(4, 4, shape, 1).materials.at(0).absorption, AbsorptionModel::none);
    EXPECT_THROW((void)random_frame(4, 4, shape_of({}), 1), UsageError);
    EXPECT_THROW((void)random_frame(4, 4, shape_of(std::vector<SpecularModel>(9)), 1), UsageError);
}

TEST(RandomStacks, TakeAmbientLightAsTheShapeSays) {
    StackShape shape = shape_of({SpecularModel::blinn_phong, SpecularModel::blinn_phong}, AbsorptionModel::original);
    shape.diffuse = DiffuseModel::oren_nayar;
    const Frame plain = random_frame(16, 8, shape, 1);
    EXPECT_EQ(plain.materials[0].absorption_ibl, AmbientAbsorption::deck);
    EXPECT_EQ(plain.materials[0].transmittance_ibl, AmbientTransmittance::fresnel);
    EXPECT_EQ(plain.materials[0].ambient, AmbientDiffuse::precise);
    shape.absorption_ibl = AmbientAbsorption::clamped;
    shape.transmittance_ibl = AmbientTransmittance::none;
    shape.ambient = AmbientDiffuse::full;
    const Frame other = random_frame(16, 8, shape, 1);
    EXPECT_EQ(other.materials[0].absorption_ibl, AmbientAbsorption::clamped);
    EXPECT_EQ(other.materials[0].transmittance_ibl, AmbientTransmittance::none);
    EXPECT_EQ(other.materials[0].ambient, AmbientDiffuse::full);
    EXPECT_EQ(hash_of(other), hash_of(plain));
    EXPECT_FALSE(other.environment.has_value());
}

TEST(RandomStacks, CoatsAreMostlyDielectrics) {
    const Frame frame = random_frame(side, side, shape_of({SpecularModel::blinn_phong, SpecularModel::blinn_phong}), 2);
    const std::vector<glm::dvec3> coat = values_of(frame, frame.materials[0].layers[0].f0);
    // 15 000 pixels: the standard error of a share is below 0.004.
    EXPECT_NEAR(share_of(coat, is_zero), 1.0 / 8.0 + 1.0 / 160.0, 0.015);
    const double dielectric = 9.0 / 49.0; // ((2.5 - 1) / (2.5 + 1))^2
    EXPECT_NEAR(share_of(coat,
                         [&](const glm::dvec3& v) {
                             return std::max({v.x, v.y, v.z}) > dielectric + 1e-6;
                         }),
                1.0 / 16.0 * 0.85, 0.015);
    EXPECT_EQ(largest_of(coat), 1.0);
    EXPECT_GT(share_of(coat, [](const glm::dvec3& v) { return v.x != v.y; }), 0.25);
    const std::vector<glm::dvec3> base = values_of(frame, frame.materials[0].base().f0);
    EXPECT_NEAR(share_of(base, is_zero), 0.1, 0.015);
    EXPECT_NEAR(share_of(base, [](const glm::dvec3& v) { return v == glm::dvec3(1.0); }), 0.1, 0.015);
}

TEST(RandomStacks, AbsorptionHasZeros) {
    const Frame frame = random_frame(
        side, side, shape_of({SpecularModel::none, SpecularModel::blinn_phong}, AbsorptionModel::approximated), 3);
    const std::vector<glm::dvec3> absorption = values_of(frame, frame.materials[0].layers[0].absorption);
    EXPECT_NEAR(share_of(absorption, is_zero), 1.0 / 6.0, 0.015);
    EXPECT_NEAR(share_of(absorption, [](const glm::dvec3& v) { return v.x == 0.0 && v.y > 0.0; }), 0.07, 0.015);
    EXPECT_LE(largest_of(absorption), 0.6 * (1.0 + 1e-6)); // rounded to single precision twice
    EXPECT_GT(largest_of(absorption), 0.59);
}

TEST(RandomStacks, ShininessIsCapped) {
    for (const double largest : {8192.0, 100.0, 0.01}) {
        StackShape shape = rich_shape();
        shape.diffuse = DiffuseModel::oren_nayar;
        shape.largest_shininess = largest;
        const Frame frame = random_frame(side, side, shape, 4);
        const BoundMaterial& material = frame.materials[0];
        for (const BoundParameter* parameter :
             {&material.layers[0].shininess, &material.layers[1].shininess_u, &material.layers[1].shininess_v,
              &material.layers[2].shininess, &material.base().shininess, &material.diffuse_shininess}) {
            const std::vector<glm::dvec3> values = values_of(frame, *parameter);
            EXPECT_NEAR(largest_of(values), largest, 1e-6 * largest);
            EXPECT_GT(share_of(values, [&](const glm::dvec3& v) { return v.x >= 0.999999 * largest; }), 0.05);
            EXPECT_NEAR(share_of(values, is_zero), 1.0 / 16.0, 0.01);
        }
    }
}

TEST(RandomStacks, TangentsAreFarFromWhereTheFrameChanges) {
    for (const bool some_constant : {false, true}) {
        std::uint64_t missing = 0;
        std::uint64_t parallel = 0;
        std::uint64_t sound = 0;
        for (std::uint64_t seed = 1; seed <= 12; ++seed) {
            StackShape shape =
                shape_of({SpecularModel::blinn_phong_anisotropic, SpecularModel::blinn_phong_anisotropic});
            shape.some_constant = some_constant;
            const Frame frame = random_frame(64, 64, shape, seed);
            for (const BoundLayer& layer : frame.materials[0].layers) {
                const std::vector<glm::dvec3> tangents = values_of(frame, layer.tangent);
                BoundParameter normal_planes;
                normal_planes.planes = frame.roles.normal;
                const std::vector<glm::dvec3> normals = values_of(frame, normal_planes);
                for (std::size_t i = 0; i < tangents.size(); ++i) {
                    if (is_zero(normals[i])) {
                        continue;
                    }
                    const double length = glm::length(tangents[i]);
                    const glm::dvec3 n = glm::normalize(normals[i]);
                    const double across = glm::length(tangents[i] - glm::dot(tangents[i], n) * n);
                    if (length == 0.0) {
                        ++missing;
                    } else if (across < 1e-5 * length) { // pixel rule 6 gives up at 1e-4
                        ++parallel;
                    } else {
                        ++sound;
                        ASSERT_GT(across, 0.049 * length);
                        ASSERT_LT(length, 2.0001);
                    }
                }
            }
        }
        const auto share = [all = static_cast<double>(missing + parallel + sound)](std::uint64_t count) {
            return static_cast<double>(count) / all;
        };
        if (!some_constant) { // 90 000 tangents: the standard error is below 0.001
            EXPECT_NEAR(share(missing), 1.0 / 16.0, 0.005);
            EXPECT_NEAR(share(parallel), 1.0 / 16.0, 0.005);
        } else { // a constant zero takes whole frames
            EXPECT_GT(share(sound), 0.5);
            EXPECT_GT(share(missing), 0.0);
        }
    }
}

/// Share of the pixels whose highlight of a distant light and shininess n is stronger than half of its peak.
double highlight_share(const Frame& frame, double n) {
    int lit = 0;
    for (int y = 0; y < frame.planes.height(); ++y) {
        for (int x = 0; x < frame.planes.width(); ++x) {
            glm::dvec3 normal;
            glm::dvec3 position;
            for (int i = 0; i < 3; ++i) {
                normal[i] = static_cast<double>(frame.planes.at(frame.roles.normal[static_cast<std::size_t>(i)], x, y));
                position[i] =
                    static_cast<double>(frame.planes.at(frame.roles.position[static_cast<std::size_t>(i)], x, y));
            }
            const glm::dvec3 half =
                glm::normalize(glm::normalize(frame.view.eye - position) - glm::normalize(frame.lights[0].direction));
            const double nh = glm::dot(normal, half) / std::max(glm::length(normal), 1e-6);
            lit += nh > 0.0 && std::pow(nh, n) > 0.5 ? 1 : 0;
        }
    }
    return lit / static_cast<double>(frame.planes.width() * frame.planes.height());
}

TEST(RandomStacks, EveryLayersHighlightIsHit) {
    // 0.4 of the pixels mirror one of four lights, a quarter of them or more for this lobe, half of those closely:
    // about 0.0125 of all. By chance it would be one in ten thousand.
    StackShape shape = shape_of({SpecularModel::blinn_phong, SpecularModel::blinn_phong_anisotropic});
    shape.some_constant = true;
    std::array<int, 3> sharp{};
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        const Frame frame = random_frame(48, 48, shape, seed);
        const std::vector<BoundLayer>& layers = frame.materials[0].layers;
        const std::array lobes{&layers[0].shininess, &layers[1].shininess_u, &layers[1].shininess_v};
        for (std::size_t i = 0; i < lobes.size(); ++i) {
            if (lobes[i]->is_constant() && lobes[i]->constant.x > 4000.0) {
                ++sharp[i];
                EXPECT_GT(highlight_share(frame, lobes[i]->constant.x), 0.003) << seed;
            }
        }
    }
    EXPECT_GT(*std::min_element(sharp.begin(), sharp.end()), 3);
}

TEST(RandomStacks, SomeConstantMixesConstantsAndPlanes) {
    int constants = 0;
    int grey = 0;
    int coloured = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        StackShape shape =
            shape_of({SpecularModel::blinn_phong, SpecularModel::blinn_phong_exact}, AbsorptionModel::approximated);
        shape.some_constant = true;
        const Frame frame = random_frame(4, 4, shape, seed);
        const BoundMaterial& material = frame.materials[0];
        for (const BoundParameter* parameter :
             {&material.albedo, &material.layers[0].f0, &material.layers[0].absorption, &material.base().f0}) {
            if (parameter->is_constant()) {
                ++constants;
                EXPECT_GE(std::min({parameter->constant.x, parameter->constant.y, parameter->constant.z}), 0.0);
                EXPECT_LE(std::max({parameter->constant.x, parameter->constant.y, parameter->constant.z}), 1.0);
            } else {
                (parameter->is_grey() ? grey : coloured) += 1;
            }
        }
        const bool absorbs =
            !material.layers[0].absorption.is_constant() || material.layers[0].absorption.constant != glm::dvec3(0.0);
        EXPECT_EQ(material.absorption, absorbs ? AbsorptionModel::approximated : AbsorptionModel::none);
    }
    EXPECT_NEAR(constants / 240.0, 0.5, 0.1); // three standard errors of 240 draws
    EXPECT_NEAR(grey / 240.0, 0.125, 0.065);
    EXPECT_NEAR(coloured / 240.0, 0.375, 0.095);
}

TEST(RandomStacks, SameSeedSameBytes) {
    EXPECT_EQ(hash_of(random_frame(33, 17, rich_shape(), 1)), hash_of(random_frame(33, 17, rich_shape(), 1)));
    EXPECT_NE(hash_of(random_frame(33, 17, rich_shape(), 1)), hash_of(random_frame(33, 17, rich_shape(), 2)));
    // Pinned: a machine or compiler that gives other bytes breaks the promise of random_gbuffer.h.
    EXPECT_EQ(hash_of(random_frame(33, 17, rich_shape(), 1)), "6e869485a767233da16eaef3600622ba");
    EXPECT_EQ(hash_of(random_frame(33, 17, SpecularModel::blinn_phong, DiffuseModel::oren_nayar, 1)),
              "076c4bd283beffea95af2288046aad7a");
}

TEST(RandomShapes, CoverEverythingThereIs) {
    std::set<std::size_t> depths;
    std::set<SpecularModel> lobes;
    std::set<SpecularModel> bases;
    std::set<DiffuseModel> diffuses;
    std::set<FresnelModel> fresnels;
    std::set<AbsorptionModel> absorptions;
    std::set<bool> constants;
    std::set<AmbientAbsorption> ambient_absorptions;
    std::set<AmbientTransmittance> transmittances;
    std::set<AmbientDiffuse> ambients;
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
        const StackShape shape = random_shape(seed);
        ASSERT_GE(shape.layers.size(), 1U);
        ASSERT_LE(shape.layers.size(), most_layers);
        ASSERT_TRUE(shape.layers.back() != SpecularModel::none || shape.diffuse != DiffuseModel::none);
        ASSERT_EQ(shape.layers, random_shape(seed).layers);
        depths.insert(shape.layers.size());
        lobes.insert(shape.layers.begin(), shape.layers.end());
        bases.insert(shape.layers.back());
        diffuses.insert(shape.diffuse);
        fresnels.insert(shape.fresnel);
        absorptions.insert(shape.absorption);
        constants.insert(shape.some_constant);
        ambient_absorptions.insert(shape.absorption_ibl);
        transmittances.insert(shape.transmittance_ibl);
        ambients.insert(shape.ambient);
        EXPECT_EQ(shape.largest_shininess, 65536.0);
    }
    EXPECT_EQ(depths.size(), most_layers);
    EXPECT_EQ(lobes.size(), all_specular_models.size());
    EXPECT_EQ(bases.size(), all_specular_models.size());
    EXPECT_EQ(diffuses.size(), all_diffuse_models.size());
    EXPECT_EQ(fresnels.size(), all_fresnel_models.size());
    EXPECT_EQ(absorptions.size(), all_absorption_models.size());
    EXPECT_EQ(ambient_absorptions.size(), all_ambient_absorptions.size());
    EXPECT_EQ(transmittances.size(), all_ambient_transmittances.size());
    EXPECT_EQ(ambients.size(), all_ambient_diffuses.size());
    EXPECT_EQ(constants.size(), 2U);
}

TEST(RandomShapes, MakeFramesOfFiniteValues) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const StackShape shape = random_shape(seed);
        const Frame frame = random_frame(16, 8, shape, seed);
        const std::span<const float> all = frame.planes.all();
        EXPECT_TRUE(std::all_of(all.begin(), all.end(), [](float v) { return std::isfinite(v); })) << seed;
        EXPECT_EQ(frame.materials.at(0).layers.size(), shape.layers.size());
    }
}

} // namespace
} // namespace clshade
