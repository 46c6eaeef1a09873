// The generated code as a text: what stands in kernels/, what is shared, what is folded.
#include "host/base/error.h"
#include "host/reference/spectral.h"
#include "host/scene/metal_table.h"
#include "host/shading/code_value.h"
#include "host/shading/layer_constants.h"
#include "host/shading/material_code.h"
#include "host/shading/metal_curve.h"
#include "tests/shading/agreement.h"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>
#include <string>

namespace clshade {
namespace {

using testing::HasSubstr;
using testing::Not;

BoundParameter planes(int first, int count) {
    BoundParameter parameter;
    parameter.planes = {first, first + (count > 1 ? 1 : 0), first + (count > 1 ? 2 : 0)};
    return parameter;
}

BoundParameter constant(double value) {
    BoundParameter parameter;
    parameter.constant = glm::dvec3(value);
    return parameter;
}

/// The frame that the defaults in kernels/ describe, under two lights.
Frame default_frame() {
    Frame frame;
    frame.plane_names = {"N.X",      "N.Y",      "N.Z",  "P.X",  "P.Y",  "P.Z",      "albedo.R",
                         "albedo.G", "albedo.B", "f0.R", "f0.G", "f0.B", "shininess"};
    frame.roles.normal = {0, 1, 2};
    frame.roles.position = {3, 4, 5};
    frame.lights.resize(2);
    BoundMaterial material;
    material.name = "default";
    material.base().specular = SpecularModel::blinn_phong;
    material.base().f0 = planes(9, 3);
    material.base().shininess = planes(12, 1);
    material.diffuse = DiffuseModel::lambert;
    material.albedo = planes(6, 3);
    frame.materials = {material};
    return frame;
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

TEST(GeneratedSource, TheFileInKernelsIsWhatIsWrittenForItsFrame) {
    std::ifstream file(std::string(CLSHADE_SOURCE_DIR) + "/kernels/materials.cl");
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_EQ(text.str(), materials_source(default_frame()).text) << "copy it from clshade shade --dump-kernel";
}

BoundMaterial eight_layers() {
    BoundMaterial material = default_frame().materials[0];
    for (int k = 0; k < 7; ++k) {
        BoundLayer coat;
        coat.specular = SpecularModel::blinn_phong;
        coat.f0 = constant(0.03 + 0.01 * k);
        coat.shininess = constant(100.0 + k);
        coat.absorption = constant(0.01);
        material.layers.insert(material.layers.begin(), coat);
    }
    material.absorption = AbsorptionModel::approximated;
    return material;
}

TEST(GeneratedSource, SharedExpressionsStandOnceHoweverManyLobesNeedThem) {
    Frame frame = default_frame();
    frame.materials = {eight_layers()};
    const std::string text = materials_source(frame).text;
    EXPECT_EQ(count_of(text, "cosine_power(i,"), 8U);
    EXPECT_EQ(count_of(text, "schlick_weight_gaussian(i)"), 1U);
    EXPECT_EQ(count_of(text, "straight_path(i, s)"), 1U);
    EXPECT_EQ(count_of(text, "incidence_of("), 1U);
}

TEST(GeneratedSource, ConstantsAreFoldedAndUnusedPartsLeftOut) {
    Frame frame = default_frame();
    BoundMaterial& material = frame.materials[0];
    material.base().f0 = constant(0.04);
    material.base().shininess = constant(512.0);
    const std::string text = materials_source(frame).text;
    EXPECT_THAT(text, HasSubstr("cosine_power(i, splat(256.0f))"));
    // norm (F0 + (1 - F0) weight), the norm multiplied in
    EXPECT_THAT(text, HasSubstr(float_literal(0.04 * folded_normaliser_linear(512.0)) + " + " +
                                float_literal(0.96 * folded_normaliser_linear(512.0)) + " * weight"));
    EXPECT_THAT(text, Not(HasSubstr("normaliser_linear")));
    EXPECT_THAT(text, Not(HasSubstr("absorption")));
}

TEST(GeneratedSource, NoLineIsWiderThanAPersonWouldWrite) {
    Frame frame = default_frame();
    BoundMaterial second = eight_layers();
    second.ids = {1, 2, 3};
    frame.materials.push_back(second);
    frame.plane_names.emplace_back("id");
    frame.roles.material_id = 13;
    std::istringstream lines(materials_source(frame).text);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(line.size(), 140U) << line;
    }
}

TEST(MetalCurve, IsTheReferencesSpectralSumToAMillionth) {
    for (const char* name : {"gold", "copper"}) {
        const Metal metal = *built_in_metal(name);
        const MetalCurve curve = fit_metal_curve(metal, {});
        EXPECT_LE(curve.error, 1e-6) << name;
        const reference::SpectralMetal truth(metal);
        for (int i = 0; i <= 1000; ++i) {
            const double c = i / 1000.0;
            const double x = 2.0 * (1.0 + curve.bend) * c / (c + curve.bend) - 1.0;
            glm::dvec3 value(0.0);
            for (auto k = curve.coefficients.rbegin(); k != curve.coefficients.rend(); ++k) {
                value = value * x + *k;
            }
            const glm::dvec3 expected = truth.reflectance(c);
            for (int channel = 0; channel < 3; ++channel) {
                EXPECT_NEAR(value[channel], expected[channel], 1e-6) << name << " at " << c;
            }
        }
    }
}

Frame frame_of_metal(std::vector<ComplexIndex> samples) {
    Frame frame = default_frame();
    frame.materials[0].base().specular = SpecularModel::blinn_phong_spectral;
    frame.materials[0].base().f0 = BoundParameter{};
    frame.materials[0].base().metal = {"odd.txt", std::move(samples)};
    return frame;
}

TEST(MetalCurve, RefusesASpectrumThatNoPolynomialFollows) {
    // An index below 1 that does not absorb reflects totally beyond its critical angle.
    EXPECT_THAT(
        [] {
            (void)materials_source(frame_of_metal({{300.0, 0.5, 0.0}, {800.0, 0.5, 0.0}}));
        },
        testing::ThrowsMessage<UsageError>(HasSubstr("odd.txt")));
}

TEST(MetalCurve, WarnsWhereTheFitIsNotExact) {
    const MaterialsSource source = materials_source(frame_of_metal({{300.0, 0.9, 0.06}, {800.0, 0.9, 0.06}}));
    ASSERT_EQ(source.warnings.size(), 1U);
    EXPECT_THAT(source.warnings[0], HasSubstr("odd.txt"));
    EXPECT_TRUE(materials_source(frame_of_metal({{300.0, 0.2, 3.0}, {800.0, 0.2, 5.0}})).warnings.empty());
}

} // namespace
} // namespace clshade
