// Materials under an environment: rule 11 of host/gbuffer/frame.h (models.md sections 6, 7, 9).
#include "host/reference/diffuse.h"
#include "host/reference/environment_light.h"
#include "host/reference/preintegrated_absorption.h"
#include "host/reference/sh_oren_nayar.h"
#include "host/scene/metal_table.h"
#include "tests/reference/environment_pictures.h"
#include "tests/reference/furnace.h"
#include "tests/reference/stacks.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace clshade::reference {
namespace {

constexpr double pi = std::numbers::pi;
const glm::dvec3 up{0.0, 0.0, 1.0};

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

MaterialValues single(const LayerValues& layer, FresnelModel fresnel = FresnelModel::constant,
                      DiffuseModel diffuse = DiffuseModel::lambert) {
    return stack_of({layer}, fresnel, AbsorptionModel::none, diffuse, {0.9, 0.5, 0.1});
}

/// Under a constant environment of radiance 2, N = up.
class ConstantEnvironment : public testing::Test {
  protected:
    [[nodiscard]] EnvironmentLight light(const MaterialValues& material, double ne) const {
        return environment_light(material, environment_, up, eye_at(ne));
    }
    [[nodiscard]] EnvironmentLight light(const MaterialValues& material) const { return light(material, 0.6); }

