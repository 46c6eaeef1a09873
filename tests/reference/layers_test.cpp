// Stacks of layers (section 5, rule 9 of host/gbuffer/frame.h): limits, reciprocity, energy.
#include "host/reference/absorption.h"
#include "host/reference/blinn_phong.h"
#include "host/reference/diffuse.h"
#include "host/reference/layers.h"
#include "tests/reference/directions.h"
#include "tests/reference/random_stacks.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace clshade::reference {
namespace {

/// A random stack on a random albedo, under random directions.
struct RandomCase {
    explicit RandomCase(std::uint64_t seed) : random(seed), layers(random.layers()) {
        eye = random.direction();
        light = random.direction();
        angles = unclamped_angles(eye, light);
        diffuse = all_diffuse_models.at(1 + static_cast<std::size_t>(random.between(0.0, 7.0))); // none left out
        albedo = {random.between(0.0, 1.0), random.between(0.0, 1.0), random.between(0.0, 1.0)};
    }
    [[nodiscard]] MaterialValues stack(const std::vector<LayerValues>& of, FresnelModel fresnel,
                                       AbsorptionModel absorption) const {
        return stack_of(of, fresnel, absorption, diffuse, albedo);
    }
    [[nodiscard]] Reflected reflected(const std::vector<LayerValues>& of, FresnelModel fresnel,
                                      AbsorptionModel absorption) const {
        return reflect(stack(of, fresnel, absorption), angles);
    }

