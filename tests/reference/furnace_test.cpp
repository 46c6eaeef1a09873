// White furnace of single layers (models.md section 12).
#include "host/reference/blinn_phong.h"
#include "host/reference/diffuse.h"
#include "tests/reference/furnace.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace clshade::reference {
namespace {

TEST(Furnace, SpecularLobeWithFresnelOne) {
    const std::array<double, 7> nes{0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0};
    const std::vector<std::pair<double, std::array<double, 7>>> table{
        {0, {0.9950, 0.9500, 0.8500, 0.7500, 0.6500, 0.5500, 0.5000}},
        {1, {0.4999, 0.5531, 0.6164, 0.6303, 0.6093, 0.5609, 0.5282}},
        {2, {0.3400, 0.3956, 0.4933, 0.5556, 0.5822, 0.5733, 0.5556}},
        {4, {0.2200, 0.2707, 0.3784, 0.4754, 0.5536, 0.6004, 0.6071}},
        {8, {0.1463, 0.1937, 0.3044, 0.4218, 0.5428, 0.6535, 0.6935}},
        {16, {0.1034, 0.1508, 0.2698, 0.4072, 0.5621, 0.7285, 0.8018}},
        {32, {0.0750, 0.1240, 0.2553, 0.4141, 0.5945, 0.7926, 0.8889}},
        {64, {0.0547, 0.1058, 0.2514, 0.4289, 0.6239, 0.8328, 0.9412}},
        {128, {0.0403, 0.0941, 0.2552, 0.4454, 0.6464, 0.8571, 0.9697}},
        {512, {0.0228, 0.0848, 0.2715, 0.4708, 0.6738, 0.8815, 0.9922}},
        {2048, {0.0142, 0.0873, 0.2844, 0.4850, 0.6871, 0.8915, 0.9981}},
        {8192, {0.0101, 0.0924, 0.2919, 0.4924, 0.6936, 0.8960, 0.9995}}};
    for (const auto& [n, row] : table) {
        for (std::size_t i = 0; i < nes.size(); ++i) {
            const double reflectance = reflectance_of_lobe(
                [n = n](const Angles& a) { return blinn_phong_exact(a, glm::dvec3(1.0), n).x; }, n, nes[i]);
            EXPECT_NEAR(reflectance, row[i], printed) << "n = " << n << ", N.E = " << nes[i];
            EXPECT_LE(reflectance, 1.0);
        }
    }
}

struct BlinnPhongMaximum {
    double f0;
    double exact;
    double exact_n;
    double exact_ne;
    double approximated;
    double approximated_ne; // always n = 8192
};

class FurnaceMaximum : public testing::TestWithParam<BlinnPhongMaximum> {};

double total_exact(double f0, double n, double ne) {
    return reflectance_of_lobe([&](const Angles& a) { return blinn_phong_exact(a, glm::dvec3(f0), n).x; }, n, ne) +
           reflectance_of_diffuse(
               [&](const Angles& a) {
                   return (lambert(a, glm::dvec3(1.0)) * diffuse_weight_exact(a, glm::dvec3(f0))).x;
               },
               ne);
}

double total_approximated(double f0, double n, double ne) {
    return reflectance_of_lobe([&](const Angles& a) { return blinn_phong(a, glm::dvec3(f0), n).x; }, n, ne) +
           diffuse_weight(glm::dvec3(f0)).x; // Lambert reflects all it gets
}

TEST_P(FurnaceMaximum, OfBlinnPhongOnWhite) {
    const BlinnPhongMaximum m = GetParam();
    EXPECT_NEAR(total_exact(m.f0, m.exact_n, m.exact_ne), m.exact, printed);
    EXPECT_NEAR(total_approximated(m.f0, 8192.0, m.approximated_ne), m.approximated, printed);
    // They are maxima: no other place of a coarse grid is above.
    for (const double n : {0.0, 8.0, 128.0, 8192.0}) {
        for (const double ne : {0.01, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0}) {
            EXPECT_LE(total_exact(m.f0, n, ne), m.exact + printed) << n << ' ' << ne;
            EXPECT_LE(total_approximated(m.f0, n, ne), m.approximated + printed) << n << ' ' << ne;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(BlinnPhong, FurnaceMaximum,
                         testing::Values(BlinnPhongMaximum{0.02, 0.9985, 8192, 0.2, 1.0447, 0.2},
                                         BlinnPhongMaximum{0.04, 0.9983, 0, 0.01, 1.0273, 0.2},
                                         BlinnPhongMaximum{0.08, 0.9982, 0, 0.01, 1.0000, 1.0},
                                         BlinnPhongMaximum{0.2, 0.9978, 0, 0.01, 0.9998, 1.0},
                                         BlinnPhongMaximum{0.5, 0.9967, 0, 0.01, 0.9993, 1.0},
                                         BlinnPhongMaximum{1.0, 0.9995, 8192, 1.0, 0.9984, 1.0}));

TEST(Furnace, OrenNayarMaxima) {
    struct Row {
        double shininess;
        double qualitative;
        double improved;
        double full_half;
        double full_one;
    };
    const std::vector<Row> table{{0, 0.7250, 0.6295, 0.7622, 0.8472},   {1, 0.7861, 0.7466, 0.8202, 0.9000},
                                 {2, 0.8305, 0.8158, 0.8618, 0.9371},   {5.945, 0.9251, 0.9316, 0.9487, 1.0100},
                                 {10, 0.9665, 0.9717, 0.9850, 1.0366},  {30, 1.0117, 1.0086, 1.0202, 1.0490},
                                 {48, 1.0151, 1.0109, 1.0207, 1.0413},  {100, 1.0123, 1.0086, 1.0150, 1.0263},
                                 {300, 1.0056, 1.0039, 1.0065, 1.0106}, {1000, 1.0019, 1.0013, 1.0021, 1.0034}};
    for (const Row& row : table) {
        const double sigma2 = sigma2_of_shininess(row.shininess);
        const auto full = [&](double rho) {
            return [=](const Angles& a) {
                const OrenNayarParts parts = oren_nayar_full(a, glm::dvec3(rho), sigma2);
                return (parts.l1.x + parts.l2.x) / rho;
            };
        };
        const std::array<std::pair<Lobe, double>, 4> models{
            {{[&](const Angles& a) { return oren_nayar_qualitative(a, glm::dvec3(1.0), sigma2).x; }, row.qualitative},
             {[&](const Angles& a) { return oren_nayar_improved(a, glm::dvec3(1.0), row.shininess).x; }, row.improved},
             {full(0.5), row.full_half},
             {full(1.0), row.full_one}}};
        for (const auto& [model, maximum] : models) {
            EXPECT_NEAR(reflectance_of_diffuse(model, 1e-6), maximum, printed) << "shininess " << row.shininess;
            for (const double ne : {0.1, 0.4, 0.7, 1.0}) {
                EXPECT_LE(reflectance_of_diffuse(model, ne), maximum + printed) << row.shininess << ' ' << ne;
            }
        }
    }
}

} // namespace
} // namespace clshade::reference