    BoundEnvironment bound_ = environment_of(constant_picture(glm::dvec3(2.0)));
    PreparedEnvironment environment_{bound_};
};

TEST_F(ConstantEnvironment, DiffuseIsAlbedoTimesWhatFresnelLeaves) {
    const LayerValues layer = layer_of(SpecularModel::blinn_phong, {0.04, 0.5, 0.0}, 20.0);
    const glm::dvec3 left = 1.0 - layer.f0;
    MaterialValues material = single(layer);
    EXPECT_LT(largest(light(material).diffuse - 2.0 * material.albedo * left), 1e-12);
    material.diffuse = DiffuseModel::oren_nayar;
    const glm::dvec3 d = sh_dc_factor(AmbientDiffuse::precise, material.diffuse_shininess, 0.6, material.albedo);
    // Bands 1 of a constant are 0 but for roundings.
    EXPECT_LT(largest(light(material).diffuse - 2.0 * material.albedo * left * d), 1e-12);
    EXPECT_LT(d.x, 0.98);
    // Section 6: 20/21 for the exact form; none and no lobe: all of it.
    const LayerValues exact = layer_of(SpecularModel::blinn_phong_exact, {0.04, 0.5, 0.0}, 20.0);
    material = single(exact);
    EXPECT_LT(largest(light(material).diffuse - 2.0 * material.albedo * left * 20.0 / 21.0), 1e-12);
    material = single(layer_of(SpecularModel::none, glm::dvec3(0.0), 0.0));
    EXPECT_LT(largest(light(material).diffuse - 2.0 * material.albedo), 1e-12);
    EXPECT_EQ(light(material).specular, glm::dvec3(0.0));
    // fresnel = exact: the dielectric formula at N.E.
    material = single(layer, FresnelModel::exact);
    const double reflected = fresnel_dielectric(layer.index.x, 0.6);
    EXPECT_NEAR(light(material).diffuse.x, 2.0 * 0.9 * (1.0 - reflected), 1e-12);
}

TEST_F(ConstantEnvironment, MirrorOfF0OneIsScalePlusBias) {
    for (const double ne : {0.02, 0.6, 1.0}) {
        for (const double n : {0.0, 13.0, 900.0, 65536.0}) {
            const auto sum = [&](Normaliser normaliser) {
                const AmbientBrdf brdf = ambient_brdf_of_table(n, ne, normaliser);
                return 2.0 * (brdf.scale + brdf.bias);
            };
            const auto specular = [&](SpecularModel model, FresnelModel fresnel) {
                return light(single(layer_of(model, glm::dvec3(1.0), n), fresnel), ne).specular.x;
            };
            using enum SpecularModel;
            EXPECT_NEAR(specular(blinn_phong, FresnelModel::constant), sum(Normaliser::linear), 1e-12);
            EXPECT_NEAR(specular(blinn_phong, FresnelModel::exact), sum(Normaliser::exact), 1e-12);
            EXPECT_NEAR(specular(blinn_phong_exact, FresnelModel::constant), sum(Normaliser::exact), 1e-12);
            // n_u = n_v: the mean exponent is n, the five weights add up to 1 (as printed: to 2e-8).
            EXPECT_NEAR(specular(blinn_phong_anisotropic, FresnelModel::constant), sum(Normaliser::exact), 1e-7);
        }
    }
}

TEST_F(ConstantEnvironment, MetalsHaveTheirOwnTable) {
    const SpectralMetal gold(built_in_metal("gold").value());
    const MetalAmbient ambient(gold);
    LayerValues layer = layer_of_metal(gold, 40.0);
    layer.metal_ambient = &ambient;
    const glm::dvec3 expected = 2.0 * ambient.of_table(40.0, 0.6, Normaliser::linear);
    EXPECT_LT(largest(light(single(layer)).specular - expected), 1e-12);
    // Under a coat: r_k (scale + bias), with the transmittance of the coat both ways.
    const LayerValues coat = layer_of_index(SpecularModel::blinn_phong, 1.5, 500.0);
    const MaterialValues stack = stack_of({coat, layer}, FresnelModel::constant);
    const AmbientBrdf brdf = ambient_brdf_of_table(40.0, 0.6, Normaliser::linear);
    const AmbientBrdf above = ambient_brdf_of_table(500.0, 0.6, Normaliser::linear);
    const double enters = 1.0 - schlick_gaussian(glm::dvec3(0.04), 0.6).x;
    const glm::dvec3 inside =
        gold.reflectance(glm::dvec3(1.5), glm::dvec3(1.0)) * (brdf.scale + brdf.bias) * enters * 0.96;
    EXPECT_LT(largest(light(stack).specular - 2.0 * (0.04 * above.scale + above.bias + inside)), 1e-12);
}

TEST_F(ConstantEnvironment, ACoatOfAirChangesNothing) {
    const LayerValues bottom = layer_of(SpecularModel::blinn_phong, glm::dvec3(0.1), 30.0);
    const LayerValues air = layer_of(SpecularModel::blinn_phong, glm::dvec3(0.0), 400.0);
    for (const FresnelModel fresnel : {FresnelModel::constant, FresnelModel::exact}) {
        const EnvironmentLight alone = light(single(bottom, fresnel));
        const EnvironmentLight coated = light(
            stack_of({air, bottom}, fresnel, AbsorptionModel::approximated, DiffuseModel::lambert, {0.9, 0.5, 0.1}));
        EXPECT_EQ(alone.diffuse, coated.diffuse);
        EXPECT_EQ(alone.specular, coated.specular);
    }
}

TEST_F(ConstantEnvironment, NoAbsorptionIsAbsorptionOfNothing) {
    LayerValues coat = layer_of_index(SpecularModel::blinn_phong, 1.5, 300.0);
    const LayerValues bottom = layer_of(SpecularModel::blinn_phong, glm::dvec3(0.1), 30.0);
    const auto stack = [&](AbsorptionModel model, AmbientAbsorption form) {
        MaterialValues material =
            stack_of({coat, bottom}, FresnelModel::constant, model, DiffuseModel::lambert, glm::dvec3(0.7));
        material.absorption_ibl = form;
        return light(material);
    };
    using enum AmbientAbsorption;
    const EnvironmentLight none = stack(AbsorptionModel::none, deck);
    for (const AmbientAbsorption form : {deck, clamped, exponential}) {
        EXPECT_LT(largest(stack(AbsorptionModel::original, form).diffuse - none.diffuse), 1e-14);
        EXPECT_LT(largest(stack(AbsorptionModel::original, form).specular - none.specular), 1e-14);
    }
    coat.absorption = {0.3, 0.1, 0.0};
    EXPECT_EQ(stack(AbsorptionModel::none, deck).specular, none.specular);
    const EnvironmentLight absorbed = stack(AbsorptionModel::approximated, exponential);
    EXPECT_NEAR(absorbed.diffuse.x, none.diffuse.x * 2.0 * exponential_integral_3(0.3) * std::exp(-0.5), 1e-14);
    EXPECT_NEAR(absorbed.diffuse.z, none.diffuse.z, 1e-14);
    // `original` gives alpha d: a' = (1 - exp(-2 alpha d))/2 for the deck's form, itself for the exponential.
    EXPECT_EQ(stack(AbsorptionModel::original, exponential).diffuse, absorbed.diffuse);
    const double a = 0.5 * (1.0 - std::exp(-0.2));
    EXPECT_NEAR(stack(AbsorptionModel::original, deck).diffuse.y, none.diffuse.y * (1.0 - a * (2.0 + 1.0 / 0.6)),
                1e-14);
}

TEST_F(ConstantEnvironment, TransmittanceCanBeLeftOut) {
    const LayerValues coat = layer_of_index(SpecularModel::blinn_phong_exact, 1.5, 300.0);
    const LayerValues bottom = layer_of_index(SpecularModel::blinn_phong, 2.0, 30.0);
    const double f = schlick(glm::dvec3(0.04), 0.6).x;
    for (const FresnelModel fresnel : {FresnelModel::constant, FresnelModel::exact}) {
        MaterialValues stack =
            stack_of({coat, bottom}, fresnel, AbsorptionModel::none, DiffuseModel::lambert, glm::dvec3(1.0));
        const std::array<LayerAmbient, most_layers> ambient = [&] {
            std::array<LayerAmbient, most_layers> values{};
            values[1].brdf.scale = 1.0; // the bottom's lobe alone
            return values;
        }();
        const AmbientWeights with = ambient_weights(stack, 0.6, ambient);
        stack.transmittance_ibl = AmbientTransmittance::none;
        const AmbientWeights without = ambient_weights(stack, 0.6, ambient);
        if (fresnel == FresnelModel::constant) {
            const double r = f0_between(1.5, 2.0);
            EXPECT_NEAR(with.specular[1].x, r * 0.96 * (1.0 - f), 1e-14);
            EXPECT_NEAR(without.specular[1].x, r * 0.96, 1e-14); // F_b keeps its (1 - F0(1/n1))
            EXPECT_NEAR(with.diffuse.x, (1.0 - r * 0.96) * (1.0 - f), 1e-14);
            EXPECT_NEAR(without.diffuse.x, 1.0 - r * 0.96, 1e-14);
        } else {
            const double top = fresnel_dielectric(1.5, 0.6);
            const double below = fresnel_dielectric(2.0 / 1.5, refracted_cosine(0.6, 1.5));
            EXPECT_NEAR(with.specular[1].x, below * (1.0 - top) * (1.0 - top), 1e-14);
            EXPECT_NEAR(without.specular[1].x, below, 1e-14);
            EXPECT_NEAR(with.diffuse.x, (1.0 - below) * (1.0 - top) * (1.0 - top), 1e-14);
            EXPECT_NEAR(without.diffuse.x, 1.0 - below, 1e-14);
        }
    }
}

TEST_F(ConstantEnvironment, DeeperStacksUseNormalIncidenceInside) {
    const LayerValues coat = layer_of_index(SpecularModel::blinn_phong, 1.5, 300.0);
    LayerValues middle = layer_of_index(SpecularModel::blinn_phong, 1.8, 100.0);
    middle.absorption = glm::dvec3(0.05);
    const LayerValues bottom = layer_of_index(SpecularModel::blinn_phong, 2.4, 30.0);
    const MaterialValues stack = stack_of({coat, middle, bottom}, FresnelModel::constant, AbsorptionModel::approximated,
                                          DiffuseModel::lambert, glm::dvec3(1.0));
    std::array<LayerAmbient, most_layers> ambient{};
    for (std::size_t k = 0; k < 3; ++k) {
        ambient.at(k).brdf = {0.5, 0.25};
    }
    const AmbientWeights weights = ambient_weights(stack, 0.5, ambient);
    const double f = schlick_gaussian(glm::dvec3(0.04), 0.5).x;
    const double r1 = f0_between(1.5, 1.8);
    const double r2 = f0_between(1.8, 2.4);
    EXPECT_NEAR(weights.specular[0].x, 0.04 * 0.5 + 0.25, 1e-14);
    EXPECT_NEAR(weights.specular[1].x, r1 * 0.75 * (1.0 - f) * 0.96, 1e-14);
    const double a_s = 1.0 - 2.0 * 0.05 / 0.5;
    EXPECT_NEAR(weights.specular[2].x, r2 * 0.75 * (1.0 - f) * 0.96 * (1.0 - r1) * (1.0 - r1) * a_s, 1e-14);
    const double a_d = 1.0 - 0.05 * (2.0 + 1.0 / 0.5);
    const double u2 = 0.96 * (1.0 - r1);
    EXPECT_NEAR(weights.diffuse.x, (1.0 - f) * (1.0 - r1 * 0.96) * (1.0 - r2 * u2) * a_d, 1e-14);
}

TEST(EnvironmentLight, TurnsWithTheScene) {
    const auto image = random_picture(32, 6);
    const SpectralMetal gold(built_in_metal("gold").value());
    const MetalAmbient gold_ambient(gold);
    LayerValues metal = layer_of_metal(gold, 70.0);
    metal.metal_ambient = &gold_ambient;
    LayerValues brushed = layer_of(SpecularModel::blinn_phong_anisotropic, glm::dvec3(0.5), 0.0);
    brushed.shininess_u = 300.0;
    brushed.shininess_v = 8.0;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, -0.4, 0.7));
    const glm::dvec3 eye = glm::normalize(glm::dvec3(-0.6, 0.1, 0.5));
    const glm::dmat3 turn = rotation_about({1.0, 2.0, -0.7}, 2.1);
    for (const LayerValues& layer : {layer_of(SpecularModel::blinn_phong, glm::dvec3(0.3), 50.0), metal, brushed}) {
        for (const AmbientSource source : {AmbientSource::sh2, AmbientSource::sh3, AmbientSource::irradiance_map}) {
            MaterialValues material = single(layer, FresnelModel::constant, DiffuseModel::oren_nayar);
            material.ambient = AmbientDiffuse::order1;
            BoundEnvironment bound = environment_of(image);
            bound.diffuse = source;
            bound.world_to_image = rotation_about({0.0, 1.0, 0.3}, 0.4);
            find_tangents(material, normal);
            const EnvironmentLight before = environment_light(material, PreparedEnvironment(bound), normal, eye);
            BoundEnvironment turned = bound;
            turned.world_to_image = bound.world_to_image * glm::transpose(turn);
            for (LayerValues& values : material.layers()) {
                values.tangent_read = turn * values.tangent_read;
            }
            find_tangents(material, turn * normal);
            const EnvironmentLight after =
                environment_light(material, PreparedEnvironment(turned), turn * normal, turn * eye);
            // Roundings of the turned directions, times the levels' gradients.
            EXPECT_LT(largest(before.diffuse - after.diffuse), 1e-13);
            EXPECT_LT(largest(before.specular - after.specular), 1e-11);
            EXPECT_GT(after.diffuse.x, 1e-3);
            EXPECT_GT(after.specular.x, 0.01);
        }
    }
}