    StackGenerator random;
    std::vector<LayerValues> layers;
    glm::dvec3 eye{0.0};
    glm::dvec3 light{0.0};
    Angles angles;
    DiffuseModel diffuse = DiffuseModel::none;
    glm::dvec3 albedo{0.0};
};

RandomCase random_case() {
    return RandomCase(*rc::gen::arbitrary<std::uint64_t>());
}

bool close(const glm::dvec3& a, const glm::dvec3& b, double rel, double abs = 0.0) {
    const auto near = [&](double x, double y) { return std::abs(x - y) <= rel * std::abs(y) + abs; };
    return near(a.x, b.x) && near(a.y, b.y) && near(a.z, b.z);
}

void expect_same_bits(const Reflected& a, const Reflected& b) {
    RC_ASSERT(a.diffuse == b.diffuse);
    RC_ASSERT(a.specular == b.specular);
}

// Limits -----------------------------------------------------------------------------------------------------------

RC_GTEST_PROP(Stack, ALayerOfIndexOneAnywhereChangesNoBit, ()) {
    RandomCase c = random_case();
    if (c.layers.size() == most_layers) {
        c.layers.pop_back();
    }
    for (const FresnelModel fresnel : all_fresnel_models) {
        for (const AbsorptionModel absorption : all_absorption_models) {
            const Reflected without = c.reflected(c.layers, fresnel, absorption);
            for (std::size_t at = 0; at < c.layers.size(); ++at) {
                for (const SpecularModel model :
                     {SpecularModel::none, SpecularModel::blinn_phong, SpecularModel::blinn_phong_exact,
                      SpecularModel::blinn_phong_anisotropic}) {
                    std::vector<LayerValues> more = c.layers;
                    more.insert(more.begin() + static_cast<std::ptrdiff_t>(at),
                                layer_of(model, glm::dvec3(0.0), 300.0));
                    expect_same_bits(c.reflected(more, fresnel, absorption), without);
                }
            }
        }
    }
}

RC_GTEST_PROP(Stack, ALayerOfIndexOneInOneChannelChangesNothingThere, ()) {
    RandomCase c = random_case();
    if (c.layers.size() == most_layers) {
        c.layers.pop_back();
    }
    const LayerValues coat = layer_of(SpecularModel::blinn_phong, {0.04, 0.0, 0.5}, 300.0);
    for (const FresnelModel fresnel : all_fresnel_models) {
        const Reflected without = c.reflected(c.layers, fresnel, AbsorptionModel::none);
        for (std::size_t at = 0; at < c.layers.size(); ++at) {
            std::vector<LayerValues> more = c.layers;
            more.insert(more.begin() + static_cast<std::ptrdiff_t>(at), coat);
            const Reflected with = c.reflected(more, fresnel, AbsorptionModel::none);
            // A metal's spectrum is summed once for three equal channels and channel by channel for others.
            RC_ASSERT(std::abs(with.diffuse.y - without.diffuse.y) <= 1e-14 * without.diffuse.y + 1e-300);
            RC_ASSERT(std::abs(with.specular.y - without.specular.y) <= 1e-14 * without.specular.y + 1e-300);
        }
    }
}

RC_GTEST_PROP(Stack, ALayerOfTheIndexAboveItReflectsNothing, ()) {
    // Zero contrast: the second of two equal dielectrics is not there (models.md section 5: n2 = n1 gives F_b = 0).
    RandomCase c = random_case();
    c.layers.resize(std::min(c.layers.size(), most_layers - 1));
    LayerValues coat = c.random.layer(SpecularModel::blinn_phong_exact);
    c.layers.front() = coat;
    if (c.layers.size() == 1) {
        c.layers.push_back(c.random.layer(SpecularModel::blinn_phong));
    }
    std::vector<LayerValues> more = c.layers;
    coat.shininess = 3.0;
    more.insert(more.begin() + 1, coat);
    for (const FresnelModel fresnel : all_fresnel_models) {
        expect_same_bits(c.reflected(more, fresnel, AbsorptionModel::none),
                         c.reflected(c.layers, fresnel, AbsorptionModel::none));
    }
}

TEST(Stack, OneLayerIsTheSingleLayerModel) {
    const Angles a = vector_angles(40.0, 55.0, 150.0);
    const glm::dvec3 f0(0.04, 0.3, 1.0);
    const glm::dvec3 rho(0.2, 0.5, 0.9);
    const auto single = [&](SpecularModel model, FresnelModel fresnel) {
        return reflect(
            stack_of({layer_of(model, f0, 20.0)}, fresnel, AbsorptionModel::none, DiffuseModel::lambert, rho), a);
    };
    const Reflected approximated = single(SpecularModel::blinn_phong, FresnelModel::constant);
    EXPECT_TRUE(close(approximated.specular, blinn_phong(a, f0, 20.0), 1e-15));
    EXPECT_TRUE(close(approximated.diffuse, lambert(a, rho) * diffuse_weight(f0), 1e-15));
    const Reflected exact_form = single(SpecularModel::blinn_phong_exact, FresnelModel::constant);
    EXPECT_TRUE(close(exact_form.specular, blinn_phong_exact(a, f0, 20.0), 1e-15));
    EXPECT_TRUE(close(exact_form.diffuse, lambert(a, rho) * diffuse_weight_exact(a, f0), 1e-15));
    const Reflected none = single(SpecularModel::none, FresnelModel::constant);
    EXPECT_EQ(none.diffuse, lambert(a, rho));
    EXPECT_EQ(none.specular, glm::dvec3(0.0));
    // fresnel = exact: the dielectric formula for n = (1 + sqrt F0)/(1 - sqrt F0), the exact normaliser, 1 - F below.
    for (const SpecularModel model : {SpecularModel::blinn_phong, SpecularModel::blinn_phong_exact}) {
        const Reflected exact = single(model, FresnelModel::exact);
        for (int i = 0; i < 3; ++i) {
            const double f = f0[i] == 1.0 ? 1.0 : fresnel_dielectric(index_of_f0(f0[i]), a.eh);
            EXPECT_NEAR(exact.specular[i], normaliser_exact(20.0) * lobe(a, 20.0) * std::min(1.0, a.nl / a.ne) * f,
                        1e-15);
            EXPECT_NEAR(exact.diffuse[i], lambert(a, rho)[i] * (1.0 - f), 1e-15);
        }
    }
}

TEST(Stack, MetalsReflectTheirSpectrum) {
    StackGenerator random(1);
    const Angles a = vector_angles(60.0, 65.0, 170.0);
    const LayerValues metal = random.layer(SpecularModel::blinn_phong_spectral);
    const double attenuated_lobe = lobe(a, metal.shininess) * attenuated_cosine(a);
    // Alone: R(E.H) in place of F, linear normaliser, 1 - R(1) left to a diffuse part.
    const Reflected alone = reflect(
        stack_of({metal}, FresnelModel::constant, AbsorptionModel::none, DiffuseModel::lambert, glm::dvec3(1.0)), a);
    EXPECT_TRUE(close(alone.specular,
                      normaliser_linear(metal.shininess) * attenuated_lobe * metal.metal->reflectance(a.eh), 1e-14));
    EXPECT_TRUE(close(alone.diffuse, lambert(a, glm::dvec3(1.0)) * (1.0 - metal.metal->f0()), 1e-14));
    // Under a coat of index 1.5: R at normal incidence against it; or at the refracted angle.
    const LayerValues coat = layer_of_index(SpecularModel::blinn_phong_exact, 1.5, 64.0);
    const glm::dvec3 f = schlick(glm::dvec3(0.04), a.eh);
    EXPECT_TRUE(close(specular_of_layer(stack_of({coat, metal}, FresnelModel::constant), a, 1),
                      normaliser_linear(metal.shininess) * attenuated_lobe * (1.0 - f) * 0.96 *
                          metal.metal->reflectance(glm::dvec3(1.5), glm::dvec3(1.0)),
                      1e-12));
    const double entering = 1.0 - fresnel_dielectric(1.5, a.eh);
    EXPECT_TRUE(close(specular_of_layer(stack_of({coat, metal}, FresnelModel::exact), a, 1),
                      normaliser_exact(metal.shininess) * attenuated_lobe * entering * entering *
                          metal.metal->reflectance(glm::dvec3(1.5), glm::dvec3(refracted_cosine(a.eh, 1.5))),
                      1e-12));
}

TEST(Stack, ThreeLayersAsWrittenDown) {
    const Angles a = vector_angles(50.0, 40.0, 120.0);
    const std::array<double, 3> n{1.33, 1.8, 1.4};
    std::vector<LayerValues> layers{layer_of_index(SpecularModel::blinn_phong_exact, n[0], 30.0),
                                    layer_of_index(SpecularModel::blinn_phong_exact, n[1], 30.0),
                                    layer_of_index(SpecularModel::blinn_phong_exact, n[2], 30.0)};
    layers[0].absorption = glm::dvec3(0.1);
    layers[1].absorption = glm::dvec3(0.07);
    const double r0 = f0_between(1.0, n[0]);
    const double r1 = f0_between(n[0], n[1]);
    const double r2 = f0_between(n[1], n[2]);
    const double bare = normaliser_exact(30.0) * lobe(a, 30.0) * attenuated_cosine(a);
    {
        const MaterialValues m = stack_of(layers, FresnelModel::constant, AbsorptionModel::approximated,
                                          DiffuseModel::lambert, glm::dvec3(1.0));
        const double f0 = schlick(glm::dvec3(r0), a.eh).x;
        const double a0 = 1.0 - 0.1 * (1.0 / a.nl + 1.0 / a.ne);
        const double a1 = 1.0 - 0.07 * (1.0 / a.nl + 1.0 / a.ne);
        EXPECT_NEAR(specular_of_layer(m, a, 0).x, bare * f0, 1e-15);
        EXPECT_NEAR(specular_of_layer(m, a, 1).x, bare * r1 * (1.0 - f0) * (1.0 - r0) * a0, 1e-15);
        EXPECT_NEAR(specular_of_layer(m, a, 2).x,
                    bare * r2 * (1.0 - f0) * (1.0 - r0) * (1.0 - r1) * (1.0 - r1) * a0 * a1, 1e-15);
        EXPECT_NEAR(reflect(m, a).diffuse.x,
                    a.nl / std::numbers::pi * (1.0 - f0) * (1.0 - r1 * (1.0 - r0)) *
                        (1.0 - r2 * (1.0 - r0) * (1.0 - r1)) * a0 * a1,
                    1e-15);
    }
    {
        const MaterialValues m =
            stack_of(layers, FresnelModel::exact, AbsorptionModel::original, DiffuseModel::lambert, glm::dvec3(1.0));
        const double f0 = fresnel_dielectric(n[0], a.eh);
        const double f1 = fresnel_dielectric(n[1] / n[0], refracted_cosine(a.eh, n[0]));
        const double f2 = fresnel_dielectric(n[2] / n[1], refracted_cosine(a.eh, n[1]));
        const double a0 = std::exp(-0.1 * (1.0 / refracted_cosine(a.nl, n[0]) + 1.0 / refracted_cosine(a.ne, n[0])));
        const double a1 = std::exp(-0.07 * (1.0 / refracted_cosine(a.nl, n[1]) + 1.0 / refracted_cosine(a.ne, n[1])));
        const double through0 = (1.0 - f0) * (1.0 - f0);
        const double through1 = (1.0 - f1) * (1.0 - f1);
        EXPECT_NEAR(specular_of_layer(m, a, 0).x, bare * f0, 1e-15);
        EXPECT_NEAR(specular_of_layer(m, a, 1).x, bare * f1 * through0 * a0, 1e-15);
        EXPECT_NEAR(specular_of_layer(m, a, 2).x, bare * f2 * through0 * through1 * a0 * a1, 1e-15);
        EXPECT_NEAR(reflect(m, a).diffuse.x, a.nl / std::numbers::pi * through0 * through1 * (1.0 - f2) * a0 * a1,
                    1e-15);
    }
}

RC_GTEST_PROP(Stack, ExactEqualsConstantAtNormalIncidence, ()) {
    // E = L: E.H = 1, at any angle to N. Lobes and normalisers aside.
    RandomCase c = random_case();
    const Angles a = unclamped_angles(c.eye, c.eye);
    const MaterialValues constant = c.stack(c.layers, FresnelModel::constant, AbsorptionModel::original);
    const MaterialValues exact = c.stack(c.layers, FresnelModel::exact, AbsorptionModel::original);
    const StackWeights one = stack_weights(constant, a);
    const StackWeights other = stack_weights(exact, a);
    bool gaussian = false; // an outer blinn_phong so far: its weight at c = 1 is 1.7e-4 instead of 0
    for (std::size_t k = 0; k < c.layers.size(); ++k) {
        gaussian |= c.layers[k].specular == SpecularModel::blinn_phong;
        // F0 down to 1e-3 passes through n: sqrt(F0) = (n-1)/(n+1) loses 1/30 of a digit; contrasts between layers may
        // be smaller still, hence an absolute part.
        RC_ASSERT(close(one.specular[k], other.specular[k], gaussian ? 1e-3 : 1e-12, gaussian ? 1.7e-4 : 1e-14));
    }
}

RC_GTEST_PROP(Stack, VanishingAbsorptionIsNone, ()) {
    RandomCase c = random_case();
    for (const FresnelModel fresnel : all_fresnel_models) {
        const Reflected none = c.reflected(c.layers, fresnel, AbsorptionModel::none);
        for (const AbsorptionModel absorption : {AbsorptionModel::approximated, AbsorptionModel::original}) {
            std::vector<LayerValues> layers = c.layers;
            for (LayerValues& layer : layers) {
                layer.absorption = glm::dvec3(0.0);
            }
            expect_same_bits(c.reflected(layers, fresnel, absorption), none);
            for (LayerValues& layer : layers) {
                layer.absorption = glm::dvec3(1e-9);
            }
            // at most 7 layers, 1/NL + 1/NE at most 2000
            const Reflected little = c.reflected(layers, fresnel, absorption);
            RC_ASSERT(close(little.diffuse, none.diffuse, 7.0 * 2000.0 * 1.01e-9, 1e-18));
            RC_ASSERT(close(little.specular, none.specular, 7.0 * 2000.0 * 1.01e-9, 1e-18));
        }
    }
}

TEST(Absorption, OriginalInAMediumOfIndexOneIsTheUnrefractedExponential) {
    const glm::dvec3 alpha_d(0.0, 0.05, 0.5);
    const glm::dvec3 a = absorption_original(alpha_d, glm::dvec3(1.0), 0.3, 0.6);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(a[i], std::exp(-alpha_d[i] * (1.0 / 0.3 + 1.0 / 0.6)), 1e-15);
    }
    EXPECT_EQ(a.x, 1.0);
}

