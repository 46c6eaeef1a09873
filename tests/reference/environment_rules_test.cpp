// Frames with an environment: rules 10 and 12 of host/gbuffer/frame.h, AOVs, counts, descriptions, tolerances.
#include "host/gbuffer/random_gbuffer.h"
#include "host/reference/compare.h"
#include "host/reference/environment_light.h"
#include "tests/reference/environment_pictures.h"
#include "tests/reference/tiny_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace clshade::reference {
namespace {

constexpr double pi = std::numbers::pi;

/// The tiny frame (Lambert 0.5, one light: radiance 1/pi) under a constant environment of (1, 2, 4).
class TinyFrameWithEnvironment : public TinyFrame {
  public:
    TinyFrameWithEnvironment() { frame.environment = environment_of(constant_picture({1.0, 2.0, 4.0}, 8)); }
    BoundEnvironment& environment() { return *frame.environment; }
};

TEST(EnvironmentRules, ShareIsAddedToLightsAndEmission) {
    TinyFrameWithEnvironment tiny;
    tiny.frame.environment->intensity = {1.0, 1.0, 0.5};
    tiny.frame.has_emission = true;
    tiny.frame.emission.constant = glm::dvec3(0.25);
    const AovSelection aovs{.diffuse = true, .specular = true, .lights = true, .environment = true};
    const Pixel pixel = tiny.shade(aovs);
    const glm::dvec3 share{0.5, 1.0, 1.0};
    expect_near(pixel.environment, share, 1e-12);
    expect_near(pixel.diffuse, share + 1.0 / pi, 1e-12);
    expect_near(pixel.lights.at(0), glm::dvec3(1.0 / pi), 1e-12);
    expect_near(pixel.radiance, share + 1.0 / pi + 0.25, 1e-12);
    EXPECT_EQ(pixel.specular, glm::dvec3(0.0));
    EXPECT_EQ(pixel.alpha, 1.0);
}

TEST(EnvironmentRules, PlanesAreInTheOrderOfTheirNames) {
    TinyFrameWithEnvironment tiny;
    const AovSelection aovs{.diffuse = false, .specular = true, .lights = true, .environment = true};
    const std::vector<std::string> names = output_plane_names(tiny.frame, aovs);
    const Image image = shade(tiny.frame, aovs, 1);
    ASSERT_EQ(image.planes.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == "environment.G") {
            EXPECT_NEAR(image.planes[i][0], 1.0, 1e-12);
        }
        if (names[i] == "light.sun.G") {
            EXPECT_NEAR(image.planes[i][0], 1.0 / pi, 1e-12);
        }
    }
    EXPECT_THAT(names, testing::Contains("environment.G"));
    tiny.frame.environment.reset();
    EXPECT_EQ(shade(tiny.frame, aovs, 1).planes.size(), output_plane_names(tiny.frame, aovs).size());
}

TEST(EnvironmentRules, MaterialsSayHowTheyTakeIt) {
    TinyFrameWithEnvironment tiny;
    tiny.material().diffuse = DiffuseModel::oren_nayar;
    tiny.material().diffuse_shininess.constant = glm::dvec3(0.0);
    tiny.material().ambient = AmbientDiffuse::coarsest;
    tiny.frame.lights.clear();
    EXPECT_NEAR(tiny.red(), 0.5 * (1.0 - 0.3358 - 0.1977), 1e-12);
    BoundLayer coat;
    coat.specular = SpecularModel::blinn_phong;
    coat.f0.constant = glm::dvec3(0.04);
    coat.absorption.constant = glm::dvec3(0.1);
    tiny.material().diffuse = DiffuseModel::lambert;
    tiny.material().layers.insert(tiny.material().layers.begin(), coat);
    tiny.material().absorption = AbsorptionModel::approximated;
    const auto diffuse = [&](AmbientAbsorption absorption, AmbientTransmittance transmittance) {
        tiny.material().absorption_ibl = absorption;
        tiny.material().transmittance_ibl = transmittance;
        return tiny.shade().diffuse.x;
    };
    const double deck = diffuse(AmbientAbsorption::deck, AmbientTransmittance::none);
    EXPECT_NEAR(deck, 0.5 * 0.7, 1e-12); // section 7's table: a' = 0.1, NE = 1
    EXPECT_NEAR(diffuse(AmbientAbsorption::clamped, AmbientTransmittance::none) / deck, 0.711111 / 0.7, 1e-6);
    EXPECT_NEAR(diffuse(AmbientAbsorption::exponential, AmbientTransmittance::none) / deck, 0.753352 / 0.7, 1e-6);
    const double gaussian = 0.96 * (1.0 - 0.000168158579); // 1 - F at N.E = 1
    EXPECT_NEAR(diffuse(AmbientAbsorption::deck, AmbientTransmittance::fresnel) / deck, gaussian, 1e-9);
}

