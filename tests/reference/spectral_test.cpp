// Metals of section 4.
#include "host/reference/fresnel.h"
#include "host/reference/spectral.h"
#include "host/scene/metal_table.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace clshade::reference {
namespace {

SpectralMetal metal_named(const char* name) {
    return SpectralMetal(built_in_metal(name).value());
}

SpectralMetal flat_metal(double n, double k) {
    return SpectralMetal(Metal{"flat", {{380.0, n, k}, {780.0, n, k}}});
}

void expect_all_near(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance) {
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(actual[i], expected[i], tolerance) << "channel " << i;
    }
}

TEST(Spectral, TableOfGoldAndCopper) {
    struct Row {
        double c;
        glm::dvec3 gold;
        glm::dvec3 copper;
    };
    const std::array<Row, 8> table{{{1.0, {0.992972, 0.789365, 0.339119}, {0.932747, 0.639722, 0.533257}},
                                    {0.8, {0.991327, 0.788969, 0.34267}, {0.931363, 0.638701, 0.533526}},
                                    {0.6, {0.985514, 0.789968, 0.358444}, {0.927281, 0.63772, 0.537384}},
                                    {0.4, {0.975092, 0.801772, 0.405377}, {0.923168, 0.648385, 0.559141}},
                                    {0.2, {0.969447, 0.854396, 0.54595}, {0.935588, 0.719224, 0.653529}},
                                    {0.1, {0.978983, 0.914054, 0.707193}, {0.961375, 0.819763, 0.776673}},
                                    {0.05, {0.988474, 0.95432, 0.832093}, {0.980135, 0.89866, 0.873285}},
                                    {0.0, {1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}}}};
    const SpectralMetal gold = metal_named("gold");
    const SpectralMetal copper = metal_named("copper");
    for (const Row& row : table) { // printed to six decimals
        expect_all_near(gold.reflectance(row.c), row.gold, 0.5001e-6);
        expect_all_near(copper.reflectance(row.c), row.copper, 0.5001e-6);
    }
    EXPECT_EQ(gold.f0(), gold.reflectance(1.0));
}

TEST(Spectral, SchlickIsOffByAsMuchAsPublished) {
    double largest = 0.0;
    for (const char* name : {"gold", "copper"}) {
        const SpectralMetal metal = metal_named(name);
        for (int i = 0; i <= 1000; ++i) {
            const glm::dvec3 error = glm::abs(metal.reflectance(i / 1000.0) - schlick(metal.f0(), i / 1000.0));
            largest = std::max({largest, error.x, error.y, error.z});
        }
    }
    EXPECT_NEAR(largest, 0.0390, 0.5e-4); // "at most 0.0390"
}

TEST(Spectral, FlatSpectrumIsGreyAndTheConductorItself) {
    const SpectralMetal metal = flat_metal(0.4, 2.5);
    for (const double c : {0.0, 0.1, 0.6, 1.0}) {
        expect_all_near(metal.reflectance(c), glm::dvec3(fresnel_conductor(0.4, 2.5, c)), 1e-14);
    }
}

TEST(Spectral, SeenFromAMediumTheIndexIsRelative) {
    const SpectralMetal metal = flat_metal(0.4, 2.5);
    const glm::dvec3 medium(1.0, 1.5, 2.0);
    const glm::dvec3 cosine(0.3, 0.6, 0.9);
    const glm::dvec3 reflectance = metal.reflectance(medium, cosine);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(reflectance[i], fresnel_conductor(0.4 / medium[i], 2.5 / medium[i], cosine[i]), 1e-14);
    }
    // One channel's result does not depend on the others'.
    const SpectralMetal gold = metal_named("gold");
    const glm::dvec3 grey = gold.reflectance(glm::dvec3(1.5), glm::dvec3(0.6));
    EXPECT_NEAR(gold.reflectance(medium, cosine).y, grey.y, 1e-15);
    EXPECT_GT(std::abs(grey.z - gold.reflectance(0.6).z), 0.05); // and the medium matters
}

TEST(Spectral, IndicesArePiecewiseLinearAndClamped) {
    const Metal metal{"test", {{400.0, 1.0, 2.0}, {500.0, 2.0, 4.0}, {600.0, 2.0, 0.0}}};
    const auto expect_index = [&](double nm, double n, double k) {
        EXPECT_NEAR(index_at(metal, nm).n, n, 1e-14) << nm;
        EXPECT_NEAR(index_at(metal, nm).k, k, 1e-14) << nm;
    };
    expect_index(380.0, 1.0, 2.0);
    expect_index(400.0, 1.0, 2.0);
    expect_index(425.0, 1.25, 2.5);
    expect_index(500.0, 2.0, 4.0);
    expect_index(575.0, 2.0, 1.0);
    expect_index(600.0, 2.0, 0.0);
    expect_index(780.0, 2.0, 0.0);
}

TEST(Spectral, EightyOneWavelengths) {
    EXPECT_EQ(wavelength(0), 380.0);
    EXPECT_EQ(wavelength(wavelength_count - 1), 780.0);
}

TEST(Spectral, SaturatedSpectraAreClamped) {
    // Reflects around 500 nm alone: a green outside sRGB, with red below 0.
    Metal metal{"emerald", {{380.0, 1.0, 0.0}, {490.0, 1.0, 0.0}, {495.0, 0.1, 5.0}, {510.0, 0.1, 5.0}}};
    metal.samples.push_back({515.0, 1.0, 0.0});
    metal.samples.push_back({780.0, 1.0, 0.0});
    const glm::dvec3 f0 = SpectralMetal(metal).f0();
    EXPECT_EQ(f0.x, 0.0);
    EXPECT_GT(f0.y, 0.05);
}

} // namespace
} // namespace clshade::reference