TEST(Absorption, ApproximatedIsTangentToTheExponentialAndClamped) {
    // models.md section 5: a' = alpha d to first order; 0 from NL NE/(NL + NE) <= a' on.
    const double slope = (1.0 - absorption_approximated(glm::dvec3(1e-6), 0.3, 0.6).x) / 1e-6;
    EXPECT_NEAR(slope, (1.0 - absorption_original(glm::dvec3(1e-6), glm::dvec3(1.0), 0.3, 0.6).x) / 1e-6, 2e-5);
    EXPECT_EQ(absorption_approximated(glm::dvec3(0.2), 0.3, 0.6).x, 0.0);
    EXPECT_GT(absorption_approximated(glm::dvec3(0.1999), 0.3, 0.6).x, 0.0);
    EXPECT_EQ(absorption_approximated(glm::dvec3(std::numeric_limits<double>::infinity()), 0.3, 0.6).x, 0.0);
    EXPECT_EQ(absorption_original(glm::dvec3(std::numeric_limits<double>::infinity()), glm::dvec3(1.5), 0.3, 0.6).x,
              0.0);
}

TEST(Stack, AMediumWithoutAnInterfaceAbsorbs) {
    // A coat with lobe `none` over a base: only A, refracted by what lies above it (air).
    const Angles a = vector_angles(40.0, 55.0, 150.0);
    LayerValues tint = layer_of(SpecularModel::none, glm::dvec3(0.0), 0.0);
    tint.absorption = {0.0, 0.1, 0.3};
    const LayerValues base = layer_of(SpecularModel::blinn_phong_exact, glm::dvec3(0.04), 20.0);
    const LayerValues coat = layer_of_index(SpecularModel::blinn_phong, 1.5, 20.0);
    const auto diffuse_of = [&](const std::vector<LayerValues>& layers, AbsorptionModel model) {
        return reflect(stack_of(layers, FresnelModel::constant, model, DiffuseModel::lambert, glm::dvec3(1.0)), a)
            .diffuse;
    };
    const glm::dvec3 bare = diffuse_of({base}, AbsorptionModel::none);
    EXPECT_TRUE(close(diffuse_of({tint, base}, AbsorptionModel::original),
                      bare * absorption_original(tint.absorption, glm::dvec3(1.0), a.nl, a.ne), 1e-15));
    EXPECT_TRUE(close(diffuse_of({tint, base}, AbsorptionModel::approximated),
                      bare * absorption_approximated(tint.absorption, a.nl, a.ne), 1e-15));
    EXPECT_TRUE(close(diffuse_of({coat, tint, base}, AbsorptionModel::original),
                      diffuse_of({coat, base}, AbsorptionModel::none) *
                          absorption_original(tint.absorption, glm::dvec3(1.5), a.nl, a.ne),
                      1e-15));
}

