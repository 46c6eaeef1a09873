// AmbientBRDF: its integrals, closed cases and table (models.md section 6).
#include "host/environment/filter_layout.h"
#include "host/reference/ambient_brdf.h"
#include "host/reference/blinn_phong.h"
#include "host/reference/fresnel.h"
#include "host/scene/metal_table.h"
#include "tests/reference/furnace.h"

#include <gtest/gtest.h>

#include <cmath>

namespace clshade::reference {
namespace {

double sum_of(const AmbientBrdf& brdf) {
    return brdf.scale + brdf.bias;
}

TEST(AmbientBrdf, OfExponentZeroIsKnownAtEveryAngle) {
    // Section 6: scale + bias = 1 - NE/2. The bound is the accuracy that the header promises.
    for (const double ne : {1e-4, 1e-3, 1.0 / 128.0, 0.05, 0.3, 0.5, 0.7, 0.99, 0.9999, 1.0}) {
        EXPECT_NEAR(sum_of(ambient_brdf(0.0, ne, Normaliser::exact)), 1.0 - 0.5 * ne, 1e-9) << ne;
    }
}

TEST(AmbientBrdf, TendsToTheCosineForMirrors) {
    for (const double ne : {0.1, 0.5, 0.9}) { // the lobe's width in N.L is 2/sqrt n, at grazing angles relative to N.E
        EXPECT_NEAR(sum_of(ambient_brdf(1e8, ne, Normaliser::exact)), ne, 2e-4) << ne;
    }
}

TEST(AmbientBrdf, IsTheReflectanceOfTheLobeInAWhiteFurnace) {
    for (const double n : {1.0, 8.0, 128.0, 2048.0}) {
        for (const double ne : {0.1, 0.5, 0.9}) {
            const auto reflectance = [&](double f0) {
                const Lobe lobe = [&](const Angles& a) { return blinn_phong_exact(a, glm::dvec3(f0), n).x; };
                return reflectance_of_lobe(lobe, n, ne);
            };
            const AmbientBrdf brdf = ambient_brdf(n, ne, Normaliser::exact);
            EXPECT_NEAR(sum_of(brdf), reflectance(1.0), printed) << n << " " << ne;
            EXPECT_NEAR(brdf.bias, reflectance(0.0), printed) << n << " " << ne;
        }
    }
}

TEST(AmbientBrdf, LinearNormaliserOnlyScales) {
    const AmbientBrdf exact = ambient_brdf(5.0, 0.4, Normaliser::exact);
    const AmbientBrdf linear = ambient_brdf(5.0, 0.4, Normaliser::linear);
    const double ratio = normaliser_linear(5.0) / normaliser_exact(5.0);
    EXPECT_NEAR(linear.scale, exact.scale * ratio, 1e-14);
    EXPECT_NEAR(linear.bias, exact.bias * ratio, 1e-14);
}

/// Shininess at row j of the table.
double row_shininess(double j) {
    return std::exp2(ambient_octaves * j / ambient_exponents) - 1.0;
}

TEST(AmbientTable, HoldsTheIntegralAtItsVertices) {
    for (const int i : {0, 1, 64, 128}) {
        for (const int j : {0, 1, 30, 64}) {
            const double ne = std::max(i / 128.0, 1e-4);
            const AmbientBrdf table = ambient_brdf_of_table(row_shininess(j), i / 128.0, Normaliser::linear);
            const AmbientBrdf integral = ambient_brdf(row_shininess(j), ne, Normaliser::linear);
            EXPECT_NEAR(table.scale, integral.scale, 1e-9) << i << " " << j;
            EXPECT_NEAR(table.bias, integral.bias, 1e-9) << i << " " << j;
        }
    }
}

TEST(AmbientTable, IsBilinearBetweenThem) {
    const auto vertex = [](int i, int j) { return ambient_brdf(row_shininess(j), i / 128.0, Normaliser::exact).scale; };
    const double expected =
        0.75 * (0.5 * vertex(40, 20) + 0.5 * vertex(41, 20)) + 0.25 * (0.5 * vertex(40, 21) + 0.5 * vertex(41, 21));
    EXPECT_NEAR(ambient_brdf_of_table(row_shininess(20.25), 40.5 / 128.0, Normaliser::exact).scale, expected, 1e-12);
}

TEST(AmbientTable, EndsAt8191) {
    const AmbientBrdf end = ambient_brdf_of_table(8191.0, 0.4, Normaliser::linear);
    EXPECT_EQ(ambient_brdf_of_table(65536.0, 0.4, Normaliser::linear).scale, end.scale);
    EXPECT_EQ(ambient_brdf_of_table(8192.0, 0.4, Normaliser::linear).bias, end.bias);
}

TEST(MetalAmbient, FollowsTheMetalsCurve) {
    const SpectralMetal copper(built_in_metal("copper").value());
    const MetalAmbient ambient(copper);
    for (const double c : {0.0, 1e-5, 0.03, 0.4999, 0.77, 0.99999, 1.0}) {
        const glm::dvec3 error = glm::abs(ambient.reflectance(c) - copper.reflectance(c));
        EXPECT_LT(std::max({error.x, error.y, error.z}), 1e-9) << c;
    }
}

TEST(MetalAmbient, IsTheReflectanceOfTheMetalInAWhiteFurnace) {
    const SpectralMetal gold(built_in_metal("gold").value());
    const MetalAmbient ambient(gold);
    for (const double n : {4.0, 300.0}) {
        for (const double ne : {0.15, 0.8}) {
            const glm::dvec3 value = ambient.integrated(n, ne, Normaliser::exact);
            for (int i = 0; i < 3; ++i) {
                const Lobe lobe_of_channel = [&](const Angles& a) {
                    return normaliser_exact(n) * lobe(a, n) * attenuated_cosine(a) * gold.reflectance(a.eh)[i];
                };
                EXPECT_NEAR(value[i], reflectance_of_lobe(lobe_of_channel, n, ne, 200, 60), 4e-4) << n << " " << ne;
            }
        }
    }
    const double n = row_shininess(17.0);
    const glm::dvec3 difference =
        ambient.of_table(n, 33.0 / 128.0, Normaliser::linear) - ambient.integrated(n, 33.0 / 128.0, Normaliser::linear);
    EXPECT_LT(glm::length(difference), 1e-9);
}

} // namespace
} // namespace clshade::reference