TEST(EnvironmentRules, BackgroundStandsBehindEverything) {
    TinyFrameWithEnvironment tiny;
    tiny.look_through_a_lens(true); // the ray is (0.5, 0, -1)
    tiny.frame.environment = environment_of(random_picture(16, 4));
    tiny.environment().intensity = {1.0, 2.0, 3.0};
    tiny.environment().world_to_image = world_to_image(UpAxis::y, 0.7);
    const glm::dvec3 d = tiny.environment().world_to_image * glm::dvec3(0.5, 0.0, -1.0);
    const glm::dvec3 behind = radiance_along(*tiny.environment().image, d) * tiny.environment().intensity;
    const PlaneIndex coverage = tiny.plane(0.25F);
    tiny.frame.roles.coverage = coverage;

    const Pixel front = tiny.shade();
    EXPECT_EQ(front.alpha, 0.25);
    tiny.environment().background = true;
    const AovSelection aovs{.diffuse = true, .specular = true, .lights = true, .environment = true};
    const Pixel both = tiny.shade(aovs);
    expect_near(both.radiance, front.radiance + 0.75 * behind, 1e-13);
    EXPECT_EQ(both.alpha, 1.0);
    EXPECT_EQ(both.material, 0);
    EXPECT_EQ(both.diffuse + both.specular, front.diffuse + front.specular); // AOVs have no background
    tiny.set(coverage, 0.0F);
    const Pixel empty = tiny.shade(aovs);
    expect_near(empty.radiance, behind, 1e-13);
    EXPECT_EQ(empty.alpha, 1.0);
    EXPECT_EQ(empty.material, -1);
    EXPECT_EQ(empty.environment, glm::dvec3(0.0));
    EXPECT_NEAR(tiny.described("ray.Z"), -1.0 / std::sqrt(1.25), 1e-14);
    tiny.environment().background = false;
    EXPECT_EQ(tiny.shade().radiance, glm::dvec3(0.0));
    EXPECT_EQ(tiny.shade().alpha, 0.0);
}

TEST(EnvironmentRules, BackgroundFollowsOpenExrsAndBlendersMapping) {
    // A picture of its own texels' directions: looking along d shows M d.
    const auto image = picture_of(256, [](const glm::dvec3& d) { return d + 1.0; });
    BoundEnvironment z_up = environment_of(image);
    z_up.world_to_image = world_to_image(UpAxis::z, 0.0);
    const PreparedEnvironment blender(z_up);
    BoundEnvironment y_up = environment_of(image);
    y_up.world_to_image = world_to_image(UpAxis::y, 0.0);
    const PreparedEnvironment open_exr(y_up);
    const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, 0.5, -0.4));
    // Both show the texel at (u, v): u = 0.5 - atan2(y, x)/2 pi, v = acos(z)/pi, or atan2(x, z) and acos(y).
    const auto direction_at_uv = [](double u, double v) { return direction_of(pi * v, 2.0 * pi * (0.5 - u)); };
    const glm::dvec3 blenders = direction_at_uv(0.5 - std::atan2(d.y, d.x) / (2.0 * pi), std::acos(d.z) / pi);
    const glm::dvec3 open_exrs = direction_at_uv(0.5 - std::atan2(d.x, d.z) / (2.0 * pi), std::acos(d.y) / pi);
    expect_near(blender.background(d), blenders + 1.0, 1e-4); // bilinear in 256 rows: (pi/256)^2/8
    expect_near(open_exr.background(d), open_exrs + 1.0, 1e-4);
}