TEST(EnvironmentLight, ShOfARotatedEnvironmentIsTheRotatedSh) {
    // Columns moved by 5 are the picture turned about z by 5/32 of a circle: row 0's axis, clockwise as u grows.
    const auto image = random_picture(16, 8);
    auto moved = std::make_shared<LatLong>(*image);
    for (std::size_t y = 0; y < 16; ++y) {
        for (std::size_t x = 0; x < 96; ++x) {
            moved->rgb[y * 96 + (x + 15) % 96] = image->rgb[y * 96 + x];
        }
    }
    BoundEnvironment turned = environment_of(image);
    turned.diffuse = AmbientSource::sh3;
    // What stands at azimuth a in the picture stands at a - 5/32 of a circle in the world.
    turned.world_to_image = rotation_about(up, 2.0 * pi * 5.0 / 32.0);
    EXPECT_LT(largest(glm::dvec3(world_to_image(UpAxis::z, -2.0 * pi * 5.0 / 32.0) * glm::dvec3(1.0, 2.0, 3.0)) -
                      turned.world_to_image * glm::dvec3(1.0, 2.0, 3.0)),
              1e-12);
    BoundEnvironment resampled = environment_of(moved);
    resampled.diffuse = AmbientSource::sh3;
    const PreparedEnvironment by_matrix(turned);
    const PreparedEnvironment by_picture(resampled);
    for (const glm::dvec3& direction : {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.3, -0.8, 0.2), up}) {
        const glm::dvec3 n = glm::normalize(direction);
        const DiffuseLight a = by_matrix.diffuse_light(n, {0.0, 1.0, 0.0});
        const DiffuseLight b = by_picture.diffuse_light(n, {0.0, 1.0, 0.0});
        EXPECT_LT(largest(a.all() - b.all()), 1e-12);
        EXPECT_LT(largest(a.rest - b.rest), 1e-12);
        EXPECT_LT(largest(a.tangent - b.tangent), 1e-12);
        EXPECT_LT(largest(by_matrix.radiance(n, 60.0) - by_picture.radiance(n, 60.0)), 0.02); // other vertices
    }
}

