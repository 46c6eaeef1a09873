// Rules 1, 6, 7 and 9 of host/gbuffer/frame.h as far as stacks of layers came with them.
#include "host/scene/metal_table.h"
#include "tests/reference/directions.h"
#include "tests/reference/stacks.h"
#include "tests/reference/tiny_frame.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace clshade::reference {
namespace {

constexpr double pi = std::numbers::pi;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

BoundLayer bound_layer(SpecularModel model, double f0 = 0.04, double shininess = 20.0) {
    BoundLayer layer;
    layer.specular = model;
    layer.f0.constant = glm::dvec3(f0);
    layer.shininess.constant = glm::dvec3(shininess);
    layer.shininess_u.constant = glm::dvec3(shininess);
    layer.shininess_v.constant = glm::dvec3(4.0 * shininess);
    layer.tangent.constant = {1.0, 0.0, 0.0};
    return layer;
}

/// Straight-on TinyFrame with the given layers over white-ish Lambert.
TinyFrame frame_with(std::vector<BoundLayer> layers) {
    TinyFrame t;
    t.material().layers = std::move(layers);
    return t;
}

// Rule 1 ---------------------------------------------------------------------------------------------------------

TEST(Rule1OfStacks, NonFiniteInAnyPlaneOfAnyLayerOrClaim) {
    TinyFrame t =
        frame_with({bound_layer(SpecularModel::blinn_phong_anisotropic),
                    bound_layer(SpecularModel::blinn_phong_spectral), bound_layer(SpecularModel::blinn_phong)});
    BoundMaterial& m = t.material();
    m.absorption = AbsorptionModel::approximated;
    m.layers[1].metal = built_in_metal("gold").value();
    std::vector<PlaneIndex> named;
    const auto name = [&](const BoundParameter& parameter) {
        named.insert(named.end(), parameter.planes.begin(), parameter.planes.end());
        return parameter;
    };
    m.layers[0].f0 = name(t.colour({0.1F, 0.2F, 0.3F}));
    m.layers[0].shininess_u = name(t.grey(8.0F));
    m.layers[0].shininess_v = name(t.grey(9.0F));
    m.layers[0].tangent = name(t.colour({1.0F, 1.0F, 0.0F}));
    m.layers[0].absorption = name(t.colour({0.1F, 0.2F, 0.0F}));
    m.layers[1].shininess = name(t.grey(9.0F));
    m.layers[1].absorption = name(t.grey(0.1F));
    m.layers[2].f0 = name(t.grey(0.2F));
    m.layers[2].shininess = name(t.grey(7.0F));
    BoundMaterial other; // claims another name
    other.cryptomatte = {{"wood", t.plane(0.5F), 0x12345678U}};
    named.push_back(other.cryptomatte[0].plane);
    other.layers = {bound_layer(SpecularModel::blinn_phong)};
    other.layers[0].shininess = name(t.grey(3.0F));
    t.frame.materials.push_back(other);
    ASSERT_FALSE(t.shade().nonfinite);
    for (const PlaneIndex plane : named) {
        const float before = t.frame.planes.at(plane, 0, 0);
        for (const float bad : {nan, std::numeric_limits<float>::infinity()}) {
            t.set(plane, bad);
            EXPECT_TRUE(t.shade().nonfinite) << "plane " << plane;
            EXPECT_EQ(t.shade().radiance, glm::dvec3(0.0));
        }
        t.set(plane, before);
    }
}

// Rule 6 ---------------------------------------------------------------------------------------------------------

TEST(Rule6OfStacks, EveryLayerHasItsOwnParameters) {
    TinyFrame t = frame_with({bound_layer(SpecularModel::blinn_phong, 0.1, 10.0),
                              bound_layer(SpecularModel::blinn_phong_anisotropic, 0.2, 30.0),
                              bound_layer(SpecularModel::blinn_phong_exact, 0.3, 50.0)});
    t.frame.roles.coverage = t.plane(0.5F);
    t.material().absorption = AbsorptionModel::original;
    t.material().layers[0].absorption = t.colour({0.0F, 0.25F, 0.5F}); // twice as much after division
    t.material().layers[1].shininess_v = t.grey(16.0F);
    EXPECT_EQ(t.described("layer1.f0.G"), 0.1);
    EXPECT_EQ(t.described("layer1.shininess"), 10.0);
    EXPECT_EQ(t.described("layer1.absorption.G"), 0.5);
    EXPECT_EQ(t.described("layer1.absorption.B"), 1.0);
    EXPECT_EQ(t.described("layer2.shininess_u"), 30.0);
    EXPECT_EQ(t.described("layer2.shininess_v"), 32.0);
    EXPECT_EQ(t.described("layer2.T.X"), 1.0);
    EXPECT_EQ(t.described("layer3.f0.R"), 0.3);
    EXPECT_EQ(t.described("layer3.shininess"), 50.0);
}

TEST(Rule6OfStacks, AbsorptionIsNotNegativeAndNotBoundedAbove) {
    TinyFrame t = frame_with({bound_layer(SpecularModel::blinn_phong), bound_layer(SpecularModel::blinn_phong)});
    t.material().absorption = AbsorptionModel::approximated;
    t.material().layers[0].absorption = t.grey(7.0F);
    EXPECT_FALSE(t.shade().clamped);
    EXPECT_EQ(t.shade().diffuse, glm::dvec3(0.0));
    const PlaneIndex plane = t.material().layers[0].absorption.planes[0];
    t.set(plane, -0.0009F); // rounding
    EXPECT_FALSE(t.shade().clamped);
    EXPECT_EQ(t.described("layer1.absorption.R"), 0.0);
    t.set(plane, -0.0011F);
    EXPECT_TRUE(t.shade().clamped);
    EXPECT_EQ(t.described("layer1.absorption.R"), 0.0);
    t.material().absorption = AbsorptionModel::none; // which does not read it
    EXPECT_FALSE(t.shade().clamped);
}

TEST(Rule6OfStacks, F0OfAnyLayerIsClampedAndCounted) {
    TinyFrame t = frame_with({bound_layer(SpecularModel::blinn_phong), bound_layer(SpecularModel::blinn_phong)});
    t.material().layers[0].f0 = t.grey(1.5F);
    EXPECT_TRUE(t.shade().clamped);
    EXPECT_EQ(t.described("layer1.f0.R"), 1.0);
    t.material().layers[0].specular = SpecularModel::none; // reads no f0
    EXPECT_FALSE(t.shade().clamped);
}

TEST(Rule6OfStacks, IndexOfRefractionBecomesF0) {
    TinyFrame t = frame_with({bound_layer(SpecularModel::blinn_phong)});
    BoundParameter& f0 = t.material().base().f0;
    f0 = t.grey(0.5F);
    f0.convert = Conversion::index_of_refraction;
    f0.scale = 2.0;
    f0.offset = 0.5; // 1.5
    EXPECT_NEAR(t.described("layer1.f0.R"), 0.04, 1e-16);
    f0.offset = -3.0; // below 1: 1
    EXPECT_EQ(t.described("layer1.f0.R"), 0.0);
    f0.offset = 1e30;
    EXPECT_NEAR(t.described("layer1.f0.R"), 1.0, 1e-15);
    EXPECT_FALSE(t.shade().clamped);
}

TinyFrame anisotropic_frame() {
    TinyFrame t = frame_with({bound_layer(SpecularModel::blinn_phong_anisotropic, 0.5, 10.0)});
    t.frame.lights[0].direction = {-0.5, -0.2, -1.0};
    return t;
}

glm::dvec3 tangent_of(const TinyFrame& t) {
    return t.described_vector("layer1.T");
}

TEST(Rule6OfStacks, TangentsAreMadePerpendicular) {
    TinyFrame t = anisotropic_frame();
    t.material().base().tangent.constant = {3.0, 4.0, 12.0};
    expect_near(tangent_of(t), {0.6, 0.8, 0.0});
    EXPECT_FALSE(t.shade().no_tangent);
    t.material().base().tangent = t.colour({-3.0F, 0.0F, 4.0F});
    expect_near(tangent_of(t), {-1.0, 0.0, 0.0});
}

TEST(Rule6OfStacks, TangentsTurnTheHighlight) {
    TinyFrame t = anisotropic_frame();
    const double along_x = t.shade().specular.x;
    t.material().base().tangent.constant = {0.0, 1.0, 0.0};
    const double along_y = t.shade().specular.x;
    EXPECT_GT(along_x, 1.5 * along_y); // L leans towards x, where the exponent is the smaller one
    // as the closed formula says
    const Angles a = angles_between({0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, glm::normalize(glm::dvec3(0.5, 0.2, 1.0)));
    const TangentFrame frame = tangent_frame({0.0, 1.0, 0.0}, {0.0, 0.0, 1.0});
    EXPECT_NEAR(along_y, 2.0 * blinn_phong_anisotropic(a, frame, glm::dvec3(0.5), 10.0, 40.0).x, 1e-14);
}

TEST(Rule6OfStacks, TangentPlanesAreDecodedLikeTheNormal) {
    TinyFrame t = anisotropic_frame();
    t.frame.normal_encoding = NormalEncoding::unorm;
    t.frame.roles.coverage = t.plane(0.5F);
    t.frame.roles.normal = t.planes({0.25F, 0.25F, 0.5F});       // (0, 0, 1) under the coverage
    t.material().base().tangent = t.colour({0.1F, 0.4F, 0.25F}); // (-0.6, 0.6, 0)
    expect_near(tangent_of(t), glm::dvec3(-1.0, 1.0, 0.0) / std::sqrt(2.0), 1e-6);
    t.material().base().tangent = BoundParameter{};
    t.material().base().tangent.constant = {0.0, 1.0, 0.0}; // constants are not encoded
    expect_near(tangent_of(t), {0.0, 1.0, 0.0});
}

TEST(Rule6OfStacks, TangentPlanesAreTurnedFromCameraSpaceAndConstantsAreNot) {
    TinyFrame t = anisotropic_frame();
    t.frame.normal_space = NormalSpace::camera;
    // camera x -> world y, y -> z, z -> x
    t.frame.view.camera_to_world = glm::dmat3({0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0});
    t.frame.roles.normal = t.planes({0.0F, 1.0F, 0.0F}); // world z
    t.material().base().tangent = t.colour({2.0F, 0.0F, 0.0F});
    expect_near(tangent_of(t), {0.0, 1.0, 0.0});
    t.material().base().tangent = BoundParameter{};
    t.material().base().tangent.constant = {2.0, 0.0, 0.0};
    expect_near(tangent_of(t), {1.0, 0.0, 0.0});
}

TEST(Rule6OfStacks, MissingAndParallelTangentsAreReplacedAndCounted) {
    TinyFrame t = anisotropic_frame();
    const auto with_tangent = [&](const glm::vec3& v) {
        t.material().base().tangent = t.colour(v);
        const Pixel pixel = t.shade();
        EXPECT_GT(pixel.specular.x, 0.0);
        EXPECT_EQ(shade(t.frame, {}, 1).counts.no_tangent, pixel.no_tangent ? 1U : 0U);
        return pixel.no_tangent;
    };
    EXPECT_TRUE(with_tangent({0.0F, 0.0F, 0.0F}));
    expect_near(tangent_of(t), {1.0, 0.0, 0.0}); // Duff's axis on +Z
    EXPECT_TRUE(with_tangent({0.0F, 0.0F, -3.0F}));
    EXPECT_TRUE(with_tangent({0.9e-4F, 0.0F, 1.0F}));
    EXPECT_FALSE(with_tangent({1.1e-4F, 0.0F, 1.0F}));
    EXPECT_FALSE(with_tangent({0.0F, 2e-6F, 0.0F}));
    expect_near(tangent_of(t), {0.0, 1.0, 0.0});
    // Two such layers are still one pixel; a material that is not anisotropic needs no tangent.
    t.material().base().tangent = BoundParameter{};
    t.material().layers.push_back(t.material().layers.front());
    EXPECT_EQ(shade(t.frame, {}, 1).counts.no_tangent, 1U);
    t.material().layers = {bound_layer(SpecularModel::blinn_phong)};
    t.material().base().tangent = BoundParameter{};
    EXPECT_EQ(shade(t.frame, {}, 1).counts.no_tangent, 0U);
}

// Rule 7 ---------------------------------------------------------------------------------------------------------

TEST(Rule7OfStacks, CryptomatteNamesAreComparedByBits) {
    TinyFrame t;
    constexpr std::uint32_t bits = 0x3f123456U;
    const PlaneIndex plane = t.plane(std::bit_cast<float>(bits));
    BoundMaterial other = t.material();
    other.albedo.constant = glm::dvec3(1.0);
    other.cryptomatte = {{"cushion", plane, 0x11111111U}, {"wood", plane, bits}};
    t.frame.materials.push_back(other);
    EXPECT_EQ(t.shade().material, 1);
    EXPECT_NEAR(t.red(), 2.0 / pi, 1e-15);
    t.set(plane, std::bit_cast<float>(bits + 1U)); // one bit off
    EXPECT_EQ(t.shade().material, 0);
    t.set(plane, std::bit_cast<float>(0x11111111U));
    EXPECT_EQ(t.shade().material, 1);
    // Zeros of two signs are equal as numbers and differ in bits.
    t.frame.materials[1].cryptomatte = {{"minus", plane, 0x80000000U}};
    t.set(plane, 0.0F);
    EXPECT_EQ(t.shade().material, 0);
    t.set(plane, -0.0F);
    EXPECT_EQ(t.shade().material, 1);
}

TEST(Rule7OfStacks, TheFirstMaterialThatClaimsAPixelTakesIt) {
    TinyFrame t;
    t.frame.roles.material_id = t.plane(7.25F); // a fraction, too
    constexpr std::uint32_t bits = 0x3f123456U;
    const PlaneIndex plane = t.plane(std::bit_cast<float>(bits));
    BoundMaterial by_name = t.material();
    by_name.cryptomatte = {{"wood", plane, bits}};
    BoundMaterial by_id = t.material();
    by_id.ids = {7};
    t.frame.materials.push_back(by_name);
    t.frame.materials.push_back(by_id);
    EXPECT_EQ(t.shade().material, 1);
    EXPECT_TRUE(t.shade().fractional_id);
    std::swap(t.frame.materials[1], t.frame.materials[2]);
    EXPECT_EQ(t.shade().material, 1);
    t.set(t.frame.roles.material_id, 8.0F);
    EXPECT_EQ(t.shade().material, 2);
    t.set(plane, 0.0F);
    EXPECT_EQ(t.shade().material, 0);
    // A material may be claimed either way.
    t.frame.materials[1].cryptomatte = {{"none", plane, 0U}};
    EXPECT_EQ(t.shade().material, 1);
}

// Rule 9 ---------------------------------------------------------------------------------------------------------

TEST(Rule9OfStacks, FramesShadeTheStackTheyName) {
    TinyFrame t = frame_with({bound_layer(SpecularModel::blinn_phong_anisotropic, 0.04, 60.0),
                              bound_layer(SpecularModel::blinn_phong_spectral, 0.0, 30.0),
                              bound_layer(SpecularModel::blinn_phong_exact, 0.1, 10.0)});
    t.material().fresnel = FresnelModel::exact;
    t.material().absorption = AbsorptionModel::original;
    t.material().layers[0].absorption.constant = {0.1, 0.2, 0.3};
    t.material().layers[1].metal = built_in_metal("copper").value();
    const glm::dvec3 light = direction_at(radians(50.0), 0.4);
    const glm::dvec3 eye = direction_at(radians(30.0), 2.9);
    t.frame.lights[0].direction = -light;
    t.frame.view.view_axis = -eye;

    const SpectralMetal copper(built_in_metal("copper").value());
    LayerValues top = layer_of(SpecularModel::blinn_phong_anisotropic, glm::dvec3(0.04), 60.0);
    top.shininess_v = 240.0;
    top.absorption = {0.1, 0.2, 0.3};
    const MaterialValues stack =
        stack_of({top, layer_of_metal(copper, 30.0), layer_of(SpecularModel::blinn_phong_exact, glm::dvec3(0.1), 10.0)},
                 FresnelModel::exact, AbsorptionModel::original, DiffuseModel::lambert, glm::dvec3(0.5));
    const Reflected expected = reflect(stack, angles_between({0.0, 0.0, 1.0}, eye, light));
    const Pixel pixel = t.shade();
    expect_near(pixel.diffuse, 2.0 * expected.diffuse, 1e-15);
    expect_near(pixel.specular, 2.0 * expected.specular, 1e-14);
    EXPECT_GT(expected.specular.x, 0.0);
    EXPECT_GT(expected.diffuse.x, 0.0);
}

} // namespace
} // namespace clshade::reference