TEST(EnvironmentRules, UnusablePixelsStayBlack) {
    TinyFrameWithEnvironment tiny;
    tiny.look_through_a_lens(true);
    tiny.environment().background = true;
    tiny.environment().intensity = glm::dvec3(2e38); // times 0.5 * 4 does not fit in a float
    Pixel pixel = tiny.shade();
    EXPECT_TRUE(pixel.nonfinite);
    EXPECT_EQ(pixel.radiance, glm::dvec3(0.0));
    EXPECT_EQ(pixel.environment, glm::dvec3(0.0));
    tiny.environment().intensity = glm::dvec3(1.0);
    tiny.set(tiny.frame.roles.normal[1], std::numeric_limits<float>::quiet_NaN());
    pixel = tiny.shade();
    EXPECT_TRUE(pixel.nonfinite);
    EXPECT_EQ(pixel.radiance, glm::dvec3(0.0));
    EXPECT_EQ(pixel.alpha, 0.0);
}

TEST(EnvironmentRules, PixelsAreDescribed) {
    TinyFrameWithEnvironment tiny;
    tiny.material().base().specular = SpecularModel::blinn_phong;
    tiny.material().base().f0.constant = glm::dvec3(0.5);
    tiny.material().base().shininess.constant = glm::dvec3(128.0);
    EXPECT_EQ(tiny.described("environment.NE"), 1.0);
    EXPECT_EQ(tiny.described_vector("environment.R"), glm::dvec3(0.0, 0.0, 1.0));
    EXPECT_EQ(tiny.described("layer1.mip"), 6.0);
    EXPECT_NEAR(tiny.described("layer1.L.B"), 4.0, 1e-12);
    EXPECT_NEAR(tiny.described("environment.E/pi.G"), 2.0, 1e-12);
}

TEST(EnvironmentRules, ASurfaceSeenFromBehindIsLitAsAtGrazing) {
    TinyFrameWithEnvironment tiny;
    tiny.frame.lights.clear();
    tiny.material().base().specular = SpecularModel::blinn_phong_exact;
    tiny.material().base().f0.constant = glm::dvec3(1.0);
    tiny.material().base().shininess.constant = glm::dvec3(30.0);
    const AmbientBrdf grazing = ambient_brdf_of_table(30.0, 1e-4, Normaliser::exact);
    for (const double z : {1e-5, 0.0, -0.3}) {
        tiny.frame.view.view_axis = glm::normalize(glm::dvec3(1.0, 0.0, -z));
        EXPECT_NEAR(tiny.shade().specular.y, 2.0 * (grazing.scale + grazing.bias), 1e-12) << z;
    }
}

/// A random frame under a random environment with a sun, and what the reference says of it.
class EnvironmentTolerance : public testing::Test {
  protected:
    EnvironmentTolerance() : frame_(random_frame(64, 64, SpecularModel::blinn_phong, DiffuseModel::oren_nayar, 5)) {
        auto image = std::make_shared<LatLong>(*random_picture(32, 2));
        image->rgb[3 * (std::size_t{9} * 64 + 20)] = 3e3F;
        frame_.environment = environment_of(image);
        frame_.environment->world_to_image = rotation_about({1.0, 0.2, 0.1}, 1.0);
        image_ = shade(frame_, {}, 2);
        scale_ = rounding_scale(frame_, 2);
    }
    /// The reference's own picture in floats, each value times a factor.
    [[nodiscard]] bool accepts(const Image& image, double factor) const {
        PlaneSlab device(64, 64, 4);
        for (int p = 0; p < 4; ++p) {
            for (int y = 0; y < 64; ++y) {
                for (int x = 0; x < 64; ++x) {
                    const double value = image.planes[static_cast<std::size_t>(p)]
                                                     [static_cast<std::size_t>(y) * 64 + static_cast<std::size_t>(x)];
                    device.at(p, x, y) = static_cast<float>(value * factor);
                }
            }
        }
        const Tolerance tolerance = default_tolerance(frame_.materials.front(), true);
        return passes(compare(device, image_, scale_, tolerance), tolerance);
    }

