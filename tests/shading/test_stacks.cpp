// Stacks of layers: random ones against the reference, the vectors of the formula specification on the device, and what
// must not change a picture.
#include "host/shading/material_code.h"
#include "tests/shading/agreement.h"

#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <vector>

namespace clshade {
namespace {

class RandomStack : public testing::TestWithParam<int> {};

// Any lobes in one to eight layers, any diffuse, Fresnel and absorption model, parameters from planes and constants.
TEST_P(RandomStack, AgreesWithTheReference) {
    const auto seed = static_cast<std::uint64_t>(GetParam());
    StackShape shape = random_shape(seed);
    shape.largest_shininess = 8192.0;
    Frame frame = random_frame(203, 61, shape, seed);
    const std::vector<int> widths = {16, 1, 8, 4};
    const int lanes = widths[static_cast<std::size_t>(GetParam()) % widths.size()];
    EXPECT_LE(tolerance_of(frame).rel, 2e-5);
    expect_agreement(shade(frame, lanes), reference::shade(frame, {}, 2), frame, model_key(frame.materials[0]));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomStack, testing::Range(1, 33));

TEST(Stacks, LightAovsOfAStackAddUp) {
    StackShape shape;
    shape.layers = {SpecularModel::blinn_phong, SpecularModel::blinn_phong_anisotropic, SpecularModel::blinn_phong};
    shape.diffuse = DiffuseModel::oren_nayar_full;
    shape.absorption = AbsorptionModel::original;
    Frame frame = random_frame(203, 61, shape, 5);
    const AovSelection aovs = {.diffuse = true, .specular = true, .lights = true};
    expect_agreement(shade(frame, 16, aovs), reference::shade(frame, aovs, 2), frame, "AOVs of a stack");
}

/// The same bytes, up to one rounding of single precision: the code may add in another order.
void expect_same(const ShadedImage& a, const ShadedImage& b, const std::string& what) {
    for (int channel = 0; channel < 4; ++channel) {
        for (int y = 0; y < a.planes.height(); ++y) {
            for (int x = 0; x < a.planes.width(); ++x) {
                const float expected = a.planes.at(channel, x, y);
                ASSERT_NEAR(b.planes.at(channel, x, y), expected, 1e-6F * (0.1F + std::abs(expected)))
                    << what << " at " << x << "," << y;
            }
        }
    }
}

TEST(Stacks, ALayerOfIndexOneWithoutAbsorptionChangesNothing) {
    for (const FresnelModel fresnel : {FresnelModel::constant, FresnelModel::exact}) {
        StackShape shape;
        shape.layers = {SpecularModel::blinn_phong, SpecularModel::blinn_phong_exact};
        shape.fresnel = fresnel;
        shape.absorption = AbsorptionModel::approximated;
        Frame frame = random_frame(101, 37, shape, 9);
        const ShadedImage without = shade(frame, 16);
        BoundLayer air;
        air.specular = SpecularModel::blinn_phong;
        air.shininess.constant = glm::dvec3(64.0);
        for (const std::ptrdiff_t place : {0, 1}) {
            Frame with = random_frame(101, 37, shape, 9);
            auto& layers = with.materials[0].layers;
            layers.insert(layers.begin() + place, air);
            expect_same(without, shade(with, 16), std::string(name_of(fresnel)) + ", air at " + std::to_string(place));
        }
    }
}

TEST(Stacks, NoAbsorptionIsTheLimitOfEachAbsorption) {
    StackShape shape;
    shape.layers = {SpecularModel::blinn_phong, SpecularModel::blinn_phong};
    Frame frame = random_frame(101, 37, shape, 12);
    const ShadedImage none = shade(frame, 16);
    for (const AbsorptionModel model : {AbsorptionModel::approximated, AbsorptionModel::original}) {
        frame.materials[0].absorption = model;
        frame.materials[0].layers[0].absorption.constant = glm::dvec3(1e-12);
        expect_same(none, shade(frame, 16), std::string(name_of(model)));
    }
}

/// One that reflects red light only: its reflectance in green leaves 0..1 and is clamped to 0.
Metal red_metal() {
    return {"red.txt", {{380.0, 1.0, 0.0}, {600.0, 1.0, 0.0}, {640.0, 0.1, 8.0}, {780.0, 0.1, 8.0}}};
}

TEST(Stacks, AMetalHasNoInterfaceInChannelsItDoesNotReflect) {
    for (const FresnelModel fresnel : {FresnelModel::constant, FresnelModel::exact}) {
        for (const std::size_t place : {0U, 1U}) {
            StackShape shape;
            shape.layers = {SpecularModel::blinn_phong, SpecularModel::blinn_phong, SpecularModel::blinn_phong_exact};
            shape.layers[place] = SpecularModel::blinn_phong_spectral;
            shape.fresnel = fresnel;
            shape.largest_shininess = 2048.0;
            Frame frame = random_frame(101, 37, shape, 21);
            frame.materials[0].layers[place].metal = red_metal();
            const ShadedImage image = shade(frame, 16);
            EXPECT_EQ(materials_source(frame).warnings.size(), 0U);
            expect_agreement(image, reference::shade(frame, {}, 2), frame,
                             std::string(name_of(fresnel)) + ", red metal at " + std::to_string(place));
        }
    }
}

TEST(Stacks, AbsurdTangentsCountAsMissing) {
    StackShape shape;
    shape.layers = {SpecularModel::blinn_phong_anisotropic};
    shape.largest_shininess = 2048.0;
    Frame frame = random_frame(101, 37, shape, 4);
    const std::uint64_t before = shade(frame, 16).counts.no_tangent;
    const auto& tangent = frame.materials[0].base().tangent.planes;
    for (int x = 0; x < 101; ++x) {
        frame.planes.at(tangent[1], x, 7) = 3e30F; // its square is no float
    }
    const ShadedImage image = shade(frame, 16);
    EXPECT_GT(image.counts.no_tangent, before + 50U);
    expect_agreement(image, reference::shade(frame, {}, 2), frame, "tangents of 3e30");
}

// What stands below meets light from inside, however little the layer reflects: its index need not be told from 1.
TEST(Stacks, AnInterfaceIsOneHoweverSmallItsF0) {
    for (const bool mapped : {false, true}) {
        StackShape shape;
        shape.layers = {SpecularModel::blinn_phong, SpecularModel::blinn_phong};
        shape.largest_shininess = 2048.0;
        Frame frame = random_frame(101, 37, shape, 4);
        BoundParameter& f0 = frame.materials[0].layers[0].f0;
        for (int y = 0; y < 37; ++y) {
            for (int x = 0; x < 101; ++x) {
                frame.planes.at(f0.planes[1], x, y) = 1e-36F;
            }
        }
        if (!mapped) {
            f0 = BoundParameter{};
            f0.constant = {0.04, 1e-36, 0.0};
        }
        expect_agreement(shade(frame, 16), reference::shade(frame, {}, 2), frame, mapped ? "mapped" : "constant");
    }
}

struct Vector {
    glm::dvec3 light, eye; // relative to N = +Z
    nlohmann::json inputs;
    double f_cos = 0.0;
};

glm::dvec3 direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

std::vector<Vector> vectors_of(const std::string& model, const char* output) {
    std::vector<Vector> vectors;
    for (const char* name : {"/vectors.json", "/vectors_tables.json"}) {
        std::ifstream file(std::string(CLSHADE_TEST_DATA) + name);
        for (const auto& vector : nlohmann::json::parse(file)) {
            if (vector.at("model") != model) {
                continue;
            }
            const auto& in = vector.at("inputs");
            const auto radians = [&](const char* key) { return glm::radians(in.value(key, 0.0)); };
            const double phi = radians("phi_l_deg");
            vectors.push_back({direction(radians("theta_l_deg"), phi),
                               direction(radians("theta_e_deg"), phi + radians("dphi_deg")), in,
                               vector.at("output").at(output)});
        }
    }
    return vectors;
}

BoundParameter constant(double value) {
    BoundParameter parameter;
    parameter.constant = glm::dvec3(value);
    return parameter;
}

double f0_of_index(double n) {
    return (n - 1.0) * (n - 1.0) / ((n + 1.0) * (n + 1.0));
}

/// One pixel seen along the vector's E, lit along its L with E_0 = 1; tangent +X.
double shade_vector(const Vector& vector, const BoundMaterial& material) {
    Frame frame;
    frame.data_window = frame.display_window = {0, 0, 0, 0};
    frame.view.eye = 4.0 * vector.eye;
    frame.planes = PlaneSlab(1, 1, 6);
    frame.plane_names = {"N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z"};
    frame.roles.normal = {0, 1, 2};
    frame.roles.position = {3, 4, 5};
    frame.planes.at(2, 0, 0) = 1.0F;
    Light light;
    light.name = "key";
    light.direction = -vector.light;
    light.power = glm::dvec3(1.0);
    frame.lights = {light};
    frame.materials = {material};
    return static_cast<double>(shade(frame, 16).planes.at(1, 0, 0));
}

/// Directions are rounded to single precision: a high exponent multiplies that.
void expect_vector(const Vector& vector, const BoundMaterial& material) {
    const double actual = shade_vector(vector, material);
    EXPECT_NEAR(actual, vector.f_cos, 2e-5 * vector.f_cos + 3e-7) << vector.inputs.dump();
}

BoundMaterial dual_layer_of(const nlohmann::json& in) {
    BoundMaterial material;
    material.layers.resize(2);
    material.fresnel = in.at("fresnel") == "exact" ? FresnelModel::exact : FresnelModel::constant;
    const std::string absorption = in.at("absorption");
    material.absorption = absorption == "original" ? AbsorptionModel::original
                          : absorption == "approx" ? AbsorptionModel::approximated
                                                   : AbsorptionModel::none;
    for (BoundLayer& layer : material.layers) {
        layer.specular = SpecularModel::blinn_phong;
    }
    material.layers[0].f0 = constant(f0_of_index(in.at("n1")));
    material.layers[0].shininess = constant(in.at("shi_top"));
    material.layers[0].absorption = constant(in.at("alpha"));
    material.layers[1].f0 = constant(f0_of_index(in.at("n2")));
    material.layers[1].shininess = constant(in.at("shi_bottom"));
    material.albedo = constant(in.at("R_d"));
    material.diffuse = in.at("diffuse") == "lambert" ? DiffuseModel::lambert : DiffuseModel::oren_nayar;
    material.diffuse_shininess = constant(in.value("shi_diffuse", 0.0));
    return material;
}

TEST(DeviceVectors, DualLayer) {
    const auto vectors = vectors_of("dual_layer", "fcos");
    EXPECT_GE(vectors.size(), 21U);
    for (const Vector& vector : vectors) {
        expect_vector(vector, dual_layer_of(vector.inputs));
    }
}

TEST(DeviceVectors, SkinOverOrenNayar) {
    const auto vectors = vectors_of("skin_layered_oren_nayar", "fcos");
    EXPECT_GE(vectors.size(), 5U);
    for (const Vector& vector : vectors) {
        expect_vector(vector, dual_layer_of(vector.inputs));
    }
}

TEST(DeviceVectors, Anisotropic) {
    const auto vectors = vectors_of("aniso", "specular_f_cos");
    EXPECT_GE(vectors.size(), 6U);
    for (const Vector& vector : vectors) {
        BoundMaterial material;
        BoundLayer& layer = material.base();
        layer.specular = SpecularModel::blinn_phong_anisotropic;
        layer.f0 = constant(vector.inputs.at("F0"));
        layer.shininess_u = constant(vector.inputs.at("n_u"));
        layer.shininess_v = constant(vector.inputs.at("n_v"));
        layer.tangent.constant = {1.0, 0.0, 0.0};
        expect_vector(vector, material);
    }
}

} // namespace
} // namespace clshade