TEST(EnvironmentLight, DiffuseSourcesAreWhatTheirNamesSay) {
    BoundEnvironment bound = environment_of(random_picture(16, 5));
    bound.world_to_image = rotation_about({1.0, 0.5, 0.0}, 0.9);
    const PreparedEnvironment environment(bound);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.1, -0.7, 0.3));
    const glm::dvec3 turned = bound.world_to_image * normal;
    const auto band = [&](std::size_t l) { return sh_irradiance_band(environment.map().sh(), l, turned); };
    const auto seen = [&](AmbientSource source) {
        bound.diffuse = source;
        return environment.diffuse_light(normal, up).all();
    };
    EXPECT_LT(largest(seen(AmbientSource::sh2) - (band(0) + band(1))), 1e-14);
    EXPECT_LT(largest(seen(AmbientSource::sh3) - (band(0) + band(1) + band(2))), 1e-14);
    EXPECT_LT(largest(seen(AmbientSource::irradiance_map) - environment.map().irradiance_over_pi(turned)), 1e-14);
    EXPECT_GT(largest(band(2)), 1e-4);
}

TEST(EnvironmentLight, IntensityMultipliesEverything) {
    BoundEnvironment bound = environment_of(random_picture(16, 3));
    const LayerValues layer = layer_of(SpecularModel::blinn_phong, glm::dvec3(0.3), 50.0);
    const EnvironmentLight one = environment_light(single(layer), PreparedEnvironment(bound), up, eye_at(0.5));
    bound.intensity = {2.0, 3.0, 0.0};
    const EnvironmentLight more = environment_light(single(layer), PreparedEnvironment(bound), up, eye_at(0.5));
    EXPECT_LT(largest(more.diffuse - one.diffuse * bound.intensity), 1e-14);
    EXPECT_LT(largest(more.specular - one.specular * bound.intensity), 1e-14);
}