    Frame frame_;
    Image image_;
    RoundingScale scale_;
};

TEST_F(EnvironmentTolerance, IsOneInTenThousand) {
    EXPECT_TRUE(accepts(image_, 1.0));
    EXPECT_TRUE(accepts(image_, 1.0 + 9e-5));
    EXPECT_FALSE(accepts(image_, 1.0 + 3e-4)); // more than one in a thousand; the hard limit is four times it
    EXPECT_FALSE(accepts(image_, 1.001));
}

TEST_F(EnvironmentTolerance, RefusesAnEnvironmentTurnedByAThousandth) {
    frame_.environment->world_to_image *= rotation_about({0.0, 1.0, 1.0}, 1e-3);
    EXPECT_FALSE(accepts(shade(frame_, {}, 2), 1.0));
}

TEST_F(EnvironmentTolerance, RefusesOtherAmbientModels) {
    frame_.materials.front().ambient = AmbientDiffuse::fit; // within 4e-4 of D
    EXPECT_FALSE(accepts(shade(frame_, {}, 2), 1.0));
    frame_.materials.front().ambient = AmbientDiffuse::precise;
    EXPECT_TRUE(accepts(shade(frame_, {}, 2), 1.0));
    frame_.environment->diffuse = AmbientSource::sh3;
    EXPECT_FALSE(accepts(shade(frame_, {}, 2), 1.0));
}

TEST_F(EnvironmentTolerance, RoundingsOfTheVectorsAreAllowedFor) {
    // Every normal off by its own rounding: what the kernels see is no better.
    for (const PlaneIndex plane : frame_.roles.normal) {
        for (float& value : frame_.planes.plane(plane)) {
            value = std::nextafter(value, 2.0F);
        }
    }
    const Image image = shade(frame_, {}, 2);
    std::size_t beyond = 0;
    std::size_t moved = 0;
    for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t i = 0; i < image.planes[p].size(); ++i) {
            const double change = std::abs(image.planes[p][i] - image_.planes[p][i]);
            moved += change > 1e-8 * image_.planes[p][i] ? 1U : 0U;
            beyond += change > 3.0 * scale_.shift[p][i] + 1e-12 ? 1U : 0U;
        }
    }
    EXPECT_GT(moved, 3000U);
    EXPECT_LT(beyond, 12U); // one in a thousand
}

TEST(EnvironmentRounding, LightLevelCountsTheEnvironment) {
    TinyFrameWithEnvironment tiny;
    EXPECT_NEAR(rounding_scale(tiny.frame, 1).irradiance[0], 2.0 + 4.0 * pi, 1e-9);
    tiny.look_through_a_lens(true);
    tiny.environment().background = true;
    tiny.frame.environment->image = random_picture(16, 1);
    tiny.set(tiny.frame.roles.normal[2], 0.0F); // no surface
    const RoundingScale scale = rounding_scale(tiny.frame, 1);
    EXPECT_NEAR(scale.irradiance[0], pi * 0.5, 0.1); // mean of a random picture
    EXPECT_GT(scale.shift[0][0], 0x1p-24 * 0.1);
    EXPECT_LT(scale.shift[0][0], 0x1p-24 * 100.0);
    tiny.environment().background = false;
    EXPECT_EQ(rounding_scale(tiny.frame, 1).irradiance[0], 0.0);
    EXPECT_EQ(background_tolerance(false).rel, 0.0);
    EXPECT_GT(background_tolerance(true).rel, 0.0);
}

} // namespace
} // namespace clshade::reference
