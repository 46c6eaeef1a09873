// Rules 8 to 10 of host/gbuffer/frame.h: lights, combination, output; and whole frames.
#include "host/gbuffer/random_gbuffer.h"
#include "host/reference/blinn_phong.h"
#include "host/reference/diffuse.h"
#include "tests/reference/directions.h"
#include "tests/reference/tiny_frame.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace clshade::reference {
namespace {

constexpr double pi = std::numbers::pi;

// Rule 8 ---------------------------------------------------------------------------------------------------------

TEST(Rule8, DistantLightOfAnyLength) {
    TinyFrame t;
    t.frame.lights[0].direction = {0.0, -3.0, -4.0};
    EXPECT_NEAR(t.red(), 0.8 / pi, 1e-15);
    t.frame.lights[0].direction = {0.0, 0.0, 1.0}; // from below
    EXPECT_EQ(t.red(), 0.0);
    EXPECT_EQ(t.shade().alpha, 1.0);
    t.frame.lights[0].direction = {1.0, 0.0, 0.0}; // N.L = 0 exactly
    EXPECT_EQ(t.red(), 0.0);
}

TEST(Rule8, PointLightFallsWithTheSquareOfTheDistance) {
    TinyFrame t;
    t.frame.roles.position = t.planes({1.0F, 2.0F, 3.0F});
    t.frame.lights.clear();
    t.add_bulb({1.0, 2.0, 7.0}, 48.0);
    EXPECT_NEAR(t.red(), 0.5 / pi * 48.0 / 16.0, 1e-15);
    t.frame.lights[0].position = {1.0, 5.0, 7.0}; // 3-4-5
    EXPECT_NEAR(t.red(), 0.5 / pi * 48.0 / 25.0 * 0.8, 1e-15);
    EXPECT_NEAR(t.described("bulb.NL"), 0.8, 1e-15);
    EXPECT_NEAR(t.described("bulb.E0.G"), 48.0 / 25.0, 1e-15);
}

TEST(Rule8, PointLightsNeedAPosition) {
    TinyFrame t;
    t.frame.lights.clear();
    t.add_bulb({0.0, 0.0, 5.0}, 100.0);
    EXPECT_EQ(t.red(), 0.0); // neither position nor depth
    t.frame.roles.position = t.planes({0.0F, 0.0F, 5.0F});
    EXPECT_EQ(t.red(), 0.0); // at the light itself
    t.set(t.frame.roles.position[2], 0.0F);
    EXPECT_NEAR(t.red(), 0.5 / pi * 4.0, 1e-15);
}

TEST(Rule8, PointLightsArePracticallyAbsentAtSentinelDepths) {
    TinyFrame t;
    t.look_through_a_lens(true);
    t.frame.roles.coverage = t.plane(1.0F);
    t.frame.roles.position = t.planes({3.0F, 2.0F, 4.0F});
    t.frame.roles.depth = t.plane(4.0F);
    t.frame.lights.clear();
    t.add_bulb({3.0, 2.0, 9.0}, 100.0);
    EXPECT_NEAR(t.red(), 0.5 / pi * 4.0, 1e-15);
    t.set(t.frame.roles.depth, 1e10F);
    EXPECT_GT(t.red(), 0.0);
    EXPECT_LT(t.red(), 1e-15);
    t.set(t.frame.roles.depth, std::numeric_limits<float>::infinity());
    EXPECT_EQ(t.red(), 0.0);
    EXPECT_FALSE(t.shade().nonfinite);
}

/// A lamp 2 above the surface at a horizontal distance, pointing down with a cone of 0.5 rad.
double spot_share_at(double angle, double softness) {
    TinyFrame t;
    t.frame.roles.position = t.planes({static_cast<float>(2.0 * std::tan(angle)), 0.0F, 0.0F});
    Light& lamp = t.frame.lights[0];
    lamp.type = LightType::spot;
    lamp.position = {0.0, 0.0, 2.0};
    lamp.direction = {0.0, 0.0, -0.3};
    lamp.power = glm::dvec3(1.0);
    lamp.cone_angle = 0.5;
    lamp.cone_softness = softness;
    Light bulb = lamp;
    bulb.type = LightType::point;
    const double with_cone = t.red();
    lamp = bulb;
    return with_cone / t.red();
}

TEST(Rule8, SpotLightWithAHardEdge) {
    EXPECT_EQ(spot_share_at(0.0, 0.0), 1.0);
    EXPECT_EQ(spot_share_at(0.4999, 0.0), 1.0);
    EXPECT_EQ(spot_share_at(0.5001, 0.0), 0.0);
}

TEST(Rule8, SpotLightFadesByASmoothstepOfTheAngle) {
    // from 0.5 (1 - 0.4) = 0.3 to 0.5
    EXPECT_EQ(spot_share_at(0.0, 0.4), 1.0);
    EXPECT_EQ(spot_share_at(0.2999, 0.4), 1.0);
    EXPECT_NEAR(spot_share_at(0.4, 0.4), 0.5, 1e-6); // the position is rounded to float
    EXPECT_NEAR(spot_share_at(0.45, 0.4), 0.25 * 0.25 * 2.5, 1e-6);
    EXPECT_EQ(spot_share_at(0.5001, 0.4), 0.0);
    EXPECT_NEAR(spot_share_at(0.25, 1.0), 0.5, 1e-6); // softness 1: from the axis on
}

TEST(Rule8, EyeBehindTheSurfaceCountsAsGrazing) {
    TinyFrame t;
    t.material().base().specular = SpecularModel::blinn_phong_exact;
    t.material().base().f0.constant = glm::dvec3(0.5);
    t.material().base().shininess.constant = glm::dvec3(4.0);
    t.frame.view.view_axis = glm::normalize(glm::dvec3(-1.0, 0.0, 0.5)); // E = (2, 0, -1) / sqrt(5)
    EXPECT_EQ(t.described("sun.NE"), 1e-4);
    // E.L, H and N.H are of the real E: E.L = -0.447, N.H = (N.L + N.E) / |L + E| with the unclamped N.E
    const double ne = -1.0 / std::sqrt(5.0);
    const double nh = (1.0 + ne) / std::sqrt(2.0 + 2.0 * ne);
    EXPECT_NEAR(t.described("sun.NH"), nh, 1e-15);
    EXPECT_NEAR(t.described("sun.EH"), std::sqrt(0.5 * (1.0 + ne)), 1e-15);
    EXPECT_GT(t.shade().specular.x, 0.0);
}

TEST(Rule8, OppositeEyeAndLightHaveNoHalfVector) {
    TinyFrame t;
    t.material().base().specular = SpecularModel::blinn_phong;
    t.material().base().f0.constant = glm::dvec3(0.5);
    t.material().base().shininess.constant = glm::dvec3(0.0);
    t.frame.view.view_axis = {0.0, 0.0, 1.0};      // E = -L
    EXPECT_DOUBLE_EQ(t.described("sun.NH"), 1e-6); // the guards: 1e-12 / 1e-6
    EXPECT_EQ(t.described("sun.EH"), 0.0);
    // NH^0 = 1 and F(0) = 1
    EXPECT_NEAR(t.shade().specular.x, 2.0 * normaliser_linear(0.0), 1e-15);
    t.material().base().shininess.constant = glm::dvec3(1.0);
    EXPECT_LT(t.shade().specular.x, 2.0 * normaliser_linear(1.0) * 1.001e-6);
}

TEST(Rule8, ShortSumsOfEyeAndLightGiveAShorterHalfVector) {
    // |L + E| = 3e-7 < m = 1e-6; L + E along N, so that N.H = |L + E| / m and E.H = |L + E|^2 / (2 m).
    const double h = 1.5e-7;
    const double side = std::sqrt(1.0 - h * h);
    const Angles a = angles_between({0.0, 0.0, 1.0}, {-side, 0.0, h}, {side, 0.0, h});
    EXPECT_NEAR(a.nh, 0.3, 1e-12);
    EXPECT_NEAR(a.eh, 9e-14 / 2e-6, 1e-12);
    EXPECT_NEAR(lobe(a, 10.0), std::pow(0.3, 10.0), 1e-12);
    // and N.H = 0.8 > 0.5, where the sine would tell another story
    const double h2 = 4e-7;
    const double side2 = std::sqrt(1.0 - h2 * h2);
    const Angles b = angles_between({0.0, 0.0, 1.0}, {-side2, 0.0, h2}, {side2, 0.0, h2});
    EXPECT_NEAR(lobe(b, 10.0), std::pow(0.8, 10.0), 1e-12);
}

// Rule 9 ---------------------------------------------------------------------------------------------------------

TEST(Rule9, DiffuseIsWeightedAsTheSpecularModelSays) {
    TinyFrame t;
    t.frame.lights[0].direction = -direction_at(radians(60.0), 0.4);
    t.material().base().f0.constant = {0.04, 0.3, 1.0};
    const glm::dvec3 bare = t.shade().diffuse;
    expect_near(bare, glm::dvec3(0.5 / pi));
    t.material().base().specular = SpecularModel::blinn_phong;
    expect_near(t.shade().diffuse, bare * glm::dvec3(0.96, 0.7, 0.0));
    t.material().base().specular = SpecularModel::blinn_phong_exact;
    const double kept = 1.0 - 1.0 / 32.0; // 1 - (1 - N.L)^5
    expect_near(t.shade().diffuse, bare * kept * glm::dvec3(0.96, 0.7, 0.0));
}

TEST(Rule9, EachModelIsCalled) {
    TinyFrame t;
    const glm::dvec3 eye = direction_at(radians(40.0), 2.5);
    const glm::dvec3 light = direction_at(radians(60.0), 0.4);
    const Angles a = angles_between({0.0, 0.0, 1.0}, eye, light);
    const glm::dvec3 rho(0.2, 0.5, 0.9);
    const glm::dvec3 f0(0.04, 0.3, 1.0);
    t.frame.view.view_axis = -eye;
    t.frame.lights[0].direction = -light;
    t.frame.lights[0].power = {1.0, 2.0, 3.0};
    t.material().albedo.constant = rho;
    t.material().base().f0.constant = f0;
    t.material().base().shininess.constant = glm::dvec3(20.0);
    t.material().diffuse_shininess.constant = glm::dvec3(5.0); // sigma^2 = 0.4
    const auto diffuse_of = [&](DiffuseModel model) {
        t.material().diffuse = model;
        return t.shade().diffuse / t.frame.lights[0].power;
    };
    const OrenNayarParts full = oren_nayar_full(a, rho, 0.4);
    expect_near(diffuse_of(DiffuseModel::none), glm::dvec3(0.0));
    expect_near(diffuse_of(DiffuseModel::lambert), lambert(a, rho));
    expect_near(diffuse_of(DiffuseModel::oren_nayar), oren_nayar_improved(a, rho, 5.0));
    expect_near(diffuse_of(DiffuseModel::oren_nayar_full), full.l1 + full.l2);
    expect_near(diffuse_of(DiffuseModel::oren_nayar_qualitative), oren_nayar_qualitative(a, rho, 0.4));
    expect_near(diffuse_of(DiffuseModel::oren_nayar_simplified_1), oren_nayar_simplified_1(a, rho, 0.4));
    expect_near(diffuse_of(DiffuseModel::oren_nayar_simplified_2), oren_nayar_simplified_2(a, rho, 0.4));
    expect_near(diffuse_of(DiffuseModel::oren_nayar_shininess), oren_nayar_shininess(a, rho, 5.0));
    const auto specular_of = [&](SpecularModel model) {
        t.material().base().specular = model;
        return t.shade().specular / t.frame.lights[0].power;
    };
    expect_near(specular_of(SpecularModel::none), glm::dvec3(0.0));
    expect_near(specular_of(SpecularModel::blinn_phong), blinn_phong(a, f0, 20.0));
    expect_near(specular_of(SpecularModel::blinn_phong_exact), blinn_phong_exact(a, f0, 20.0));
}

// Rule 10 --------------------------------------------------------------------------------------------------------

TEST(Rule10, EmissionIsCoveredAndInNoAov) {
    TinyFrame t;
    t.frame.roles.coverage = t.plane(0.5F);
    t.frame.has_emission = true;
    t.frame.emission.constant = {1.0, 2.0, 3.0};
    const Pixel pixel = t.shade({.diffuse = true, .specular = true, .lights = true});
    expect_near(pixel.radiance, 0.5 * (glm::dvec3(1.0 / pi) + glm::dvec3(1.0, 2.0, 3.0)));
    expect_near(pixel.diffuse, glm::dvec3(0.5 / pi));
    expect_near(pixel.lights.at(0), glm::dvec3(0.5 / pi));
}

TEST(Rule10, WhatDoesNotFitInAFloatIsZeroAndCounted) {
    TinyFrame t;
    t.frame.lights[0].power = {1.0, 1e40, 1.0};
    const Pixel pixel = t.shade();
    EXPECT_TRUE(pixel.nonfinite);
    EXPECT_EQ(pixel.radiance, glm::dvec3(0.0));
    EXPECT_EQ(pixel.alpha, 0.0);
    EXPECT_EQ(pixel.material, -1);
    t.frame.lights[0].power = {1.0, 1e38, 1.0};
    EXPECT_FALSE(t.shade().nonfinite);
}

TEST(Frames, AovsAddUpToTheRadiance) {
    const Frame frame = random_frame(61, 37, SpecularModel::blinn_phong, DiffuseModel::oren_nayar, 5);
    const Image image = shade(frame, {.diffuse = true, .specular = true, .lights = true}, 2);
    ASSERT_EQ(image.planes.size(), 4 + 3 + 3 + 3 * frame.lights.size());
    for (std::size_t i = 0; i < image.planes[0].size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double total = image.planes[c][i];
            double lights = 0.0;
            for (std::size_t l = 0; l < frame.lights.size(); ++l) {
                lights += image.planes[10 + 3 * l + c][i];
            }
            ASSERT_NEAR(image.planes[4 + c][i] + image.planes[7 + c][i], total, 1e-14 * total);
            ASSERT_NEAR(lights, total, 1e-14 * total);
        }
    }
}