TEST(EnvironmentLight, AnisotropicLobesGatherAlongTheAxisOfTheSmallerExponent) {
    // A bright band across y = 0 (the x-z plane): a highlight drawn out along y sees less of it, one along x more.
    const auto image = picture_of(64, [](const glm::dvec3& d) { return glm::dvec3(std::exp(-20.0 * d.y * d.y)); });
    const BoundEnvironment bound = environment_of(image);
    const PreparedEnvironment environment(bound);
    LayerValues layer = layer_of(SpecularModel::blinn_phong_anisotropic, glm::dvec3(1.0), 0.0);
    const auto gathered = [&](double n_u, double n_v) {
        layer.shininess_u = n_u;
        layer.shininess_v = n_v;
        return gathered_radiance(single(layer).base(), environment, up, up).x; // T = x
    };
    // The band's variance across is 1/40; the lobe's 4 v = 1/200 across the axis and 4 w = 1/25 along it, in R.
    EXPECT_NEAR(gathered(100.0, 4000.0), std::sqrt(0.025 / (0.025 + 0.005)), 0.02);
    EXPECT_NEAR(gathered(4000.0, 100.0), std::sqrt(0.025 / (0.025 + 0.04)), 0.02);
    // Equal exponents: all five lookups are the mirror direction of level n.
    EXPECT_NEAR(gathered(50.0, 50.0), environment.radiance(up, 50.0).x, 1e-7);
}

TEST(ShOrenNayar, EqualsThePunctualModelOverAConstantEnvironment) {
    // Section 9.1. The midpoint rule is good to 1e-4 with twice furnace.h's rings.
    for (const double n : {0.0, 2.0, 12.0, 200.0}) {
        for (const double ne : {0.02, 0.3, 0.8, 1.0}) {
            const Lobe improved = [&](const Angles& a) { return oren_nayar_improved(a, glm::dvec3(1.0), n).x; };
            const double d = sh_dc_factor(AmbientDiffuse::precise, n, ne, glm::dvec3(1.0)).x;
            EXPECT_NEAR(d, reflectance_of_diffuse(improved, ne, 400, 200), printed) << n << " " << ne;
            const Lobe full = [&](const Angles& a) {
                const OrenNayarParts parts = oren_nayar_full(a, glm::dvec3(0.6), sigma2_of_shininess(n));
                return (parts.l1 + parts.l2).x / 0.6;
            };
            // 9.2: the polynomial is good to 9.1e-4 times B <= 0.45.
            const double d_full = sh_dc_factor(AmbientDiffuse::full, n, ne, glm::dvec3(0.6)).x;
            EXPECT_NEAR(d_full, reflectance_of_diffuse(full, ne, 400, 200), 4.1e-4 + printed) << n << " " << ne;
        }
    }
}

