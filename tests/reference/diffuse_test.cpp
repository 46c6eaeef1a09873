// The Oren-Nayar family of section 8: identities, limits, reciprocity, positivity, seams.
#include "host/reference/diffuse.h"
#include "tests/reference/directions.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace clshade::reference {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// All models as functions of sigma^2.
struct NamedModel {
    std::string name;
    std::function<glm::dvec3(const Angles&, const glm::dvec3&, double)> f_cos;
};

std::vector<NamedModel> all_models() {
    return {{"full",
             [](const Angles& a, const glm::dvec3& rho, double sigma2) {
                 const OrenNayarParts parts = oren_nayar_full(a, rho, sigma2);
                 return parts.l1 + parts.l2;
             }},
            {"qualitative", oren_nayar_qualitative},
            {"simplified_1", oren_nayar_simplified_1},
            {"simplified_2", oren_nayar_simplified_2},
            {"shininess", [](const Angles& a, const glm::dvec3& rho,
                             double sigma2) { return oren_nayar_shininess(a, rho, 2.0 / sigma2); }},
            {"improved", [](const Angles& a, const glm::dvec3& rho, double sigma2) {
                 return oren_nayar_improved(a, rho, 2.0 / sigma2);
             }}};
}

glm::dvec3 random_direction() {
    const double cosine = *rc::gen::inRange(1, 1001) / 1000.0;
    const double phi = *rc::gen::inRange(0, 3600) / 3600.0 * 2.0 * std::numbers::pi;
    return direction_at(std::acos(cosine), phi);
}

double random_sigma2() {
    return std::exp2(*rc::gen::inRange(-150, 21) / 10.0);
}

RC_GTEST_PROP(OrenNayar, QualitativeFormsAreEqual, ()) {
    const Angles a = unclamped_angles(random_direction(), random_direction());
    const double sigma2 = random_sigma2();
    const double trigonometric = oren_nayar_qualitative(a, glm::dvec3(1.0), sigma2).x;
    // The deck's identity, to 1e-12 (models.md, appendix C).
    RC_ASSERT(std::abs(oren_nayar_simplified_1(a, glm::dvec3(1.0), sigma2).x - trigonometric) <= 1e-12);
    RC_ASSERT(std::abs(oren_nayar_simplified_2(a, glm::dvec3(1.0), sigma2).x - trigonometric) <= 1e-12);
}

RC_GTEST_PROP(OrenNayar, IsReciprocalAndPositive, ()) {
    const glm::dvec3 eye = random_direction();
    const glm::dvec3 light = random_direction();
    const double sigma2 = random_sigma2();
    const Angles a = unclamped_angles(eye, light);
    const Angles b = unclamped_angles(light, eye);
    for (const NamedModel& model : all_models()) {
        const double forth = model.f_cos(a, glm::dvec3(0.7), sigma2).x;
        const double back = model.f_cos(b, glm::dvec3(0.7), sigma2).x;
        // f_r = f_cos / NL; cross-multiplied, so that grazing angles do not magnify rounding.
        RC_ASSERT(std::abs(forth * b.nl - back * a.nl) <= 1e-14);
        RC_ASSERT(forth >= 0.0);
    }
}

RC_GTEST_PROP(OrenNayar, ImprovedIsAtLeastAFewPerCentOfLambert, ()) {
    // section 8.6: the minimum of pi f_r / rho is 0.05, at shininess 0.
    const Angles a = unclamped_angles(random_direction(), random_direction());
    const double shininess = *rc::gen::inRange(0, 1001) / 10.0;
    const double ratio = oren_nayar_improved(a, glm::dvec3(1.0), shininess).x * std::numbers::pi / a.nl;
    RC_ASSERT(ratio >= 0.05 - 2e-6); // 2.22222 truncates 20/9, which costs 5e-7
}

TEST(OrenNayar, MinimumOfTheImprovedModelIsReached) {
    const Angles a = unclamped_angles(direction_at(std::numbers::pi / 2 - 1e-7, std::numbers::pi),
                                      direction_at(std::numbers::pi / 2 - 1e-7, 0.0));
    EXPECT_NEAR(oren_nayar_improved(a, glm::dvec3(1.0), 0.0).x * std::numbers::pi / a.nl, 0.05, 2e-6);
}

