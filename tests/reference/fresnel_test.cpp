// Fresnel formulas of sections 4 and 5: ends of the range, identities, total internal reflection.
#include "host/reference/fresnel.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace clshade::reference {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double random_cosine() {
    return *rc::gen::inRange(0, 10001) / 10000.0;
}
double random_index() {
    return 1.0 + *rc::gen::inRange(1, 30001) / 10000.0;
}

TEST(Dielectric, EndsOfTheRange) {
    for (const double n : {0.5, 0.9, 1.33, 1.5, 4.0, infinity}) {
        EXPECT_EQ(fresnel_dielectric(n, 0.0), 1.0) << n;
    }
    for (const double c : {0.0, 0.3, 1.0}) {
        EXPECT_EQ(fresnel_dielectric(1.0, c), 0.0); // c = 0 would be 0/0
        EXPECT_EQ(fresnel_dielectric(infinity, c), 1.0);
        EXPECT_EQ(fresnel_dielectric(0.0, c), 1.0); // out of a medium of infinite index
    }
    EXPECT_NEAR(fresnel_dielectric(1.5, 1.0), 0.04, 1e-16);
    EXPECT_NEAR(fresnel_dielectric(1.0 / 1.5, 1.0), 0.04, 1e-16);
}

TEST(Dielectric, ReflectsTotallyPastTheCriticalAngle) {
    // n = 1.3/1.8: sin of the critical angle is n.
    const double n = 1.3 / 1.8;
    const double critical = std::sqrt(1.0 - n * n);
    EXPECT_EQ(fresnel_dielectric(n, critical - 1e-9), 1.0);
    EXPECT_EQ(fresnel_dielectric(n, 0.5 * critical), 1.0);
    const double before = fresnel_dielectric(n, critical + 1e-4);
    EXPECT_LT(before, 0.95);
    EXPECT_GT(before, 0.5);
}

TEST(Dielectric, InsideAStackTheCriticalAngleIsOutOfReach) {
    // Light that came from air at c meets n2 < n1 at sin' = sin/n1, and sin' = n2/n1 would need sin = n2 >= 1.
    for (const double c : {0.0, 1e-6, 0.1, 0.5}) {
        const double inside = refracted_cosine(c, 1.8);
        EXPECT_LT(1.0 - inside * inside, 1.3 * 1.3 / (1.8 * 1.8));
        EXPECT_LT(fresnel_dielectric(1.3 / 1.8, inside), 0.1) << c;
    }
    // A gas under glass: the bottom reflects all, and the exit never reflects totally.
    EXPECT_NEAR(f_bottom_exact(1.8, 0.2, 0.5), std::pow(1.0 - fresnel_dielectric(1.8, 0.5), 2.0), 1e-15);
}

RC_GTEST_PROP(Dielectric, IsTheSameFromBothSides, ()) {
    // F(n; c) = F(1/n; c') (models.md section 5)
    const double n = random_index();
    const double c = random_cosine();
    // From inside g^2 = 1/n^2 - 1 + c'^2 = c^2/n^2 has cancelled: g is off by 1e-16 n/c, by 1e-8 at c = 0, and F by
    // n^2 g/c', c' being sqrt(1 - 1/n^2) at least.
    const double inside = fresnel_dielectric(1.0 / n, refracted_cosine(c, n));
    RC_ASSERT(std::abs(fresnel_dielectric(n, c) - inside) <= 1e-14 * n * n / (std::max(c, 1e-7) * std::sqrt(n - 1.0)));
}

RC_GTEST_PROP(Dielectric, RisesTowardsGrazing, ()) {
    const double n = random_index();
    const double c = random_cosine();
    const double f = fresnel_dielectric(n, c);
    // 1e-14: a dozen roundings. Past n = 2 + sqrt 3 reflectance dips before it rises.
    RC_ASSERT(f <= 1.0);
    if (n < 2.0 + std::numbers::sqrt3) {
        RC_ASSERT(f >= f0_between(1.0, n) - 1e-14);
        RC_ASSERT(fresnel_dielectric(n, 0.99 * c) >= f - 1e-14);
    }
}

