// Environments: device against reference for every way to take an environment's light, lane widths, bands, AOVs.
#include "tests/shading/environments.h"

#include <string>
#include <vector>

namespace clshade {
namespace {

constexpr int width = 48;
constexpr int height = 32;

Frame random_environment_frame(const StackShape& shape, AmbientSource diffuse, std::uint64_t seed) {
    Frame frame = random_frame(width, height, shape, seed);
    surround(frame, diffuse, seed);
    return frame;
}

std::string name_of(const StackShape& shape) {
    Frame frame = random_frame(16, 16, shape, 1);
    return model_key(frame.materials[0]);
}

/// A coat over a rough base, everything from planes.
StackShape coated() {
    StackShape shape;
    shape.layers = {SpecularModel::blinn_phong, SpecularModel::blinn_phong_exact};
    shape.diffuse = DiffuseModel::oren_nayar;
    shape.absorption = AbsorptionModel::approximated;
    return shape;
}

TEST(Environment, SingleLayersAgree) {
    std::uint64_t seed = 0;
    for (const SpecularModel specular : all_specular_models) {
        for (const FresnelModel fresnel : all_fresnel_models) {
            StackShape shape;
            shape.layers = {specular};
            shape.fresnel = fresnel;
            shape.diffuse = fresnel == FresnelModel::exact ? DiffuseModel::lambert : DiffuseModel::oren_nayar;
            ++seed;
            Frame frame = random_environment_frame(shape, all_ambient_sources[seed % 3], seed);
            expect_environment_agreement(frame, 0, name_of(shape));
        }
    }
}

TEST(Environment, RandomStacksAgree) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const StackShape shape = random_shape(seed);
        Frame frame = random_environment_frame(shape, all_ambient_sources[seed % 3], seed);
        const int lanes = seed % 4 == 0 ? 1 : 0;
        expect_environment_agreement(frame, lanes, name_of(shape) + " seed " + std::to_string(seed));
    }
}

// Every way to weaken the light on its way to lower layers, as materials of one frame.
TEST(Environment, EveryAbsorptionTransmittanceAndFresnelModelAgrees) {
    Frame frame = random_environment_frame(coated(), AmbientSource::sh3, 17);
    std::vector<BoundMaterial> materials;
    for (const AmbientAbsorption absorption_ibl : all_ambient_absorptions) {
        for (const AbsorptionModel absorption : {AbsorptionModel::approximated, AbsorptionModel::original}) {
            for (const AmbientTransmittance transmittance : all_ambient_transmittances) {
                BoundMaterial material = frame.materials[0];
                material.absorption_ibl = absorption_ibl;
                material.absorption = absorption;
                material.transmittance_ibl = transmittance;
                // Both Fresnel models with either of the others; every other material has its absorption folded.
                material.fresnel = all_fresnel_models[(materials.size() + materials.size() / 2) % 2];
                if (materials.size() % 2 == (materials.size() / 4) % 2) {
                    material.layers[0].absorption = constant_of(glm::dvec3(0.05, 0.3, 1.4));
                }
                materials.push_back(material);
            }
        }
    }
    spread_materials(frame, std::move(materials));
    expect_environment_agreement(frame, 0, "ways through a stack");
}

TEST(Environment, EveryAmbientDiffuseAndSourceAgrees) {
    for (const AmbientSource source : all_ambient_sources) {
        Frame frame = random_environment_frame(coated(), source, 23);
        const BoundMaterial first = frame.materials[0];
        std::vector<BoundMaterial> materials;
        for (const AmbientDiffuse ambient : all_ambient_diffuses) {
            for (const DiffuseModel diffuse : {DiffuseModel::oren_nayar, DiffuseModel::oren_nayar_full}) {
                BoundMaterial material = first;
                material.layers = {first.layers.back()};
                material.diffuse = diffuse;
                material.ambient = ambient;
                material.base().specular =
                    diffuse == DiffuseModel::oren_nayar ? SpecularModel::none : SpecularModel::blinn_phong_exact;
                if (material.base().specular == SpecularModel::none) {
                    material.base().f0 = material.base().shininess = BoundParameter{};
                } else {
                    material.diffuse_shininess = constant_of(2.0);
                }
                materials.push_back(material);
            }
        }
        spread_materials(frame, std::move(materials));
        expect_environment_agreement(frame, 0, std::string(clshade::name_of(source)));
    }
}