TEST(Frames, DoNotDependOnThreads) {
    const Frame frame = random_frame(64, 48, SpecularModel::blinn_phong_exact, DiffuseModel::oren_nayar_full, 6);
    const Image one = shade(frame, {}, 1);
    for (const int threads : {2, 5}) {
        const Image many = shade(frame, {}, threads);
        EXPECT_EQ(one.planes, many.planes);
        EXPECT_EQ(one.material, many.material);
    }
    for (const int y : {0, 47}) {
        for (const int x : {0, 31, 63}) {
            const Pixel pixel = shade_pixel(frame, x, y, {});
            const auto at = static_cast<std::size_t>(y) * 64 + static_cast<std::size_t>(x);
            EXPECT_EQ(one.planes[1][at], pixel.radiance.y);
            EXPECT_EQ(one.planes[3][at], pixel.alpha);
            EXPECT_EQ(one.material[at], pixel.material);
        }
    }
}

TEST(Frames, CountWhatTheRulesCount) {
    Frame frame = random_frame(32, 32, SpecularModel::blinn_phong, DiffuseModel::lambert, 8);
    const PixelCounts before = shade(frame, {}, 2).counts;
    EXPECT_EQ(before.nonfinite, 0U);
    EXPECT_EQ(before.clamped, 0U);
    EXPECT_EQ(before.fractional_ids, 0U);
    // Three whole rows of surface, then damage.
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int x = 0; x < 32; ++x) {
        for (int y = 0; y < 3; ++y) {
            frame.planes.at(frame.roles.normal[2], x, y) = 1.0F;
            frame.planes.at(frame.roles.coverage, x, y) = 1.0F;
        }
        frame.planes.at(frame.materials[0].base().f0.planes[1], x, 0) = nan;
        frame.planes.at(frame.materials[0].albedo.planes[2], x, 1) = 1.5F;
        frame.planes.at(frame.materials[0].albedo.planes[0], x, 1) = -1.5F; // still one pixel
    }
    const PixelCounts counts = shade(frame, {}, 2).counts;
    EXPECT_EQ(counts.nonfinite, 32U);
    EXPECT_EQ(counts.clamped, 32U);
}

} // namespace
} // namespace clshade::reference