TEST(ShOrenNayar, Order1EqualsThePunctualModelOverALinearEnvironment) {
    // L = 1 + b.w, section 9.5.
    const glm::dvec3 b{0.5, -0.2, 0.3};
    const BoundEnvironment bound =
        environment_of(picture_of(128, [&](const glm::dvec3& d) { return glm::dvec3(1.0 + glm::dot(b, d)); }));
    const PreparedEnvironment environment(bound);
    for (const double n : {0.0, 6.0, 100.0}) {
        for (const double ne : {5e-4, 0.2, 0.7}) {
            const glm::dvec3 eye = eye_at(ne);
            double sum = 0.0; // midpoint rule over the whole hemisphere
            for (int i = 0; i < 200; ++i) {
                const double theta = (i + 0.5) / 200.0 * pi / 2.0;
                for (int j = 0; j < 200; ++j) {
                    const glm::dvec3 light = direction_at(theta, (j + 0.5) / 200.0 * 2.0 * pi);
                    sum += oren_nayar_improved(unclamped_angles(eye, light), glm::dvec3(1.0), n).x *
                           (1.0 + glm::dot(b, light)) * std::sin(theta);
                }
            }
            sum *= pi / 2.0 / 200.0 * 2.0 * pi / 200.0;
            MaterialValues material = single(layer_of(SpecularModel::none, glm::dvec3(0.0), 0.0),
                                             FresnelModel::constant, DiffuseModel::oren_nayar);
            material.ambient = AmbientDiffuse::order1;
            material.albedo = glm::dvec3(1.0);
            material.diffuse_shininess = n;
            const double value = environment_light(material, environment, up, eye).diffuse.x;
            // Both integrations, and the picture's 128 rows.
            EXPECT_NEAR(value, sum, 3e-4) << n << " " << ne;
        }
    }
}

TEST(ShOrenNayar, DarkIsNotNegative) {
    DiffuseLight light;
    light.constant = glm::dvec3(0.1, 1.0, 1.0);
    light.linear = glm::dvec3(-0.5, -0.5, -0.5);
    MaterialValues material;
    material.diffuse = DiffuseModel::lambert;
    EXPECT_EQ(diffuse_response(material, 0.5, light).x, 0.0);
    EXPECT_EQ(diffuse_response(material, 0.5, light).y, 0.5);
    material.diffuse = DiffuseModel::oren_nayar_qualitative;
    material.diffuse_shininess = 1e6;
    EXPECT_EQ(diffuse_response(material, 0.5, light).x, 0.0);
    EXPECT_NEAR(diffuse_response(material, 0.5, light).y, 0.5, 1e-4);
}

TEST(PreintegratedAbsorption, IsTheIntegralOfTheAbsorption) {
    // int_0^1 2 x A(x, NE) dx by midpoints: clamped inside, and exponential (section 7).
    for (const double a : {1e-4, 0.05, 0.3, 1.7, 2.5, 30.0}) {
        for (const double ne : {0.1, 0.6, 1.0}) {
            double clamped = 0.0;
            double exponential = 0.0;
            constexpr int steps = 20000;
            for (int i = 0; i < steps; ++i) {
                const double x = (i + 0.5) / steps;
                clamped += 2.0 * x / steps * std::max(0.0, 1.0 - a * (1.0 / x + 1.0 / ne));
                exponential += 2.0 * x / steps * std::exp(-a * (1.0 / x + 1.0 / ne));
            }
            const glm::dvec3 all(a);
            EXPECT_NEAR(preintegrated_absorption(AmbientAbsorption::clamped, all, ne).diffuse.x, clamped, 1e-7);
            EXPECT_NEAR(preintegrated_absorption(AmbientAbsorption::exponential, all, ne).diffuse.x / exponential, 1.0,
                        1e-6)
                << a;
        }
    }
    EXPECT_EQ(exponential_integral_3(0.0), 0.5);
    EXPECT_NEAR(exponential_integral_3(2.0) / exponential_integral_3(std::nextafter(2.0, 1.0)), 1.0, 1e-13);
    EXPECT_EQ(exponential_integral_3(1e5), 0.0);
}

} // namespace
} // namespace clshade::reference