// Metals and brushed metals met from air and inside, from planes and constants.
TEST(Environment, SpectralAndAnisotropicLobesAgreeAtEveryDepth) {
    constexpr auto plain = SpecularModel::blinn_phong;
    constexpr auto metal = SpecularModel::blinn_phong_spectral;
    constexpr auto brushed = SpecularModel::blinn_phong_anisotropic;
    const std::vector<std::vector<SpecularModel>> stacks = {
        {metal, plain}, {plain, metal}, {brushed, plain}, {plain, brushed}, {brushed, metal, brushed}};
    std::uint64_t seed = 40;
    for (const auto& layers : stacks) {
        StackShape shape;
        shape.layers = layers;
        shape.diffuse = DiffuseModel::lambert;
        shape.fresnel = all_fresnel_models[++seed % 2];
        shape.absorption = AbsorptionModel::approximated;
        Frame frame = random_environment_frame(shape, AmbientSource::irradiance_map, seed);
        const BoundMaterial mapped = frame.materials[0];
        BoundMaterial fixed = mapped;
        fixed.fresnel = all_fresnel_models[(seed + 1) % 2];
        for (std::size_t k = 0; k < fixed.layers.size(); ++k) {
            BoundLayer& layer = fixed.layers[k];
            const double n = 30.0 * std::pow(9.0, static_cast<double>(k));
            if (layer.specular == brushed) {
                layer.shininess_u = constant_of(n);
                layer.shininess_v = constant_of(4.0);
                layer.tangent = constant_of({0.3, -0.2, 0.9});
            } else {
                layer.shininess = constant_of(n);
            }
        }
        BoundMaterial half = mapped; // one exponent from a plane, one constant
        for (BoundLayer& layer : half.layers) {
            if (layer.specular == brushed) {
                layer.shininess_v = constant_of(700.0);
            }
        }
        spread_materials(frame, {mapped, fixed, half});
        expect_environment_agreement(frame, 0, name_of(shape));
    }
}

/// Materials of most kinds in one frame, under one light and the studio.
Frame mixed_frame() {
    Frame frame = random_environment_frame(coated(), AmbientSource::irradiance_map, 31);
    frame.lights.resize(1);
    const BoundMaterial mapped = frame.materials[0];
    BoundMaterial fixed = mapped;
    fixed.layers[0].shininess = constant_of(900.0);
    fixed.layers[1].shininess = constant_of(3.0);
    fixed.ambient = AmbientDiffuse::order1;
    fixed.absorption_ibl = AmbientAbsorption::exponential;
    BoundMaterial gold = mapped;
    gold.layers = {mapped.layers.back()};
    gold.base().specular = SpecularModel::blinn_phong_spectral;
    gold.base().f0 = BoundParameter{};
    gold.base().metal = {"any.txt", {{380.0, 0.2, 1.5}, {550.0, 0.4, 2.5}, {780.0, 0.2, 4.5}}};
    BoundMaterial brushed = gold;
    brushed.base().specular = SpecularModel::blinn_phong_anisotropic;
    brushed.base().metal = {};
    brushed.base().f0 = constant_of({0.9, 0.5, 0.2});
    brushed.base().shininess_u = mapped.base().shininess;
    brushed.base().shininess_v = constant_of(20.0);
    brushed.base().tangent = constant_of({0.1, 0.4, 1.0});
    brushed.base().shininess = BoundParameter{};
    spread_materials(frame, {mapped, fixed, gold, brushed});
    return frame;
}

TEST(Environment, EveryLaneWidthGivesTheSame) {
    Frame frame = mixed_frame();
    const ExpectedPicture expected = expected_of(frame, all_aovs);
    for (const int lanes : {1, 4, 8, 16}) {
        expect_as_expected(shade(frame, lanes, all_aovs), expected, frame, std::to_string(lanes) + " lanes");
    }
}

TEST(Environment, BandsAndRepetitionGiveTheSameBytes) {
    Frame frame = mixed_frame();
    const ShadedImage whole = shade(frame, 16, all_aovs);
    EXPECT_TRUE(same_bytes(whole, shade(frame, 16, all_aovs)));
    EXPECT_TRUE(same_bytes(whole, shade(frame, 16, all_aovs, 1024)));
}