TEST(Stack, NothingIsSeenBelowAMirror) {
    StackGenerator random(3);
    for (const FresnelModel fresnel : all_fresnel_models) {
        const LayerValues mirror = layer_of(SpecularModel::blinn_phong_exact, {1.0, 0.04, 1.0}, 50.0);
        for (const SpecularModel below : {SpecularModel::blinn_phong, SpecularModel::blinn_phong_spectral}) {
            for (const glm::dvec3& f0 : {glm::dvec3(1.0), glm::dvec3(0.0), glm::dvec3(0.5)}) {
                LayerValues base = random.layer(below);
                if (base.metal == nullptr) {
                    base = layer_of(below, f0, 20.0);
                }
                const MaterialValues m = stack_of({mirror, mirror, base}, fresnel, AbsorptionModel::original,
                                                  DiffuseModel::lambert, glm::dvec3(1.0));
                const Angles a = vector_angles(40.0, 55.0, 150.0);
                const Reflected r = reflect(m, a);
                EXPECT_EQ(r.diffuse.x, 0.0);
                EXPECT_EQ(r.diffuse.z, 0.0);
                EXPECT_EQ(r.specular.x, specular_of_layer(m, a, 0).x);
                EXPECT_EQ(r.specular.z, specular_of_layer(m, a, 0).z);
                EXPECT_GT(r.specular.x, 0.0);
                EXPECT_TRUE(std::isfinite(r.specular.y) && std::isfinite(r.diffuse.y));
            }
        }
    }
}

