// AmbientBRDF tables against the vectors and against a midpoint rule over light directions in double.
#include "host/environment/filter_layout.h"
#include "tests/prefilter/support.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

namespace clshade::tests {
namespace {

constexpr double pi = std::numbers::pi;

const AmbientTables& tables() {
    static const AmbientTables all = prefilter_of().ambient_tables();
    return all;
}

double cosine_of(int i) {
    return std::max(i / 128.0, 1e-4);
}

double shininess_of(int j) {
    return std::exp2(13.0 * j / 64.0) - 1.0;
}

double exact_norm(double n) {
    return (n + 2.0) / (4.0 * pi * (2.0 - std::exp2(-0.5 * n)));
}

glm::dvec2 scale_bias(const std::vector<float>& table, int i, int j) {
    const auto at = 2 * static_cast<std::size_t>(j * 129 + i);
    return {table[at], table[at + 1]};
}

/// The integral of Norm NH^n min(1, NL/NE) R(EH) dw over light directions L = reflected E about H, with H on a plain
/// midpoint grid: no limits worked out beforehand, the horizon tested point by point.
glm::dvec3 brute_force(double n, double ne, int steps, const std::function<glm::dvec3(double)>& reflectance) {
    const glm::dvec3 e(std::sqrt(1.0 - ne * ne), 0.0, ne);
    glm::dvec3 sum(0.0);
    const double reach = n > 0.0 ? std::min(pi / 2.0, std::sqrt(70.0 / n)) : pi / 2.0;
    for (int a = 0; a < steps; ++a) {
        const double theta = reach * (a + 0.5) / steps;
        const double lobe = std::pow(std::cos(theta), n) * std::sin(theta);
        glm::dvec3 ring(0.0);
        for (int b = 0; b < steps; ++b) {
            const double phi = pi * (b + 0.5) / steps;
            const glm::dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            const double eh = glm::dot(e, h);
            const double nl = 2.0 * eh * h.z - ne;
            if (nl > 0.0 && eh > 0.0) {
                ring += 4.0 * eh * std::min(1.0, nl / ne) * reflectance(eh);
            }
        }
        sum += lobe * ring;
    }
    return sum * (2.0 * exact_norm(n) * reach * pi / steps / steps);
}

glm::dvec3 schlick_parts(double c) {
    const double fresnel = std::pow(1.0 - c, 5.0);
    return {1.0 - fresnel, fresnel, 0.0};
}

struct Vertex {
    int i;
    int j;
};

TEST(AmbientTables, AgreeWithBruteForce) {
    for (const Vertex v : {Vertex{1, 0},
                           {2, 64},
                           {5, 40},
                           {13, 16},
                           {16, 64},
                           {32, 8},
                           {45, 33},
                           {64, 0},
                           {64, 25},
                           {90, 50},
                           {111, 3},
                           {127, 64},
                           {128, 30}}) {
        const glm::dvec3 expected = brute_force(shininess_of(v.j), cosine_of(v.i), 2000, schlick_parts);
        const glm::dvec2 found = scale_bias(tables().exact, v.i, v.j);
        // The midpoint rule errs by about 1e-5 where its points straddle the horizon; the tables by less.
        EXPECT_NEAR(found.x / expected.x, 1.0, 2e-5) << v.i << ", " << v.j;
        EXPECT_NEAR(found.y / expected.y, 1.0, 2e-5) << v.i << ", " << v.j;
    }
}

/// What the tables give between vertices, along the exponents only at vertices.
TEST(AmbientTables, AgreeWithTheVectors) {
    int tested = 0;
    for (const nlohmann::json& vector : nlohmann::json::parse(std::ifstream(CLSHADE_TEST_DATA "/vectors.json"))) {
        if (vector.at("model") != "ambient_brdf") {
            continue;
        }
        const double n = vector.at("inputs").at("n");
        const double ne = vector.at("inputs").at("NE");
        const bool linear = vector.at("inputs").at("norm") == "linear";
        const double u = 128.0 * ne;
        const double v = 64.0 * std::min(std::log2(n + 1.0), 13.0) / 13.0;
        // The brute force above reproduces the vector ...
        const glm::dvec3 checked = brute_force(n, ne, 2000, schlick_parts);
        const double ratio = linear ? (0.0397436 * n + 0.0856832) / exact_norm(n) : 1.0;
        const double scale = vector.at("output").at("scale");
        const double bias = vector.at("output").at("bias");
        EXPECT_NEAR(checked.x * ratio / scale, 1.0, 2e-5);
        EXPECT_NEAR(checked.y * ratio / bias, 1.0, 2e-5);
        // ... and the table gives it within what interpolation leaves (models.md section 6, 64 x 32: 0.008 at worst, at
        // n < 1; four times less with half the steps).
        const auto& table = linear ? tables().linear : tables().exact;
        const int i = std::min(static_cast<int>(u), 127);
        const int j = std::min(static_cast<int>(v), 63);
        const glm::dvec2 low = glm::mix(scale_bias(table, i, j), scale_bias(table, i + 1, j), u - i);
        const glm::dvec2 high = glm::mix(scale_bias(table, i, j + 1), scale_bias(table, i + 1, j + 1), u - i);
        const glm::dvec2 found = glm::mix(low, high, v - j);
        EXPECT_NEAR(found.x, scale, 1e-3) << "n " << n << " NE " << ne;
        EXPECT_NEAR(found.y, bias, 1e-4) << "n " << n << " NE " << ne;
        ++tested;
    }
    EXPECT_GE(tested, 5);
}

TEST(AmbientTables, AgreeWithTheClosedCase) {
    // n = 0: scale + bias = 1 - NE/2 (models.md section 6).
    for (int i = 0; i <= 128; ++i) {
        const glm::dvec2 found = scale_bias(tables().exact, i, 0);
        EXPECT_NEAR(found.x + found.y, 1.0 - cosine_of(i) / 2.0, 1e-5) << i;
    }
}

TEST(AmbientTables, LinearIsExactTimesTheNormalisers) {
    for (int j = 0; j <= 64; ++j) {
        const double n = shininess_of(j);
        const double ratio = (0.0397436 * n + 0.0856832) / exact_norm(n);
        for (int i = 0; i <= 128; i += 8) {
            const glm::dvec2 exact = scale_bias(tables().exact, i, j);
            const glm::dvec2 linear = scale_bias(tables().linear, i, j);
            EXPECT_NEAR(linear.x, exact.x * ratio, 1e-6 * linear.x);
            EXPECT_NEAR(linear.y, exact.y * ratio, 1e-6 * linear.y);
        }
    }
}

TEST(AmbientTables, LanesAgree) {
    for (const int lanes : all_lanes) {
        const AmbientTables found = prefilter_of(lanes).ambient_tables();
        ASSERT_EQ(found.exact.size(), tables().exact.size());
        for (std::size_t k = 0; k < found.exact.size(); ++k) {
            ASSERT_TRUE(std::isfinite(found.exact[k]) && found.exact[k] >= 0.0F) << k;
            ASSERT_NEAR(found.exact[k], tables().exact[k], 1e-5 * static_cast<double>(tables().exact[k]))
                << lanes << " lanes, value " << k;
        }
    }
}

TEST(SpectralTable, ConstantReflectanceIsScalePlusBias) {
    const ReflectanceCurve curve{1.0, {glm::dvec3(0.25, 1.0, 0.5)}};
    const std::vector<float> table = prefilter_of().spectral_table(curve, false);
    ASSERT_EQ(table.size(), 3U * 129 * 65);
    for (int j = 0; j <= 64; j += 4) {
        for (int i = 0; i <= 128; i += 4) {
            const glm::dvec2 parts = scale_bias(tables().exact, i, j);
            const glm::dvec3 expected = (parts.x + parts.y) * curve.coefficients[0];
            EXPECT_LT(relative_difference(vertex_value(table, 128, i, j), expected), 5e-6) << i << ", " << j;
        }
    }
}

TEST(SpectralTable, CurveAgreesWithBruteForce) {
    const ReflectanceCurve curve{0.7,
                                 {glm::dvec3(0.6, 0.5, 0.2), glm::dvec3(0.1, 0.3, -0.1), glm::dvec3(0.2, 0.0, 0.3)}};
    const auto reflectance = [&](double c) {
        const double x = 2.0 * (1.0 + curve.bend) * c / (c + curve.bend) - 1.0;
        return curve.coefficients[0] + x * (curve.coefficients[1] + x * curve.coefficients[2]);
    };
    for (const bool linear : {false, true}) {
        const std::vector<float> table = prefilter_of().spectral_table(curve, linear);
        for (const Vertex v : {Vertex{4, 20}, {64, 12}, {100, 50}, {128, 64}}) {
            const double n = shininess_of(v.j);
            const double ratio = linear ? (0.0397436 * n + 0.0856832) / exact_norm(n) : 1.0;
            const glm::dvec3 expected = ratio * brute_force(n, cosine_of(v.i), 2000, reflectance);
            EXPECT_LT(relative_difference(vertex_value(table, 128, v.i, v.j), expected), 2e-5) << v.i << ", " << v.j;
        }
    }
}

TEST(SpectralTable, ReflectanceIsClamped) {
    const std::vector<float> table = prefilter_of().spectral_table({1.0, {glm::dvec3(1.5, -0.5, 1.0)}}, false);
    for (std::size_t k = 0; k < table.size(); k += 3) {
        ASSERT_EQ(table[k], table[k + 2]);
        ASSERT_EQ(table[k + 1], 0.0F);
    }
}

TEST(SpectralTable, RefusesAnEmptyCurve) {
    EXPECT_THROW(static_cast<void>(prefilter_of().spectral_table({}, false)), std::invalid_argument);
}

} // namespace
} // namespace clshade::tests