// An exponent that is the same everywhere is looked up in a map made for it, others between two levels.
TEST(Environment, APlaneOfOneExponentIsTheConstant) {
    const std::vector<double> exponents = {0.0, 1.0, 5.0, 64.0, 200.0, 8192.0, 65536.0};
    StackShape shape;
    shape.diffuse = DiffuseModel::none;
    Frame frame = random_environment_frame(shape, AmbientSource::sh2, 5);
    frame.lights.clear();
    const std::vector<BoundMaterial> materials(exponents.size(), frame.materials[0]);
    spread_materials(frame, materials);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto id = static_cast<std::size_t>(frame.planes.at(frame.roles.material_id, x, y));
            frame.planes.at(materials[0].base().shininess.planes[0], x, y) = static_cast<float>(exponents[id]);
        }
    }
    for (BoundMaterial& material : frame.materials) {
        material.base().shininess.averaged = false;
    }
    const ShadedImage mapped = shade(frame, 16);
    for (std::size_t i = 0; i < exponents.size(); ++i) {
        frame.materials[i].base().shininess = constant_of(exponents[i]);
    }
    EXPECT_LE(largest_difference(mapped, shade(frame, 16), 0.05), 1e-5);
}

TEST(Environment, WithAnyNumberOfLightsTheAovsAddUpToBeauty) {
    for (const std::size_t lights : {0U, 1U, 3U}) {
        Frame frame = random_environment_frame(coated(), AmbientSource::sh2, 9);
        frame.lights.resize(lights);
        const PlaneIndex glow =
            add_plane(frame, "glow", [](int x, int y) { return 0.1F * static_cast<float>((x + y) % 4); });
        frame.emission.planes = {glow, glow, glow};
        frame.emission.averaged = false;
        frame.has_emission = true;
        const ShadedImage image = shade(frame, 16, all_aovs);
        ASSERT_EQ(image.plane_names, output_plane_names(frame, all_aovs));
        const int first = 10; // R G B A, diffuse, specular, then lights and environment
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const float alpha = image.planes.at(3, x, y);
                for (int c = 0; c < 3; ++c) {
                    const float beauty = image.planes.at(c, x, y);
                    float sum = alpha > 0.0F ? frame.planes.at(glow, x, y) * alpha : 0.0F;
                    const float emitted = sum;
                    for (int plane = first + c; plane < image.planes.count(); plane += 3) {
                        sum += image.planes.at(plane, x, y);
                    }
                    // A handful of roundings.
                    ASSERT_NEAR(sum, beauty, 2e-6F * (0.1F + beauty)) << lights << " lights at " << x << "," << y;
                    ASSERT_NEAR(image.planes.at(4 + c, x, y) + image.planes.at(7 + c, x, y), beauty - emitted,
                                2e-6F * (0.1F + beauty));
                }
            }
        }
        expect_environment_agreement(frame, 16, std::to_string(lights) + " lights");
    }
}

TEST(Environment, ASunTwoHundredThousandTimesAsBrightAgrees) {
    const FilteredStudio sunny = filtered(picture_of(128, [](int x, int y) {
        return x >= 60 && x < 62 && y >= 40 && y < 42 ? glm::dvec3(2e5, 1.8e5, 1.5e5) : glm::dvec3(0.4, 0.5, 0.7);
    }));
    for (const bool exact : {false, true}) {
        StackShape shape = coated();
        shape.fresnel = exact ? FresnelModel::exact : FresnelModel::constant;
        Frame frame = random_frame(width, height, shape, 77);
        surround(frame, exact ? AmbientSource::irradiance_map : AmbientSource::sh3, 77, sunny);
        const ShadedImage image = shade(frame, 16, all_aovs);
        float brightest = 0.0F;
        for (const float value : image.planes.all()) {
            ASSERT_TRUE(std::isfinite(value));
            brightest = std::max(brightest, value);
        }
        EXPECT_GT(brightest, 1e3F); // some pixel mirrors it
        EXPECT_EQ(image.counts.nonfinite, 0U);
        expect_as_expected(image, expected_of(frame, all_aovs), frame, "a sun");
    }
}

} // namespace
} // namespace clshade