// Reciprocity and energy -------------------------------------------------------------------------------------------

RC_GTEST_PROP(Stack, IsReciprocal, ()) {
    RandomCase c = random_case();
    const Angles& a = c.angles;
    const Angles b = unclamped_angles(c.light, c.eye);
    for (const FresnelModel fresnel : all_fresnel_models) {
        for (const AbsorptionModel absorption : all_absorption_models) {
            const MaterialValues m = c.stack(c.layers, fresnel, absorption);
            const Reflected forth = reflect(m, a);
            const Reflected back = reflect(m, b);
            // f_r = f_cos / NL, cross-multiplied. Exponents up to 65536 magnify a rounding of N.H; 1 - A near A = 0 and
            // 1 - E.H near 1 cancel and leave 1e-16 of the lobe's peak (2607): 3e-13.
            RC_ASSERT(close(forth.specular * b.nl, back.specular * a.nl, 1e-10, 1e-12));
            // The exact form's own weight 1 - F(N.L) is not reciprocal (models.md section 1); it holds for an outer
            // base.
            const LayerValues& base = m.base();
            const bool one_sided = fresnel == FresnelModel::constant && glm::any(base.interface.outer) &&
                                   base.specular == SpecularModel::blinn_phong_exact;
            RC_ASSERT(one_sided || close(forth.diffuse * b.nl, back.diffuse * a.nl, 1e-12, 1e-14));
        }
    }
}

