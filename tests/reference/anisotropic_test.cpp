// Anisotropic Blinn-Phong of section 3 and tangent frames (rule 6).
#include "host/reference/anisotropic.h"
#include "host/reference/blinn_phong.h"
#include "tests/reference/directions.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>

namespace clshade::reference {
namespace {

const glm::dvec3 up(0.0, 0.0, 1.0);

glm::dvec3 random_direction() {
    const double cosine = *rc::gen::inRange(1, 1001) / 1000.0;
    const double phi = *rc::gen::inRange(0, 3600) / 3600.0 * 2.0 * std::numbers::pi;
    return direction_at(std::acos(cosine), phi);
}

double random_shininess() {
    return std::exp2(*rc::gen::inRange(-400, 1601) / 100.0); // 2^-4 to 2^16
}

TEST(AnisotropicNormaliser, TableOfSection3) {
    struct Row {
        double n_u, n_v, numeric, closed, error, cheap_error; // errors in per cent
    };
    const std::array<Row, 7> table{{{8, 8, 0.410722434, 0.410722434, 0.000, -1.726},
                                    {10, 100, 1.39792044, 1.39790738, -0.001, -0.091},
                                    {2, 200, 1.25264199, 1.25039414, -0.179, -9.318},
                                    {50, 500, 6.42855955, 6.42855957, 0.000, -0.017},
                                    {0, 32, 0.437394537, 0.443392537, 1.371, -23.655},
                                    {1, 1000, 2.56522559, 2.57033019, 0.199, -14.814},
                                    {100, 10000, 40.1886716, 40.1886716, 0.000, -0.098}}};
    for (const Row& row : table) {
        // 1/Norm = int_0^2pi 2 (2 - 2^(-m/2))/(m + 2) dphi, periodic: equal steps converge fast
        constexpr int steps = 20000;
        double integral = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double phi = (i + 0.5) / steps * 2.0 * std::numbers::pi;
            const double m = row.n_u * std::cos(phi) * std::cos(phi) + row.n_v * std::sin(phi) * std::sin(phi);
            integral += 2.0 * (2.0 - std::exp2(-0.5 * m)) / (m + 2.0);
        }
        integral *= 2.0 * std::numbers::pi / steps;
        const double closed = normaliser_anisotropic(row.n_u, row.n_v);
        EXPECT_NEAR(1.0 / integral, row.numeric, 5e-9 * row.numeric);
        EXPECT_NEAR(closed, row.closed, 5e-9 * row.closed);
        EXPECT_NEAR(100.0 * (closed * integral - 1.0), row.error, 0.5001e-3);
        EXPECT_NEAR(100.0 * (normaliser_anisotropic_cheap(row.n_u, row.n_v) * integral - 1.0), row.cheap_error,
                    0.5001e-3);
    }
}

TEST(AnisotropicNormaliser, EqualExponentsGiveTheIsotropicOne) {
    for (const double n : {0.0, 0.5, 8.0, 512.0, 65536.0}) {
        EXPECT_NEAR(normaliser_anisotropic(n, n), normaliser_exact(n), 1e-14 * normaliser_exact(n));
    }
}

RC_GTEST_PROP(Anisotropic, EqualExponentsGiveTheExactForm, ()) {
    const Angles a = unclamped_angles(random_direction(), random_direction());
    const double n = random_shininess();
    const TangentFrame frame = tangent_frame(random_direction(), up);
    const double isotropic = blinn_phong_exact(a, glm::dvec3(0.3), n).x;
    // the exponent is n up to a few roundings, and n |log N.H| < 700 wherever there is anything left
    RC_ASSERT(std::abs(blinn_phong_anisotropic(a, frame, glm::dvec3(0.3), n, n).x - isotropic) <=
              1e-12 * isotropic + 1e-300); // denormal numbers have no digits
}

RC_GTEST_PROP(Anisotropic, IsReciprocalBoundedAndPositive, ()) {
    const glm::dvec3 eye = random_direction();
    const glm::dvec3 light = random_direction();
    const Angles a = unclamped_angles(eye, light);
    const Angles b = unclamped_angles(light, eye);
    const double n_u = random_shininess();
    const double n_v = random_shininess();
    const TangentFrame frame = tangent_frame(random_direction(), up);
    const double forth = anisotropic_f_cos(a, frame, n_u, n_v);
    const double back = anisotropic_f_cos(b, frame, n_u, n_v);
    RC_ASSERT(forth >= 0.0);
    RC_ASSERT(forth <= normaliser_anisotropic(n_u, n_v) * (1.0 + 1e-12));
    RC_ASSERT(std::abs(forth * b.nl - back * a.nl) <= 1e-10 * forth + 1e-300); // denormal numbers have no digits
}

TEST(Anisotropic, HighlightIsLongAlongTheAxisOfTheSmallerExponent) {
    const TangentFrame frame = tangent_frame({1.0, 0.0, 0.0}, up);
    const Angles along = angles_between(up, up, direction_at(0.4, 0.0));
    const Angles across = angles_between(up, up, direction_at(0.4, std::numbers::pi / 2.0));
    const double log_nh = std::log(std::cos(0.2));
    const double norm = normaliser_anisotropic(10.0, 1000.0) * std::cos(0.4);
    EXPECT_NEAR(anisotropic_f_cos(along, frame, 10.0, 1000.0), norm * std::exp(10.0 * log_nh), 1e-12);
    EXPECT_NEAR(anisotropic_f_cos(across, frame, 10.0, 1000.0), norm * std::exp(1000.0 * log_nh), 1e-12);
    const TangentFrame turned = tangent_frame({0.0, -2.0, 0.0}, up);
    EXPECT_NEAR(anisotropic_f_cos(across, turned, 10.0, 1000.0), norm * std::exp(10.0 * log_nh), 1e-12);
}

TEST(Anisotropic, IsWellConditionedAtTheCentre) {
    // (N.H)^e against extended precision, H at a tiny angle t from N at azimuth phi.
    const TangentFrame frame = tangent_frame({1.0, 0.0, 0.0}, up);
    for (const double t : {1e-9, 1e-7, 0.9e-6, 1.1e-6, 1e-5, 1e-3}) {
        for (const double phi : {0.0, 0.7, 1.5}) {
            const Angles a = angles_between(up, up, direction_at(2.0 * t, phi));
            const double e = 100.0 * std::cos(phi) * std::cos(phi) + 60000.0 * std::sin(phi) * std::sin(phi);
            const long double exact =
                std::exp(static_cast<long double>(e) * std::log(std::cos(static_cast<long double>(t))));
            const double norm = normaliser_anisotropic(100.0, 60000.0) * std::min(1.0, a.nl);
            // 60000 t^2/2 for t < 1e-6 is what the choice of the exponent can change: 3e-8
            const double tolerance = t < 1e-6 ? 3e-8 : 1e-11;
            EXPECT_NEAR(anisotropic_f_cos(a, frame, 100.0, 60000.0) / norm / static_cast<double>(exact), 1.0, tolerance)
                << t << ' ' << phi;
        }
    }
}

TEST(Anisotropic, ExponentsOfZeroAreOneEverywhere) {
    const TangentFrame frame = tangent_frame({1.0, 0.0, 0.0}, up);
    Angles a = angles_between(up, direction_at(1.5, 0.2), direction_at(1.5, 0.3));
    EXPECT_NEAR(anisotropic_f_cos(a, frame, 0.0, 0.0), 0.5 / std::numbers::pi, 1e-15);
    a = angles_between(up, up, up);
    EXPECT_NEAR(anisotropic_f_cos(a, frame, 0.0, 0.0), 0.5 / std::numbers::pi, 1e-15);
}

RC_GTEST_PROP(TangentFrames, AreOrthonormalAndRightHanded, ()) {
    const glm::dvec3 n = random_direction() * (*rc::gen::inRange(0, 2) == 0 ? 1.0 : -1.0);
    const glm::dvec3 t = *rc::gen::inRange(0, 4) == 0 ? glm::dvec3(0.0) : 3.0 * random_direction();
    const TangentFrame frame = tangent_frame(t, n);
    RC_ASSERT(std::abs(glm::length(frame.tangent) - 1.0) <= 1e-14);
    RC_ASSERT(std::abs(glm::dot(frame.tangent, n)) <= 1e-11); // t may stand 1e-4 from N
    RC_ASSERT(glm::length(glm::cross(n, frame.tangent) - frame.bitangent) <= 1e-14);
    if (!frame.missing) {
        RC_ASSERT(glm::dot(frame.tangent, t) > 0.0); // the nearest perpendicular direction
        RC_ASSERT(std::abs(glm::dot(frame.bitangent, t)) <= 1e-10);
    }
}

TEST(TangentFrames, MissingOnesComeFromTheNormalAlone) {
    const auto missing = [](const glm::dvec3& t, const glm::dvec3& n) { return tangent_frame(t, n).missing; };
    EXPECT_TRUE(missing(glm::dvec3(0.0), up));
    EXPECT_TRUE(missing({0.99e-6, 0.0, 0.0}, up));
    EXPECT_FALSE(missing({1.01e-6, 0.0, 0.0}, up));
    EXPECT_TRUE(missing({0.0, 0.0, -5.0}, up)); // parallel
    EXPECT_TRUE(missing({0.99e-4, 0.0, 1.0}, up));
    EXPECT_FALSE(missing({1.01e-4, 0.0, 1.0}, up));
    EXPECT_TRUE(missing({1.9e19, 0.0, 0.0}, up)); // its square is no float
    EXPECT_FALSE(missing({1.8e19, 0.0, 0.0}, up));
    // Duff et al. 2017: b1 = (1 + s x^2 a, s x y a, -s x), a = -1/(s + z), s = sign of z
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.6, -0.3, -0.2));
    const double a = -1.0 / (-1.0 + n.z);
    const glm::dvec3 b1(1.0 - n.x * n.x * a, -n.x * n.y * a, n.x);
    EXPECT_LT(glm::length(tangent_frame(glm::dvec3(0.0), n).tangent - b1), 1e-15);
    EXPECT_EQ(tangent_frame(glm::dvec3(0.0), up).tangent, glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_EQ(tangent_frame(glm::dvec3(0.0), -up).tangent, glm::dvec3(1.0, 0.0, 0.0));
}

} // namespace
} // namespace clshade::reference
