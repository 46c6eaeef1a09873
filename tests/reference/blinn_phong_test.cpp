// Blinn-Phong of sections 1 and 2: normalisers, Fresnel terms, the lobe, reciprocity, positivity.
#include "host/reference/blinn_phong.h"
#include "host/reference/diffuse.h"
#include "host/reference/fresnel.h"
#include "tests/reference/directions.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace clshade::reference {
namespace {

/// Angles for random directions above the surface, given as whole numbers by rapidcheck.
struct RandomDirections {
    glm::dvec3 eye{0.0};
    glm::dvec3 light{0.0};
    Angles angles;
    Angles swapped;
};

RandomDirections random_directions() {
    const auto one = [] {
        // 1e-3 above the horizon, where the clamp of N.E says nothing yet.
        const double cosine = *rc::gen::inRange(1, 1001) / 1000.0;
        const double phi = *rc::gen::inRange(0, 3600) / 3600.0 * 2.0 * std::numbers::pi;
        return direction_at(std::acos(cosine), phi);
    };
    RandomDirections d;
    d.eye = one();
    d.light = one();
    d.angles = unclamped_angles(d.eye, d.light);
    d.swapped = unclamped_angles(d.light, d.eye);
    return d;
}

double random_shininess() {
    return std::exp2(*rc::gen::inRange(-400, 1601) / 100.0); // 2^-4 to 2^16
}

TEST(Normaliser, LinearAgainstExactAsPublished) {
    // models.md section 2, "Error of the linear normaliser": printed to 1e-4 per cent.
    const std::array<std::pair<double, double>, 18> table{{{0, -46.1637},
                                                           {1, -32.0731},
                                                           {2, -22.1653},
                                                           {4, -10.3283},
                                                           {8, -1.7263},
                                                           {10, -0.3968},
                                                           {16, 0.5549},
                                                           {20, 0.5453},
                                                           {32, 0.3438},
                                                           {64, 0.1225},
                                                           {128, 0.0063},
                                                           {256, -0.0531},
                                                           {512, -0.0831},
                                                           {1000, -0.0979},
                                                           {2048, -0.1058},
                                                           {4096, -0.1096},
                                                           {8192, -0.1115},
                                                           {65536, -0.1132}}};
    for (const auto& [n, percent] : table) {
        EXPECT_NEAR(100.0 * (normaliser_linear(n) / normaliser_exact(n) - 1.0), percent, 0.5001e-4) << n;
    }
}

TEST(Normaliser, CrossingsAndExtremes) {
    const auto error = [](double n) { return normaliser_linear(n) / normaliser_exact(n) - 1.0; };
    EXPECT_LT(error(11.1119), 0.0); // crossings at 11.1120 and 135.2747
    EXPECT_GT(error(11.1121), 0.0);
    EXPECT_GT(error(135.2746), 0.0);
    EXPECT_LT(error(135.2748), 0.0);
    EXPECT_NEAR(error(17.462), 0.005682, 0.5e-6); // largest over-estimate
    EXPECT_GT(error(17.462), error(17.40));
    EXPECT_GT(error(17.462), error(17.52));
    EXPECT_NEAR(error(1e9), -0.001134, 0.5e-6);
    for (int i = 0; i < 100000; ++i) {
        const double n = 8.904 + 0.01 * i;
        ASSERT_LT(std::abs(error(n)), 0.01) << n;
    }
    EXPECT_GT(std::abs(error(8.903)), 0.01);
}

TEST(Fresnel, GaussianFormIsOffByAsMuchAsPublished) {
    // models.md section 2: max |error| 0.003766 at c = 0.0554, RMS 0.002238, weight 0.000168158579 at c = 1.
    double largest = 0.0;
    double at = 0.0;
    double sum = 0.0;
    constexpr int steps = 100000;
    for (int i = 0; i <= steps; ++i) {
        const double c = static_cast<double>(i) / steps;
        const double error = std::abs(schlick_gaussian(glm::dvec3(0.0), c).x - schlick(glm::dvec3(0.0), c).x);
        sum += error * error;
        if (error > largest) {
            largest = error;
            at = c;
        }
    }
    EXPECT_NEAR(largest, 0.003766, 0.5e-6);
    EXPECT_NEAR(at, 0.0554, 0.5e-4);
    EXPECT_NEAR(std::sqrt(sum / steps), 0.002238, 0.5e-6);
    EXPECT_NEAR(schlick_gaussian(glm::dvec3(0.0), 1.0).x, 0.000168158579, 0.5e-12);
    EXPECT_EQ(schlick_gaussian(glm::dvec3(0.3), 0.0).x, 1.0);
}

TEST(Fresnel, EndsOfTheRange) {
    EXPECT_EQ(schlick(glm::dvec3(0.0, 0.5, 1.0), 1.0), glm::dvec3(0.0, 0.5, 1.0));
    EXPECT_EQ(schlick(glm::dvec3(0.0, 0.5, 1.0), 0.0), glm::dvec3(1.0));
    EXPECT_EQ(schlick(glm::dvec3(1.0), 0.37), glm::dvec3(1.0));
}

TEST(Lobe, IsGoodToTwelveDigitsEverywhere) {
    // cos(t)^n in extended precision, N.H given by t itself. Below 1e-300 double has no digits left.
    for (const double n : {0.0625, 1.0, 2.0, 32.0, 512.0, 8192.0, 65536.0}) {
        for (const double t : {0.0, 1e-9, 1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0, 1.2, 1.5, 1.57}) {
            Angles a;
            a.nh = std::cos(t);
            a.sin2_nh = std::sin(t) * std::sin(t);
            const long double exact =
                std::exp(static_cast<long double>(n) * std::log(std::cos(static_cast<long double>(t))));
            if (exact > 1e-300L) {
                EXPECT_NEAR(lobe(a, n) / static_cast<double>(exact), 1.0, 1e-12) << "n = " << n << ", t = " << t;
            }
        }
    }
}

TEST(Lobe, FromVectorsIsGoodToTwelveDigits) {
    // E = N, L at angle 2 t: H stands at t exactly, up to the rounding of the vectors themselves.
    for (const double t : {1e-4, 1e-3, 3e-3, 1e-2}) {
        const Angles a = angles_between({0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, direction_at(2.0 * t, 0.7));
        const long double exact = std::exp(65536.0L * std::log(std::cos(static_cast<long double>(t))));
        EXPECT_NEAR(lobe(a, 65536.0) / static_cast<double>(exact), 1.0, 1e-12) << t;
    }
}

TEST(Lobe, ExponentZeroIsOneEverywhere) {
    Angles a;
    for (const double nh : {0.0, 1e-300, 0.5, 1.0}) {
        a.nh = nh;
        EXPECT_EQ(lobe(a, 0.0), 1.0);
    }
    a.nh = 0.0;
    EXPECT_EQ(lobe(a, 1e-3), 0.0);
    EXPECT_EQ(lobe(a, 65536.0), 0.0);
}

TEST(BlinnPhong, MirrorOfAMetalShowsTheNormaliser) {
    const Angles a = vector_angles(35.0, 35.0, 180.0);
    EXPECT_NEAR(blinn_phong_exact(a, glm::dvec3(1.0), 512.0).x, normaliser_exact(512.0), 1e-9);
    EXPECT_NEAR(blinn_phong(a, glm::dvec3(1.0), 512.0).x, normaliser_linear(512.0), 1e-9);
}

RC_GTEST_PROP(BlinnPhong, SpecularIsReciprocalAndPositive, ()) {
    const RandomDirections d = random_directions();
    const double n = random_shininess();
    const glm::dvec3 f0(*rc::gen::inRange(0, 101) / 100.0);
    for (const auto& model : {blinn_phong, blinn_phong_exact}) {
        const double forth = model(d.angles, f0, n).x / d.angles.nl;
        const double back = model(d.swapped, f0, n).x / d.swapped.nl;
        RC_ASSERT(forth >= 0.0);
        // Only the order of a few sums differs: 1e-16, magnified by an exponent up to 65536; and 1 - E.H, which cancels
        // where E = L and is all there is for F0 = 0.
        RC_ASSERT(std::abs(forth - back) <= 1e-10 * forth + 1e-15);
    }
}

RC_GTEST_PROP(BlinnPhong, NeverExceedsItsBound, ()) {
    // section 0: NL / max(NL, NE) <= 1, F <= 1 and the lobe <= 1, so f_cos is at most the normaliser.
    const RandomDirections d = random_directions();
    const double n = random_shininess();
    const glm::dvec3 f0(*rc::gen::inRange(0, 101) / 100.0);
    RC_ASSERT(blinn_phong(d.angles, f0, n).x <= normaliser_linear(n) * (1.0 + 1e-12));
    RC_ASSERT(blinn_phong_exact(d.angles, f0, n).x <= normaliser_exact(n) * (1.0 + 1e-12));
}

TEST(BlinnPhong, DiffuseOfTheExactFormIsNotReciprocal) {
    // section 1: it depends on N.L only.
    const auto diffuse_f = [](const Angles& a) {
        return (lambert(a, glm::dvec3(0.8)) * diffuse_weight_exact(a, glm::dvec3(0.04))).x / a.nl;
    };
    const double forth = diffuse_f(vector_angles(80.0, 10.0, 40.0));
    const double back = diffuse_f(vector_angles(10.0, 80.0, 40.0));
    EXPECT_GT(back / forth, 1.2);
}

TEST(BlinnPhong, DiffuseWeightOfAMetalIsZero) {
    const Angles a = vector_angles(30.0, 45.0, 0.0);
    EXPECT_EQ(diffuse_weight(glm::dvec3(1.0)), glm::dvec3(0.0));
    EXPECT_EQ(diffuse_weight_exact(a, glm::dvec3(1.0)), glm::dvec3(0.0));
    EXPECT_EQ(diffuse_weight(glm::dvec3(0.0)), glm::dvec3(1.0));
}

} // namespace
} // namespace clshade::reference