RC_GTEST_PROP(Stack, SharesNeverAddUpToMoreThanOne, ()) {
    // host/reference/layers.h, "Energy": exact always; constant where the base is not outer.
    RandomCase c = random_case();
    for (const FresnelModel fresnel : all_fresnel_models) {
        const MaterialValues m = c.stack(c.layers, fresnel, AbsorptionModel::none);
        const StackWeights weights = stack_weights(m, c.angles);
        glm::dvec3 sum = weights.diffuse;
        for (std::size_t k = 0; k < c.layers.size(); ++k) {
            sum += weights.specular[k];
            RC_ASSERT(glm::all(glm::greaterThanEqual(weights.specular[k], glm::dvec3(0.0))));
        }
        RC_ASSERT(glm::all(glm::greaterThanEqual(weights.diffuse, glm::dvec3(0.0))));
        for (int i = 0; i < 3; ++i) {
            const bool single = fresnel == FresnelModel::constant && m.base().interface.outer[i];
            // 1e-14: a few dozen roundings of numbers below 1
            RC_ASSERT(single || sum[i] <= 1.0 + 1e-14);
        }
    }
}

RC_GTEST_PROP(Stack, AbsorptionOnlyTakes, ()) {
    RandomCase c = random_case();
    for (const FresnelModel fresnel : all_fresnel_models) {
        const Reflected none = c.reflected(c.layers, fresnel, AbsorptionModel::none);
        for (const AbsorptionModel absorption : {AbsorptionModel::approximated, AbsorptionModel::original}) {
            const Reflected r = c.reflected(c.layers, fresnel, absorption);
            RC_ASSERT(glm::all(glm::lessThanEqual(r.diffuse, none.diffuse)));
            RC_ASSERT(glm::all(glm::lessThanEqual(r.specular, none.specular)));
            RC_ASSERT(glm::all(glm::greaterThanEqual(r.diffuse, glm::dvec3(0.0))));
            RC_ASSERT(glm::all(glm::greaterThanEqual(r.specular, glm::dvec3(0.0))));
        }
    }
}

} // namespace
} // namespace clshade::reference