TEST(OrenNayar, SmoothSurfaceIsLambert) {
    const Angles a = vector_angles(50.0, 65.0, 20.0);
    const glm::dvec3 rho(0.8, 0.5, 0.1);
    for (const NamedModel& model : all_models()) {
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(model.f_cos(a, rho, 0.0)[i], lambert(a, rho)[i], 1e-15) << model.name;
            EXPECT_NEAR(model.f_cos(a, rho, 1e-12)[i], lambert(a, rho)[i], 1e-11) << model.name;
        }
    }
}

TEST(OrenNayar, InfinitelyRoughIsFinite) {
    const Angles a = vector_angles(50.0, 65.0, 20.0);
    for (const NamedModel& model : all_models()) {
        const double rough = model.f_cos(a, glm::dvec3(1.0), infinity).x;
        EXPECT_NEAR(rough, model.f_cos(a, glm::dvec3(1.0), 1e9).x, 1e-8) << model.name;
        EXPECT_GT(rough, 0.0) << model.name;
    }
    EXPECT_EQ(sigma2_of_shininess(0.0), infinity);
    EXPECT_DOUBLE_EQ(coefficient_a(infinity), 0.5);
    EXPECT_DOUBLE_EQ(coefficient_b(infinity), 0.45);
}

TEST(OrenNayar, ShininessCoefficientsAreThoseOfSigma) {
    for (const double shininess : {0.0, 0.1, 1.0, 5.945, 30.0, 512.0, 65536.0}) {
        const double sigma2 = sigma2_of_shininess(shininess);
        EXPECT_NEAR(shininess_a(shininess), coefficient_a(sigma2), 1e-15) << shininess;
        // 2.22222 truncates 20/9: 1e-6 relative (section 8.5)
        EXPECT_NEAR(shininess_b(shininess), coefficient_b(sigma2), 1.0001e-6 * coefficient_b(sigma2)) << shininess;
    }
}

TEST(OrenNayar, ContinuousAtTheSeams) {
    const double d = 1e-9;
    for (const NamedModel& model : all_models()) {
        for (const double degrees : {20.0, 60.0, 85.0}) {
            // gamma = 0: the azimuth between L and E passes 90 degrees.
            const auto at_azimuth = [&](double dphi) {
                return model
                    .f_cos(unclamped_angles(direction_at(radians(50.0), dphi), direction_at(radians(degrees), 0.0)),
                           glm::dvec3(1.0), 0.8)
                    .x;
            };
            EXPECT_NEAR(at_azimuth(std::numbers::pi / 2 - d), at_azimuth(std::numbers::pi / 2 + d), 1e-8) << model.name;
            // N.L = N.E: alpha and beta change places.
            const auto at_elevation = [&](double theta) {
                return model
                    .f_cos(unclamped_angles(direction_at(radians(degrees), 0.3), direction_at(theta, 0.0)),
                           glm::dvec3(1.0), 0.8)
                    .x;
            };
            EXPECT_NEAR(at_elevation(radians(degrees) - d), at_elevation(radians(degrees) + d), 1e-8) << model.name;
        }
        // E = N, where the azimuth means nothing: 8.1 sets cos(dphi) = 0 below a sine of 1e-7.
        const auto near_normal = [&](double theta) {
            return model.f_cos(unclamped_angles(direction_at(theta, 2.0), direction_at(0.9, 0.0)), glm::dvec3(1.0), 0.8)
                .x;
        };
        EXPECT_NEAR(near_normal(0.99e-7), near_normal(1.01e-7), 1e-7) << model.name;
        // the terminator
        EXPECT_NEAR(model
                        .f_cos(unclamped_angles(direction_at(0.5, 1.0), direction_at(std::numbers::pi / 2 - d, 0.0)),
                               glm::dvec3(1.0), 0.8)
                        .x,
                    0.0, 1e-8)
            << model.name;
    }
}

TEST(OrenNayar, FullModelStaysPositiveBehindTheSurface) {
    // N.E raised to 1e-4 while E points away: gamma / (sines) would pass -1 without the clamp of cos(dphi).
    const glm::dvec3 light = direction_at(radians(45.0), 0.0);
    const Angles a = angles_between({0.0, 0.0, 1.0}, -light, light);
    ASSERT_EQ(a.ne, 1e-4);
    const OrenNayarParts parts = oren_nayar_full(a, glm::dvec3(1.0), infinity);
    EXPECT_GT(parts.l1.x, 0.0);
    EXPECT_GT(parts.l2.x, 0.0);
}

TEST(Lambert, IsTheCosineLaw) {
    EXPECT_NEAR(lambert(vector_angles(60.0, 10.0, 0.0), glm::dvec3(0.6)).x, 0.3 / std::numbers::pi, 1e-15);
}

} // namespace
} // namespace clshade::reference
