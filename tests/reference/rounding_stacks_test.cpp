// Rounding shifts and default tolerances of stacks: what is ill-conditioned is known to be.
#include "host/reference/fresnel.h"
#include "host/reference/reference.h"
#include "host/reference/rounding.h"
#include "host/reference/tolerance.h"
#include "tests/reference/tiny_frame.h"

#include <cmath>

namespace clshade::reference {
namespace {

constexpr double u = 0x1p-24;

BoundLayer lobe_layer(SpecularModel model, double f0, double shininess) {
    BoundLayer layer;
    layer.specular = model;
    layer.f0.constant = glm::dvec3(f0);
    layer.shininess.constant = glm::dvec3(shininess);
    return layer;
}

/// Radiance's relative shift in the red channel.
double relative_shift(const TinyFrame& t) {
    return rounding_scale(t.frame, 1).shift[0][0] / t.red();
}

TEST(RoundingScaleOfStacks, SeesTheContrastOfNeighbouringMedia) {
    // A sharp coat whose highlight is elsewhere, over a broad lobe of nearly its index: what is seen is
    // r = ((n1 - n0)/(n1 + n0))^2, and n0, n1 each move by u (n + (n^2 - 1)/2).
    const auto shift_of_contrast = [](double contrast) {
        TinyFrame t;
        t.material().diffuse = DiffuseModel::none;
        t.material().layers = {lobe_layer(SpecularModel::blinn_phong_exact, 0.04, 65536.0),
                               lobe_layer(SpecularModel::blinn_phong_exact, f0_between(1.0, 1.5 + contrast), 4.0)};
        t.frame.lights[0].direction = {0.3, 0.0, -1.0};
        return relative_shift(t);
    };
    const double nudge = u * (1.5 + 0.5 * 1.25);
    EXPECT_NEAR(shift_of_contrast(1e-4) / (2.0 * 2.0 * nudge / 1e-4), 1.0, 0.02);
    EXPECT_NEAR(shift_of_contrast(1e-3) / (2.0 * 2.0 * nudge / 1e-3), 1.0, 0.02);
    EXPECT_LT(shift_of_contrast(0.5), 50.0 * u);
}

TEST(RoundingScaleOfStacks, TurnsTheTangentWithTheNormalAndByItself) {
    // The azimuth of T is off by (1 + cos a)/sin a roundings where t stands at an angle a from N: N turns it by
    // cos a/sin a, t itself by 1/sin a.
    const auto shift_of_angle = [](double angle) {
        TinyFrame t;
        t.material().diffuse = DiffuseModel::none;
        BoundLayer layer = lobe_layer(SpecularModel::blinn_phong_anisotropic, 0.5, 0.0);
        layer.shininess_u.constant = glm::dvec3(10.0);
        layer.shininess_v.constant = glm::dvec3(1000.0);
        layer.tangent.constant = {std::sin(angle), 0.0, std::cos(angle)};
        t.material().layers = {layer};
        t.frame.lights[0].direction = {-0.1, -0.1, -1.0}; // H between T and B
        return relative_shift(t);
    };
    // The lobe: d(log)/d(phi) = (n_v - n_u)/2 sin^2(t) sin(2 phi) = 990/2 * 0.005, H being at about 0.0706 rad.
    const double slope = 990.0 / 2.0 * 0.00498;
    for (const double angle : {1e-2, 1e-3}) {
        EXPECT_NEAR(shift_of_angle(angle) / (slope * 2.0 / angle * u), 1.0, 0.3) << angle;
    }
    EXPECT_LT(shift_of_angle(1.5), 500.0 * u);
    EXPECT_TRUE(std::isfinite(shift_of_angle(0.0))); // parallel: T is Duff's
    EXPECT_LT(shift_of_angle(0.0), 500.0 * u);
}

TEST(RoundingScaleOfStacks, SeesAbsorptionThatCancels) {
    // 1 - a' (1/NL + 1/NE) with NL = NE = 1 and a' near 1/2: turns of the vectors are of second order, a' is not.
    TinyFrame t;
    t.material().absorption = AbsorptionModel::approximated;
    BoundLayer tint;
    tint.absorption.constant = glm::dvec3(0.4999);
    t.material().layers = {tint, BoundLayer{}};
    EXPECT_NEAR(relative_shift(t) / (u / 2e-4), 1.0, 0.05);
}

TEST(ToleranceOfAMaterial, FollowsTheMaterial) {
    BoundMaterial m;
    EXPECT_EQ(default_tolerance(m).rel, 2e-6);
    m.diffuse = DiffuseModel::oren_nayar;
    EXPECT_EQ(default_tolerance(m).rel, 2e-6);
    for (const SpecularModel model : {SpecularModel::blinn_phong, SpecularModel::blinn_phong_exact}) {
        m.layers = {lobe_layer(model, 0.04, 20.0)};
        m.fresnel = FresnelModel::constant;
        EXPECT_EQ(default_tolerance(m).rel, 1e-5);
        m.fresnel = FresnelModel::exact;
        EXPECT_EQ(default_tolerance(m).rel, 2e-5);
    }
    m.fresnel = FresnelModel::constant;
    for (const SpecularModel model : {SpecularModel::blinn_phong_anisotropic, SpecularModel::blinn_phong_spectral}) {
        m.layers = {lobe_layer(model, 0.04, 20.0)};
        EXPECT_EQ(default_tolerance(m).rel, 2e-5);
    }
    m.layers = {lobe_layer(SpecularModel::blinn_phong, 0.04, 20.0), lobe_layer(SpecularModel::none, 0.04, 20.0)};
    EXPECT_EQ(default_tolerance(m).rel, 2e-5);
}

} // namespace
} // namespace clshade::reference
