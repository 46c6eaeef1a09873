// Rules 1 to 7 of host/gbuffer/frame.h: what a pixel says.
#include "tests/reference/tiny_frame.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace clshade::reference {
namespace {

constexpr double pi = std::numbers::pi;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

void expect_nothing(const Pixel& pixel) {
    EXPECT_EQ(pixel.radiance, glm::dvec3(0.0));
    EXPECT_EQ(pixel.diffuse, glm::dvec3(0.0));
    EXPECT_EQ(pixel.specular, glm::dvec3(0.0));
    EXPECT_EQ(pixel.alpha, 0.0);
    EXPECT_EQ(pixel.material, -1);
}

TEST(TinyFrame, IsLambert) {
    const Pixel pixel = TinyFrame().shade();
    expect_near(pixel.radiance, glm::dvec3(1.0 / pi));
    EXPECT_EQ(pixel.alpha, 1.0);
    EXPECT_EQ(pixel.material, 0);
    EXPECT_FALSE(pixel.nonfinite || pixel.clamped || pixel.fractional_id);
}

// Rule 1 ---------------------------------------------------------------------------------------------------------

/// A frame that names every kind of plane, all finite.
TinyFrame frame_with_every_plane() {
    TinyFrame t;
    t.look_through_a_lens(true);
    t.frame.roles.position = t.planes({0.0F, 0.0F, 1.0F});
    t.frame.roles.depth = t.plane(7.0F);
    t.frame.roles.coverage = t.plane(0.5F);
    t.frame.roles.material_id = t.plane(0.0F);
    t.material().base().specular = SpecularModel::blinn_phong;
    t.material().diffuse = DiffuseModel::oren_nayar;
    t.material().base().f0 = t.colour({0.02F, 0.02F, 0.02F});
    t.material().base().shininess = t.grey(16.0F);
    t.material().albedo = t.colour({0.2F, 0.2F, 0.2F});
    t.material().diffuse_shininess = t.grey(16.0F);
    BoundMaterial other; // claims id 5, not this pixel
    other.ids = {5};
    other.albedo = t.grey(0.1F);
    t.frame.materials.push_back(other);
    t.frame.emission = t.colour({0.0F, 0.0F, 0.0F});
    t.frame.has_emission = true;
    return t;
}

TEST(Rule1, NonFiniteInAnyNamedPlaneGivesNothing) {
    TinyFrame t = frame_with_every_plane();
    ASSERT_GT(t.red(), 0.0);
    const int named = t.frame.emission.planes[2] + 1; // planes are handed out in order, emission last
    ASSERT_EQ(named, 21);
    for (PlaneIndex p = 0; p < named; ++p) {
        const float before = t.frame.planes.at(p, 0, 0);
        for (const float bad : {nan, inf, -inf}) {
            if (p == t.frame.roles.depth && bad == inf) {
                continue; // a background sentinel
            }
            t.set(p, bad);
            const Pixel pixel = t.shade({.lights = true});
            EXPECT_TRUE(pixel.nonfinite) << "plane " << p << " = " << bad;
            expect_nothing(pixel);
            EXPECT_EQ(pixel.lights.at(0), glm::dvec3(0.0));
            EXPECT_EQ(t.described("nonfinite"), 1.0);
        }
        t.set(p, before);
    }
    t.plane(nan); // a plane that nothing names
    EXPECT_FALSE(t.shade().nonfinite);
}

TEST(Rule1, EmissionPlanesCountOnlyWhereEmissionIsUsed) {
    TinyFrame t = frame_with_every_plane();
    t.set(t.frame.emission.planes[0], nan);
    t.frame.has_emission = false;
    EXPECT_FALSE(t.shade().nonfinite);
}

TEST(Rule1, InfiniteDepthIsBackground) {
    TinyFrame t;
    t.frame.roles.depth = t.plane(inf);
    expect_nothing(t.shade());
    EXPECT_FALSE(t.shade().nonfinite);
    EXPECT_EQ(t.described("surface"), 0.0);
}

// Rule 2 ---------------------------------------------------------------------------------------------------------

TEST(Rule2, CoverageIsClampedAndMultiplied) {
    TinyFrame t;
    t.frame.roles.coverage = t.plane(0.25F);
    EXPECT_NEAR(t.red(), 0.25 / pi, 1e-15);
    EXPECT_EQ(t.shade().alpha, 0.25);
    t.set(t.frame.roles.coverage, 1.5F);
    EXPECT_NEAR(t.red(), 1.0 / pi, 1e-15);
    EXPECT_EQ(t.shade().alpha, 1.0);
    t.set(t.frame.roles.coverage, -0.5F);
    expect_nothing(t.shade());
    t.set(t.frame.roles.coverage, 0.0F);
    expect_nothing(t.shade());
}

// Rule 3 ---------------------------------------------------------------------------------------------------------

TEST(Rule3, TooShortANormalIsNoSurface) {
    TinyFrame t;
    t.set(t.frame.roles.normal[2], 0.99e-6F);
    expect_nothing(t.shade());
    t.set(t.frame.roles.normal[2], 1.01e-6F);
    EXPECT_NEAR(t.red(), 1.0 / pi, 1e-15);
    t.set(t.frame.roles.normal[2], 37.0F); // any length will do
    EXPECT_NEAR(t.red(), 1.0 / pi, 1e-15);
}

TEST(Rule3, UnormNormalsAreDecodedUnderTheCoverage) {
    TinyFrame t;
    t.frame.normal_encoding = NormalEncoding::unorm;
    t.frame.roles.coverage = t.plane(0.5F);
    // (0.6, 0, 0.8) as 0..1: (0.8, 0.5, 0.9), times the coverage
    t.set(t.frame.roles.normal[0], 0.4F);
    t.set(t.frame.roles.normal[1], 0.25F);
    t.set(t.frame.roles.normal[2], 0.45F);
    expect_near(t.described_vector("N"), {0.6, 0.0, 0.8}, 1e-7);
    EXPECT_NEAR(t.red(), 0.5 * 0.8 / pi, 1e-7);
    // all 0.5: a zero normal
    for (const PlaneIndex p : t.frame.roles.normal) {
        t.set(p, 0.25F);
    }
    expect_nothing(t.shade());
}

TEST(Rule3, FarDepthIsBackgroundUnlessThereIsCoverage) {
    TinyFrame t;
    t.frame.roles.depth = t.plane(6e4F);
    expect_nothing(t.shade());
    t.set(t.frame.roles.depth, 59999.0F);
    EXPECT_NEAR(t.red(), 1.0 / pi, 1e-15);
    for (const float sentinel : {6e4F, 65504.0F, 1e10F, inf}) {
        t.set(t.frame.roles.depth, sentinel);
        t.frame.roles.coverage = no_plane;
        expect_nothing(t.shade());
        t.frame.roles.coverage = t.plane(1.0F);
        EXPECT_NEAR(t.red(), 1.0 / pi, 1e-15) << sentinel;
    }
}

// Rule 4 ---------------------------------------------------------------------------------------------------------

TEST(Rule4, CameraNormalsAreTurned) {
    TinyFrame t;
    t.frame.normal_space = NormalSpace::camera;
    // camera x -> world y, y -> z, z -> x
    t.frame.view.camera_to_world = glm::dmat3({0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0});
    t.set(t.frame.roles.normal[0], 0.0F);
    t.set(t.frame.roles.normal[1], 2.0F);
    t.set(t.frame.roles.normal[2], 0.0F);
    expect_near(t.described_vector("N"), {0.0, 0.0, 1.0});
    t.frame.normal_space = NormalSpace::world;
    expect_near(t.described_vector("N"), {0.0, 1.0, 0.0});
}

// Rule 5 ---------------------------------------------------------------------------------------------------------

const glm::dvec3 toward_ray = glm::normalize(glm::dvec3(-0.5, 0.0, 1.0)); // against TinyFrame's ray

TEST(Rule5, EyeVectorComesFromThePosition) {
    TinyFrame t;
    t.look_through_a_lens(true);
    t.frame.roles.position = t.planes({1.0F, 2.0F, 3.0F});
    expect_near(t.described_vector("E"), {0.0, 0.0, 1.0});
    t.frame.view.has_rays = false;
    expect_near(t.described_vector("E"), {0.0, 0.0, 1.0});
}

TEST(Rule5, EyeVectorComesFromTheRayWhereThePositionIsNotValid) {
    TinyFrame t;
    t.look_through_a_lens(true);
    expect_near(t.described_vector("E"), toward_ray); // no position plane
    t.frame.roles.position = t.planes({0.0F, 0.0F, 0.0F});
    expect_near(t.described_vector("E"), toward_ray); // the origin means "nothing here" ...
    t.frame.roles.depth = t.plane(5.0F);
    expect_near(t.described_vector("E"), glm::normalize(glm::dvec3(1.0, 2.0, 8.0))); // ... unless depth vouches for it
    t.frame.roles.coverage = t.plane(0.5F);
    t.set(t.frame.roles.position[0], 3.0F);
    t.set(t.frame.roles.depth, 1e10F); // averaged into the sentinel at an edge
    expect_near(t.described_vector("E"), toward_ray);
}

TEST(Rule5, WithoutRaysTheOriginIsAPosition) {
    TinyFrame t;
    t.look_through_a_lens(false);
    t.frame.roles.position = t.planes({0.0F, 0.0F, 0.0F});
    expect_near(t.described_vector("E"), glm::normalize(glm::dvec3(1.0, 2.0, 8.0)));
}

TEST(Rule5, AnEyeAloneLooksAgainstTheAxis) {
    TinyFrame t;
    t.look_through_a_lens(false);
    t.frame.view.view_axis = glm::normalize(glm::dvec3(1.0, 0.0, -1.0));
    expect_near(t.described_vector("E"), glm::normalize(glm::dvec3(-1.0, 0.0, 1.0)));
}

TEST(Rule5, OrthographicEyeIsTheAxisEverywhere) {
    TinyFrame t;
    t.look_through_a_lens(true);
    t.frame.view.orthographic = true;
    t.frame.view.view_axis = glm::normalize(glm::dvec3(0.0, 1.0, -1.0));
    t.frame.roles.position = t.planes({4.0F, 5.0F, 6.0F});
    expect_near(t.described_vector("E"), glm::normalize(glm::dvec3(0.0, -1.0, 1.0)));
}

TEST(Rule5, PositionFromDepth) {
    TinyFrame t;
    t.look_through_a_lens(true);
    t.frame.roles.depth = t.plane(4.0F);
    expect_near(t.described_vector("position"), {3.0, 2.0, 4.0}); // (1, 2, 8) + 4 (0.5, 0, -1)
    expect_near(t.described_vector("E"), toward_ray);
    t.frame.depth_kind = DepthKind::ray;
    expect_near(t.described_vector("position"), glm::dvec3(1.0, 2.0, 8.0) - 4.0 * toward_ray);
    t.frame.roles.position = t.planes({7.0F, 7.0F, 1.0F}); // where there is a position, it counts
    expect_near(t.described_vector("position"), {7.0, 7.0, 1.0});
}

TEST(Rule5, OrthographicPositionFromDepth) {
    TinyFrame t;
    t.frame.view.has_rays = true;
    t.frame.view.origin = {-1.0, 3.0, 10.0};
    t.frame.view.origin_dx = {2.0, 0.0, 0.0};
    t.frame.view.origin_dy = {0.0, -2.0, 0.0};
    t.frame.view.direction = {0.0, 0.0, -1.0};
    t.frame.roles.depth = t.plane(4.0F);
    expect_near(t.described_vector("position"), {0.0, 2.0, 6.0});
}

// Rule 6 ---------------------------------------------------------------------------------------------------------

TEST(Rule6, AveragedPlanesAreDividedByCoverage) {
    TinyFrame t;
    t.frame.roles.coverage = t.plane(0.5F);
    t.material().albedo = t.colour({0.125F, 0.25F, 0.375F});
    expect_near(t.shade().radiance, 0.5 * 2.0 / pi * glm::dvec3(0.25, 0.5, 0.75));
    t.material().albedo.averaged = false;
    expect_near(t.shade().radiance, 0.5 * 2.0 / pi * glm::dvec3(0.125, 0.25, 0.375));
}

TEST(Rule6, ScaleAndOffsetComeBeforeTheConversion) {
    TinyFrame t;
    t.material().base().specular = SpecularModel::blinn_phong;
    t.frame.roles.coverage = t.plane(0.5F);
    t.material().base().shininess = t.grey(0.25F); // 0.5 after division
    t.material().base().shininess.scale = 0.5;
    t.material().base().shininess.offset = 0.25; // 0.5 again
    t.material().base().shininess.convert = Conversion::ggx_roughness;
    EXPECT_DOUBLE_EQ(t.described("layer1.shininess"), 30.0); // 2 / 0.5^4 - 2
    t.material().base().shininess.convert = Conversion::smoothness;
    EXPECT_DOUBLE_EQ(t.described("layer1.shininess"), 30.0);
    t.material().base().shininess.convert = Conversion::oren_nayar_sigma;
    EXPECT_DOUBLE_EQ(t.described("layer1.shininess"), 8.0); // 2 / 0.5^2
    t.material().base().shininess.convert = Conversion::none;
    EXPECT_DOUBLE_EQ(t.described("layer1.shininess"), 0.5);
}

TEST(Rule6, ShininessStaysInItsRange) {
    TinyFrame t;
    t.material().base().specular = SpecularModel::blinn_phong;
    t.material().base().shininess = t.grey(0.0F);
    const auto shininess = [&](float plane, Conversion convert) {
        t.set(t.material().base().shininess.planes[0], plane);
        t.material().base().shininess.convert = convert;
        EXPECT_FALSE(t.shade().clamped);
        EXPECT_TRUE(std::isfinite(t.red()));
        return t.described("layer1.shininess");
    };
    EXPECT_EQ(shininess(0.0F, Conversion::ggx_roughness), 65536.0);
    EXPECT_EQ(shininess(0.01F, Conversion::ggx_roughness), 65536.0);
    EXPECT_EQ(shininess(1.0F, Conversion::ggx_roughness), 0.0);
    EXPECT_EQ(shininess(2.0F, Conversion::ggx_roughness), 0.0);
    EXPECT_EQ(shininess(1.0F, Conversion::smoothness), 65536.0);
    EXPECT_EQ(shininess(0.0F, Conversion::smoothness), 0.0);
    EXPECT_EQ(shininess(0.0F, Conversion::oren_nayar_sigma), 65536.0);
    EXPECT_EQ(shininess(-5.0F, Conversion::none), 0.0);
    EXPECT_EQ(shininess(1e6F, Conversion::none), 65536.0);
}

TEST(Rule6, ReflectancesAreClampedAndCounted) {
    TinyFrame t;
    t.material().base().specular = SpecularModel::blinn_phong;
    t.material().albedo = t.colour({0.5F, 0.5F, 0.5F});
    t.material().base().f0 = t.colour({0.5F, 0.5F, 0.5F});
    const auto clamped = [&](const BoundParameter& parameter, float value) {
        t.set(parameter.planes[1], value);
        const bool counted = t.shade().clamped;
        const double seen = t.described(&parameter == &t.material().base().f0 ? "layer1.f0.G" : "albedo.G");
        EXPECT_EQ(seen, std::min(std::max(static_cast<double>(value), 0.0), 1.0));
        t.set(parameter.planes[1], 0.5F);
        return counted;
    };
    for (const BoundParameter* parameter : {&t.material().base().f0, &t.material().albedo}) {
        EXPECT_FALSE(clamped(*parameter, 1.0F));
        EXPECT_FALSE(clamped(*parameter, 0.0F));
        EXPECT_FALSE(clamped(*parameter, 1.0009F)); // rounding
        EXPECT_FALSE(clamped(*parameter, -0.0009F));
        EXPECT_TRUE(clamped(*parameter, 1.0011F));
        EXPECT_TRUE(clamped(*parameter, -0.0011F));
    }
    EXPECT_FALSE(t.shade().clamped);
}

TEST(Rule6, ParametersThatNoModelUsesAreNotClamped) {
    TinyFrame t;
    t.material().base().f0 = t.grey(7.0F); // specular = none
    EXPECT_FALSE(t.shade().clamped);
}

TEST(Rule6, EmissionIsNotNegative) {
    TinyFrame t;
    t.frame.has_emission = true;
    t.frame.emission = t.colour({-3.0F, 0.25F, 1000.0F});
    expect_near(t.shade().radiance, glm::dvec3(1.0 / pi) + glm::dvec3(0.0, 0.25, 1000.0), 1e-12);
    EXPECT_FALSE(t.shade().clamped);
}

// Rule 7 ---------------------------------------------------------------------------------------------------------

TEST(Rule7, MaterialIsFoundByTheNearestWholeId) {
    TinyFrame t;
    t.frame.roles.material_id = t.plane(0.0F);
    BoundMaterial other = t.material();
    other.ids = {3, 7, -2, 16777216};
    other.albedo.constant = glm::dvec3(1.0);
    t.frame.materials.push_back(other);
    const auto material_of = [&](float id) {
        t.set(t.frame.roles.material_id, id);
        const Pixel pixel = t.shade();
        EXPECT_NEAR(pixel.radiance.x, (pixel.material == 1 ? 2.0 : 1.0) / pi, 1e-15);
        EXPECT_EQ(t.described("material"), pixel.material);
        return std::pair{pixel.material, pixel.fractional_id};
    };
    EXPECT_EQ(material_of(3.0F), std::pair(1, false));
    EXPECT_EQ(material_of(7.0F), std::pair(1, false));
    EXPECT_EQ(material_of(-2.0F), std::pair(1, false));
    EXPECT_EQ(material_of(16777216.0F), std::pair(1, false));
    EXPECT_EQ(material_of(0.0F), std::pair(0, false));
    EXPECT_EQ(material_of(5.0F), std::pair(0, false));
    EXPECT_EQ(material_of(3e38F), std::pair(0, false));
    EXPECT_EQ(material_of(3.009F), std::pair(1, false));
    EXPECT_EQ(material_of(3.011F), std::pair(1, true));
    EXPECT_EQ(material_of(2.6F), std::pair(1, true));
    EXPECT_EQ(material_of(3.4F), std::pair(1, true));
    EXPECT_EQ(material_of(3.6F), std::pair(0, true));
}

TEST(Rule7, FractionalIdsOfTheBackgroundAreNotCounted) {
    TinyFrame t;
    t.frame.roles.material_id = t.plane(0.5F);
    t.frame.roles.coverage = t.plane(0.0F);
    EXPECT_FALSE(t.shade().fractional_id);
}

TEST(Rule7, WithoutIdsTheFirstMaterialTakesAll) {
    TinyFrame t;
    BoundMaterial other = t.material();
    other.ids = {0};
    t.frame.materials.push_back(other);
    EXPECT_EQ(t.shade().material, 0);
}

} // namespace
} // namespace clshade::reference
