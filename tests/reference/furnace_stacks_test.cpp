// White furnace of anisotropic lobes and of stacks (models.md section 12).
#include "host/reference/blinn_phong.h"
#include "host/reference/diffuse.h"
#include "tests/reference/furnace.h"
#include "tests/reference/random_stacks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace clshade::reference {
namespace {

/// Reflectance of a stack in its red channel, lobe by lobe.
double reflectance(const MaterialValues& m, double ne, int rings, int sectors) {
    double sum = 0.0;
    for (std::size_t k = 0; k < m.layers().size(); ++k) {
        sum += reflectance_of_lobe([&](const Angles& a) { return specular_of_layer(m, a, k).x; },
                                   m.layers()[k].shininess, ne, rings, sectors);
    }
    if (m.diffuse != DiffuseModel::none) {
        sum += reflectance_of_diffuse([&](const Angles& a) { return reflect(m, a).diffuse.x; }, ne);
    }
    return sum;
}

TEST(FurnaceOfStacks, DualLayerTable) {
    // Exponents are those with which all values of the table come out: 512 over 32, and 128 over 12 for skin.
    struct Row {
        double n1, n2, shi_top, shi_bottom;
        DiffuseModel diffuse;
        std::array<double, 6> reflectances;
    };
    const std::array<double, 6> nes{0.05, 0.1, 0.2, 0.4, 0.7, 1.0};
    const std::array<Row, 3> table{
        {{1.5, 1.5, 512, 32, DiffuseModel::lambert, {0.9659, 0.9832, 1.0007, 0.9934, 0.9875, 0.9992}},
         {1.5, 2.0, 512, 32, DiffuseModel::lambert, {0.9489, 0.9666, 0.9851, 0.9807, 0.9799, 0.9971}},
         {1.47, 1.4, 128, 12, DiffuseModel::oren_nayar, {0.9096, 0.9135, 0.9106, 0.8810, 0.8425, 0.8341}}}};
    for (const Row& row : table) {
        const MaterialValues m = stack_of({layer_of_index(SpecularModel::blinn_phong, row.n1, row.shi_top),
                                           layer_of_index(SpecularModel::blinn_phong, row.n2, row.shi_bottom)},
                                          FresnelModel::constant, AbsorptionModel::none, row.diffuse, glm::dvec3(1.0));
        for (std::size_t i = 0; i < nes.size(); ++i) {
            EXPECT_NEAR(reflectance(m, nes[i], 500, 160), row.reflectances[i], printed) << row.n1 << ' ' << nes[i];
        }
    }
}

TEST(FurnaceOfStacks, AnisotropicLobeNeverExceedsOne) {
    const std::array<std::pair<double, double>, 8> exponents{
        {{0, 0}, {0, 32}, {0, 1000}, {1, 1000}, {2, 200}, {10, 100}, {50, 500}, {100, 10000}}};
    for (const auto& [n_u, n_v] : exponents) {
        for (const glm::dvec3& t :
             {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0)}) { // symmetric about the plane
            const TangentFrame frame = tangent_frame(t, {0.0, 0.0, 1.0});
            for (const double ne : {0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0}) {
                const double all = reflectance_of_lobe(
                    [&, u = n_u, v = n_v](const Angles& a) { return anisotropic_f_cos(a, frame, u, v); },
                    std::min(n_u, n_v), ne);
                EXPECT_LE(all, 1.0) << n_u << ' ' << n_v << ' ' << ne;
                EXPECT_GT(all, 0.0);
            }
        }
    }
}

TEST(FurnaceOfStacks, LobesOfOneExponentNeverExceedOne) {
    // Every layer has the kernel D = Norm NH^n min(1, NL/NE), whose integral is at most 1 with the exact normaliser,
    // and the shares of all layers add up to at most 1 in every direction.
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        StackGenerator random(seed);
        const double n = random.shininess();
        std::vector<LayerValues> layers = random.layers();
        for (LayerValues& layer : layers) {
            layer.shininess = n;
            layer.shininess_u = n;
            layer.shininess_v = n;
            if (layer.specular == SpecularModel::blinn_phong) {
                layer.specular = SpecularModel::blinn_phong_exact;
            }
        }
        for (const double ne : {0.05, 0.3, 1.0}) {
            EXPECT_LE(reflectance(stack_of(layers, FresnelModel::exact), ne, 100, 40), 1.0) << seed << ' ' << ne;
            for (LayerValues& layer : layers) { // whose linear normaliser is larger by up to 0.57 %
                layer.specular = layer.metal == nullptr ? layer.specular : SpecularModel::none;
            }
            EXPECT_LE(reflectance(stack_of(layers, FresnelModel::constant), ne, 100, 40), 1.0) << seed << ' ' << ne;
        }
    }
}

/// Integral of the kernel of one lobe times a weight w(E.H).
template <class Weight>
double weighted(const LayerValues& layer, FresnelModel model, double ne, Weight w) {
    return reflectance_of_lobe([&](const Angles& a) { return lobe_f_cos(layer, model, a) * w(a.eh); }, layer.shininess,
                               ne, 100, 40);
}

/// What a stack under a top interface F(c) may reflect at most. fresnel = constant: the top sends back P = int D_0 F.
/// All that is below is (1 - F) times constants whose sum is at most 1 (host/reference/layers.h, "Energy"), so it is at
/// most the largest of the integrals Q_k = int D_k (1 - F) over the kernels of the lobes and of the diffuse part.
/// fresnel = exact has (1 - F)^2 instead, times shares that vary little inside, where the cosine stays above
/// sqrt(1 - 1/n^2); there the bound is no proof, but leaves out a whole factor 1 - F.
/// It is not 1: P is the average of F over the lobe, 1 - F that over other kernels. A sharp coat (n = 8192, index 1.5)
/// on white of its own index reflects 1.011 at N.E = 0.2, as the single layer does 1.027 (section 12).
double bound(const MaterialValues& m, double ne) {
    const LayerValues& top = m.layers().front();
    const auto f = [&](double c) { return interface_fresnel(top, m.fresnel, c).x; };
    double below =
        reflectance_of_diffuse([&](const Angles& a) { return lambert(a, glm::dvec3(1.0)).x * (1.0 - f(a.eh)); }, ne);
    for (std::size_t k = 1; k < m.layers().size(); ++k) {
        below = std::max(below, weighted(m.layers()[k], m.fresnel, ne, [&](double c) { return 1.0 - f(c); }));
    }
    return weighted(top, m.fresnel, ne, f) + below;
}

TEST(FurnaceOfStacks, DeepStacksOnWhiteStayBelowTheirBound) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        StackGenerator random(seed);
        std::vector<LayerValues> layers;
        const int count = 2 + static_cast<int>(random.between(0.0, 7.0));
        for (int k = 0; k < count; ++k) {
            const bool plain = random.chance(0.5);
            layers.push_back(layer_of_index(plain ? SpecularModel::blinn_phong : SpecularModel::blinn_phong_exact,
                                            random.between(1.2, 2.5), std::exp2(random.between(3.2, 13.0))));
        }
        for (const FresnelModel fresnel : {FresnelModel::constant, FresnelModel::exact}) {
            const MaterialValues m =
                stack_of(layers, fresnel, AbsorptionModel::none, DiffuseModel::lambert, glm::dvec3(1.0));
            for (const double ne : {0.1, 0.2, 1.0}) {
                EXPECT_LE(reflectance(m, ne, 100, 40), bound(m, ne) + printed) << seed << ' ' << ne;
            }
        }
    }
}

} // namespace
} // namespace clshade::reference