RC_GTEST_PROP(Conductor, WithoutAbsorptionIsADielectric, ()) {
    const double n = *rc::gen::inRange(0, 2) == 0 ? random_index() : 1.0 / random_index();
    const double c = random_cosine();
    // Where reflection begins to be total, a = sqrt(t) turns a rounding of t into its square root.
    RC_ASSERT(std::abs(fresnel_conductor(n, 0.0, c) - fresnel_dielectric(n, c)) <= 1e-7);
}

RC_GTEST_PROP(Conductor, IsAsPublished, ()) {
    // models.md section 4, literally; the squares of fresnel.cpp are the same.
    const double n = *rc::gen::inRange(1, 5001) / 1000.0;
    const double k = *rc::gen::inRange(1, 8001) / 1000.0;
    const double c = random_cosine();
    const double s2 = 1.0 - c * c;
    const double t = n * n - k * k - s2;
    const double q = std::sqrt(t * t + 4.0 * n * n * k * k);
    const double a = std::sqrt(std::max(0.0, (q + t) / 2.0));
    const double rs = (q - 2.0 * a * c + c * c) / (q + 2.0 * a * c + c * c);
    const double rp = rs * (q * c * c - 2.0 * a * c * s2 + s2 * s2) / (q * c * c + 2.0 * a * c * s2 + s2 * s2);
    RC_ASSERT(std::abs(fresnel_conductor(n, k, c) - 0.5 * (rs + rp)) <= 1e-9); // t cancels where n^2 = k^2 + s2
}

TEST(Conductor, EndsOfTheRange) {
    EXPECT_EQ(fresnel_conductor(1.0, 0.0, 0.0), 0.0);
    EXPECT_EQ(fresnel_conductor(1.0, 0.0, 0.7), 0.0);
    EXPECT_EQ(fresnel_conductor(0.2, 3.0, 0.0), 1.0);
    EXPECT_EQ(fresnel_conductor(1.5, 0.0, 0.0), 1.0);
    EXPECT_EQ(fresnel_conductor(0.0, 0.0, 1.0), 1.0); // seen from a medium of infinite index
    EXPECT_EQ(fresnel_conductor(0.0, 0.0, 0.3), 1.0);
    // ((n - 1)^2 + k^2)/((n + 1)^2 + k^2)
    EXPECT_NEAR(fresnel_conductor(0.2, 3.0, 1.0), (0.64 + 9.0) / (1.44 + 9.0), 1e-15);
}

TEST(Index, OfF0InAir) {
    for (const double n : {1.0, 1.0001, 1.33, 1.5, 4.0, 100.0}) {
        // 1 - sqrt(F0) = 2/(n + 1) loses n/2 roundings, sqrt(F0) near 0 is 1e-16 of 1.
        EXPECT_NEAR(index_of_f0(f0_between(1.0, n)), n, 1e-15 * n * n);
    }
    EXPECT_EQ(index_of_f0(0.0), 1.0);
    EXPECT_EQ(index_of_f0(1.0), infinity);
    EXPECT_NEAR(index_of_f0(0.04), 1.5, 1e-15);
}

TEST(Index, InfiniteOnesHaveLimits) {
    EXPECT_EQ(f0_between(1.5, infinity), 1.0);
    EXPECT_EQ(f0_between(infinity, 1.5), 1.0);
    EXPECT_EQ(f0_between(infinity, infinity), 0.0);
    EXPECT_EQ(relative_index(infinity, infinity), 1.0);
    EXPECT_EQ(relative_index(infinity, 1.5), 0.0);
    EXPECT_EQ(relative_index(1.5, infinity), infinity);
    EXPECT_EQ(refracted_cosine(0.3, infinity), 1.0);
    EXPECT_EQ(refracted_cosine(0.3, 1.0), 0.3);
}

TEST(Bottom, ExactEqualsConstantAtNormalIncidence) {
    // The full weight in constant mode is F_transmittance F_b.
    for (const double n1 : {1.0, 1.33, 1.8}) {
        for (const double n2 : {1.0, 1.3, 1.8, 2.5}) {
            EXPECT_NEAR(f_bottom_exact(n1, n2, 1.0), (1.0 - f0_between(1.0, n1)) * f_bottom_constant(n1, n2), 1e-15);
        }
    }
}

} // namespace
} // namespace clshade::reference
