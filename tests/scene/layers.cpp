// Stacks, lobes and claims of correct scenes.
#include "tests/scene/support.h"

namespace clshade {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Material only_material(const std::string& text) {
    return parse(head + text).materials.at(0);
}

TEST(Stack, IsReadTopFirst) {
    const Scene scene = parse(head + R"([material.car_paint]
ids = [3, 7]
names = ["body", "door"]
fresnel = "exact"
absorption_model = "original"
[[material.car_paint.layer]]
specular = { model = "blinn_phong_exact", ior = 1.5, shininess = 512 }
absorption = [0.02, 0.05, 0.10]
[[material.car_paint.layer]]
absorption = { channel = "tint", scale = 0.5, offset = 0.1 }
[[material.car_paint.layer]]
specular = { model = "blinn_phong", ior = 2.0, shininess = "gloss" }
diffuse  = { model = "lambert", albedo = "albedo" }
)");
    ASSERT_EQ(scene.materials.size(), 2U);
    const Material& paint = scene.materials[1];
    EXPECT_THAT(paint.ids, ElementsAre(3, 7));
    EXPECT_THAT(paint.names, ElementsAre("body", "door"));
    EXPECT_EQ(paint.names_where.line, 6);
    EXPECT_EQ(paint.fresnel, FresnelModel::exact);
    EXPECT_EQ(paint.absorption_model, AbsorptionModel::original);
    ASSERT_EQ(paint.layers.size(), 3U);
    EXPECT_EQ(paint.layers[0].specular.model, SpecularModel::blinn_phong_exact);
    EXPECT_NEAR(paint.layers[0].specular.f0.constant.x, 0.04, 1e-15); // (0.5 / 2.5)^2, to rounding
    EXPECT_EQ(paint.layers[0].absorption.constant, glm::dvec3(0.02, 0.05, 0.10));
    EXPECT_EQ(paint.layers[0].where.line, 9);
    EXPECT_EQ(paint.layers[1].specular.model, SpecularModel::none);
    EXPECT_THAT(paint.layers[1].absorption.channels, ElementsAre("tint"));
    EXPECT_EQ(paint.layers[1].absorption.scale, 0.5);
    EXPECT_EQ(paint.layers[1].absorption.offset, 0.1);
    EXPECT_EQ(paint.layers[1].absorption.convert, Conversion::none);
    EXPECT_NEAR(paint.base().f0.constant.y, 1.0 / 9.0, 1e-15);
    EXPECT_THAT(paint.base().shininess.channels, ElementsAre("gloss"));
    EXPECT_EQ(paint.layers[2].absorption.constant, glm::dvec3(0.0));
    EXPECT_TRUE(paint.layers[2].absorption.is_constant());
    EXPECT_EQ(paint.diffuse.model, DiffuseModel::lambert);
}

TEST(Stack, OfOneIsTheMaterialItself) {
    const std::string lobes = "specular = { f0 = 0.2, shininess = 9 }\ndiffuse = { albedo = 0.3 }\n";
    const Material straight = only_material("[material.default]\n" + lobes);
    const Material layered = only_material("[[material.default.layer]]\n" + lobes);
    for (const Material& material : {straight, layered}) {
        ASSERT_EQ(material.layers.size(), 1U);
        EXPECT_EQ(material.fresnel, FresnelModel::constant);
        EXPECT_EQ(material.absorption_model, AbsorptionModel::approximated);
        EXPECT_EQ(material.base().f0.constant.x, 0.2);
        EXPECT_EQ(material.base().shininess.constant.x, 9.0);
        EXPECT_EQ(material.diffuse.albedo.constant.x, 0.3);
        EXPECT_EQ(material.layers[0].absorption.constant, glm::dvec3(0.0));
    }
}

TEST(Stack, HasUpToEightLayersOfAnyLobe) {
    std::string text;
    for (const char* lobe : {"{}", "{ model = 'none' }", "{ model = 'blinn_phong_exact' }",
                             "{ model = 'blinn_phong_spectral', metal = 'gold' }",
                             "{ model = 'blinn_phong_anisotropic', shininess_u = 3, shininess_v = 5 }", "{ ior = 1 }",
                             "{ f0 = 0 }", "{ model = 'blinn_phong_spectral', metal = 'copper', shininess = 7 }"}) {
        text += std::string("[[material.default.layer]]\nspecular = ") + lobe + "\n";
    }
    const Material material = only_material(text);
    ASSERT_EQ(material.layers.size(), 8U);
    EXPECT_EQ(material.layers[0].specular.model, SpecularModel::blinn_phong);
    EXPECT_EQ(material.layers[1].specular.model, SpecularModel::none);
    EXPECT_EQ(material.layers[3].specular.metal.name, "gold");
    EXPECT_EQ(material.layers[4].specular.shininess_u.constant.x, 3.0);
    EXPECT_EQ(material.layers[4].specular.shininess_v.constant.x, 5.0);
    EXPECT_EQ(material.base().metal.name, "copper");
    EXPECT_EQ(material.base().shininess.constant.x, 7.0);
    EXPECT_EQ(material.diffuse.model, DiffuseModel::none);
}

TEST(Stack, MayHaveAModelThatItsLayersDoNotUse) {
    // Switching absorption off keeps what was written: that is how the variants are compared.
    const Material material = only_material("[material.default]\nabsorption_model = 'none'\n"
                                            "[[material.default.layer]]\nabsorption = 0.3\n"
                                            "[[material.default.layer]]\ndiffuse = {}\n");
    EXPECT_EQ(material.absorption_model, AbsorptionModel::none);
    EXPECT_EQ(material.layers[0].absorption.constant.x, 0.3);
    EXPECT_EQ(material.base().model, SpecularModel::none);
}

TEST(Stack, NamesOfItsModelsAreTheirTomlNames) {
    for (const auto fresnel : {FresnelModel::constant, FresnelModel::exact}) {
        const std::string key = "fresnel = '" + std::string(name_of(fresnel)) + "'\n";
        EXPECT_EQ(only_material("[material.default]\ndiffuse = {}\n" + key).fresnel, fresnel);
    }
    for (const AbsorptionModel model : all_absorption_models) {
        const std::string key = "absorption_model = '" + std::string(name_of(model)) + "'\n";
        EXPECT_EQ(only_material("[material.default]\ndiffuse = {}\n" + key).absorption_model, model);
    }
}

TEST(Stack, DiffuseOfTheBaseMayTakeItsShininess) {
    const std::string rough = "diffuse.model = 'oren_nayar'\n";
    EXPECT_FALSE(only_material("[material.default]\nspecular = {}\n" + rough).diffuse.shininess.has_value());
    // A shininess without a lobe, and one beside an anisotropic lobe.
    const Material matte = only_material("[material.default]\nspecular = { model = 'none', shininess = 4 }\n" + rough);
    EXPECT_EQ(matte.base().shininess.constant.x, 4.0);
    const Material brushed = only_material("[material.default]\n" + rough +
                                           "diffuse.shininess = 6\nspecular = { model = 'blinn_phong_anisotropic', "
                                           "shininess_u = 1, shininess_v = 2 }\n");
    EXPECT_EQ(brushed.diffuse.shininess->constant.x, 6.0);
}

TEST(Lobes, IorMayComeFromChannels) {
    const Parameter named = only_material("[material.default]\nspecular.ior = 'n'\n").base().f0;
    EXPECT_THAT(named.channels, ElementsAre("n"));
    EXPECT_EQ(named.convert, Conversion::index_of_refraction);
    const Parameter scaled =
        only_material("[material.default]\nspecular.ior = { channel = ['a', 'b', 'c'], scale = 2, offset = 1 }\n")
            .base()
            .f0;
    EXPECT_THAT(scaled.channels, ElementsAre("a", "b", "c"));
    EXPECT_EQ(scaled.scale, 2.0);
    EXPECT_EQ(scaled.offset, 1.0);
    EXPECT_EQ(scaled.convert, Conversion::index_of_refraction);
    EXPECT_EQ(scaled.where.line, 5);
    EXPECT_EQ(only_material("[material.default]\nspecular.ior = [1, 3, 1]\n").base().f0.constant,
              glm::dvec3(0.0, 0.25, 0.0));
}

TEST(Lobes, AnisotropyHasTwoExponentsAndATangent) {
    const auto with = [](const std::string& tangent) {
        return only_material("[material.default]\nspecular = { model = 'blinn_phong_anisotropic', f0 = 0.5, "
                             "shininess_u = 10, shininess_v = { channel = 'r', convert = 'ggx_roughness' }" +
                             tangent + " }\n")
            .base();
    };
    const Specular plain = with("");
    EXPECT_EQ(plain.model, SpecularModel::blinn_phong_anisotropic);
    EXPECT_EQ(plain.f0.constant.x, 0.5);
    EXPECT_EQ(plain.shininess_u.constant.x, 10.0);
    EXPECT_THAT(plain.shininess_v.channels, ElementsAre("r"));
    EXPECT_EQ(plain.shininess_v.convert, Conversion::ggx_roughness);
    EXPECT_FALSE(plain.tangent.has_value());
    EXPECT_EQ(with(", tangent = [0, 0, -2]").tangent->constant, glm::dvec3(0, 0, -1)); // any length
    EXPECT_EQ(with(", tangent = [0, 1e-200, 0]").tangent->constant, glm::dvec3(0, 1, 0));
    const glm::dvec3 slanted = with(", tangent = [3e29, 0, 4e29]").tangent->constant;
    EXPECT_NEAR(slanted.x, 0.6, 1e-15); // to rounding
    EXPECT_NEAR(slanted.z, 0.8, 1e-15);
    EXPECT_THAT(with(", tangent = 'tangent'").tangent->channels, ElementsAre("tangent"));
    EXPECT_THAT(with(", tangent = ['t.x', 't.y', 't.z']").tangent->channels, ElementsAre("t.x", "t.y", "t.z"));
    EXPECT_THAT(with(", tangent = { channel = 'brush' }").tangent->channels, ElementsAre("brush"));
}

TEST(Claims, MayBeNamesAlone) {
    const Scene scene = parse(head + "[material.hat]\nnames = ['hat', 'Hat', 'h\u00fct']\ndiffuse = {}\n");
    EXPECT_THAT(scene.materials.at(1).names, ElementsAre("hat", "Hat", "h\u00fct"));
    EXPECT_THAT(scene.materials.at(1).ids, IsEmpty());
    EXPECT_THAT(scene.materials.at(0).names, IsEmpty());
}

} // namespace
} // namespace clshade
