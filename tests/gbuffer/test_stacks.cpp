// Stacks of layers bound to planes, and their keys.
#include "tests/gbuffer/layouts.h"
#include "tests/gbuffer/plans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace clshade {
namespace {

using ::testing::AllOf;
using testing::automatic_scene;
using testing::blender_layout;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::layer;
using testing::layout_of;
using ::testing::Not;
using testing::plain_scene;
using testing::plan_error;
using testing::plan_of;
using testing::plane_of;

Layer layer_of(SpecularModel model, const Parameter& f0 = Parameter::of(0.04)) {
    Layer made;
    made.specular.model = model;
    made.specular.f0 = f0;
    return made;
}

/// A coat that maps everything it can, over a plain base.
Scene coated_scene() {
    Scene scene = plain_scene();
    Material& material = scene.materials[0];
    material.name = "paint";
    Layer coat = layer_of(SpecularModel::blinn_phong, Parameter::from("f0"));
    coat.specular.shininess = Parameter::from("roughness", Conversion::ggx_roughness);
    coat.absorption = Parameter::from("basecolor");
    material.layers = {coat, layer_of(SpecularModel::blinn_phong_exact, Parameter::of(0.25))};
    return scene;
}

BoundMaterial bound_of(const ImageLayout& layout, const Scene& scene) {
    return plan_of(layout, scene).frame.materials.at(0);
}

TEST(BindStack, EveryLayerHasItsOwnParameters) {
    Scene scene = coated_scene();
    scene.materials[0].fresnel = FresnelModel::exact;
    scene.materials[0].absorption_model = AbsorptionModel::original;
    scene.materials[0].layers[1].specular.shininess = Parameter::from("metallic");
    const FramePlan plan = plan_of(blender_layout(), scene);
    const BoundMaterial& material = plan.frame.materials[0];
    ASSERT_EQ(material.layers.size(), 2U);
    EXPECT_EQ(material.fresnel, FresnelModel::exact);
    EXPECT_EQ(material.absorption, AbsorptionModel::original);
    const BoundLayer& coat = material.layers[0];
    EXPECT_EQ(coat.specular, SpecularModel::blinn_phong);
    EXPECT_EQ(plane_of(plan, coat.f0.planes[1]), "ViewLayer.f0.G");
    EXPECT_EQ(plane_of(plan, coat.shininess.planes[0]), "ViewLayer.roughness.X");
    EXPECT_EQ(coat.shininess.convert, Conversion::ggx_roughness);
    EXPECT_EQ(plane_of(plan, coat.absorption.planes[2]), "ViewLayer.basecolor.B");
    EXPECT_TRUE(coat.absorption.averaged);
    EXPECT_EQ(material.base().specular, SpecularModel::blinn_phong_exact);
    EXPECT_EQ(material.base().f0.constant, glm::dvec3(0.25));
    EXPECT_EQ(plane_of(plan, material.base().shininess.planes[0]), "ViewLayer.metallic.X");
}

TEST(BindStack, TakesTheKeysOfAmbientLight) {
    Scene scene = coated_scene();
    const BoundMaterial plain = bound_of(blender_layout(), scene);
    EXPECT_EQ(plain.absorption_ibl, AmbientAbsorption::deck);
    EXPECT_EQ(plain.transmittance_ibl, AmbientTransmittance::fresnel);
    EXPECT_EQ(plain.ambient, AmbientDiffuse::precise);
    scene.materials[0].absorption_ibl = AmbientAbsorption::exponential;
    scene.materials[0].transmittance_ibl = AmbientTransmittance::none;
    scene.materials[0].diffuse.model = DiffuseModel::oren_nayar;
    scene.materials[0].diffuse.ambient = AmbientDiffuse::order1;
    const BoundMaterial written = bound_of(blender_layout(), scene);
    EXPECT_EQ(written.absorption_ibl, AmbientAbsorption::exponential);
    EXPECT_EQ(written.transmittance_ibl, AmbientTransmittance::none);
    EXPECT_EQ(written.ambient, AmbientDiffuse::order1);
}

TEST(BindStack, MessagesNameTheLayer) {
    Scene scene = coated_scene();
    scene.materials[0].layers[1].specular.shininess = Parameter::from("f0");
    EXPECT_THAT(plan_error(blender_layout(), scene), HasSubstr("material 'paint', layer 2, specular shininess: 'f0'"));
    scene = coated_scene();
    scene.materials[0].layers[0].absorption = Parameter::from("basecolour");
    EXPECT_THAT(plan_error(blender_layout(), scene),
                AllOf(HasSubstr("material 'paint', layer 1, absorption"), HasSubstr("did you mean 'basecolor'?")));
}

TEST(BindStack, AbsorptionIsNoneWhereNothingAbsorbs) {
    Scene scene = coated_scene();
    scene.materials[0].layers[0].absorption = Parameter::of(0.0);
    EXPECT_EQ(bound_of(blender_layout(), scene).absorption, AbsorptionModel::none);
    scene.materials[0].layers[0].absorption = Parameter::of(glm::dvec3(0.0, 0.0, 0.1));
    EXPECT_EQ(bound_of(blender_layout(), scene).absorption, AbsorptionModel::approximated);
    // The medium of the base is no part of the stack.
    scene.materials[0].layers = {layer_of(SpecularModel::blinn_phong)};
    scene.materials[0].layers[0].absorption = Parameter::of(0.5);
    EXPECT_EQ(bound_of(blender_layout(), scene).absorption, AbsorptionModel::none);
    EXPECT_EQ(bound_of(blender_layout(), scene).base().absorption.constant, glm::dvec3(0.0));
}

TEST(BindStack, WithoutAbsorptionItsPlanesAreNotRead) {
    Scene scene = coated_scene();
    EXPECT_THAT(plan_of(blender_layout(), scene).frame.plane_names, Contains("ViewLayer.basecolor.R"));
    scene.materials[0].absorption_model = AbsorptionModel::none;
    const FramePlan plan = plan_of(blender_layout(), scene);
    EXPECT_THAT(plan.frame.plane_names, Not(Contains("ViewLayer.basecolor.R")));
    EXPECT_TRUE(plan.frame.materials[0].layers[0].absorption.is_constant());
    EXPECT_EQ(plan.frame.materials[0].layers[0].absorption.constant, glm::dvec3(0.0));
    EXPECT_EQ(plan.frame.materials[0].absorption, AbsorptionModel::none);
}

TEST(BindStack, ALobeReadsOnlyItsOwnParameters) {
    Scene scene = plain_scene();
    Specular& specular = scene.materials[0].base();
    specular.f0 = Parameter::from("f0");
    specular.shininess = Parameter::from("roughness");
    specular.shininess_u = Parameter::from("metallic");
    specular.shininess_v = Parameter::from("Mist");
    specular.tangent = Parameter::of(glm::dvec3(0.0, 0.0, 1.0));
    specular.metal.name = "gold";
    const auto reads = [&](SpecularModel model) {
        specular.model = model;
        return plan_of(blender_layout(), scene).frame.plane_names;
    };
    EXPECT_THAT(reads(SpecularModel::blinn_phong_exact),
                AllOf(Contains("ViewLayer.f0.R"), Contains("ViewLayer.roughness.X"),
                      Not(Contains("ViewLayer.metallic.X")), Not(Contains("ViewLayer.Mist.Z"))));
    EXPECT_THAT(reads(SpecularModel::blinn_phong_anisotropic),
                AllOf(Contains("ViewLayer.f0.R"), Not(Contains("ViewLayer.roughness.X")),
                      Contains("ViewLayer.metallic.X"), Contains("ViewLayer.Mist.Z")));
    EXPECT_EQ(bound_of(blender_layout(), scene).base().shininess.constant, glm::dvec3(0.0));
    EXPECT_THAT(reads(SpecularModel::blinn_phong_spectral),
                AllOf(Not(Contains("ViewLayer.f0.R")), Contains("ViewLayer.roughness.X"),
                      Not(Contains("ViewLayer.metallic.X"))));
    const BoundLayer spectral = bound_of(blender_layout(), scene).base();
    EXPECT_EQ(spectral.metal.name, "gold");
    EXPECT_EQ(spectral.f0.constant, glm::dvec3(0.0));
    EXPECT_EQ(spectral.tangent.constant, glm::dvec3(0.0));
    reads(SpecularModel::none);
    const BoundLayer none = bound_of(blender_layout(), scene).base();
    EXPECT_EQ(none.f0.constant, glm::dvec3(0.0));
    EXPECT_EQ(none.shininess.constant, glm::dvec3(0.0));
    EXPECT_EQ(none.metal.name, "");
}

TEST(BindStack, AutomaticParametersAreOfTheBaseOnly) {
    Scene scene = automatic_scene();
    Material& material = scene.materials[0];
    material.layers = {layer_of(SpecularModel::blinn_phong), layer_of(SpecularModel::blinn_phong)};
    material.layers[0].specular.shininess = Parameter::of(512.0);
    const FramePlan plan = plan_of(blender_layout(), scene);
    const BoundMaterial& bound = plan.frame.materials[0];
    EXPECT_EQ(bound.layers[0].f0.constant, glm::dvec3(0.04));
    EXPECT_EQ(bound.layers[0].shininess.constant, glm::dvec3(512.0));
    EXPECT_EQ(plane_of(plan, bound.base().f0.planes[0]), "ViewLayer.f0.R");
    EXPECT_EQ(plane_of(plan, bound.base().shininess.planes[0]), "ViewLayer.roughness.X");
    EXPECT_EQ(plane_of(plan, bound.albedo.planes[0]), "ViewLayer.DiffCol.R");
}

TEST(BindStack, AutomaticParametersAreOfTheFirstMaterialOnly) {
    Scene scene = automatic_scene();
    scene.materials.emplace_back();
    scene.materials[1].name = "other";
    scene.materials[1].ids = {1};
    const FramePlan plan = plan_of(blender_layout(), scene);
    EXPECT_TRUE(plan.frame.materials[1].albedo.is_constant());
    EXPECT_TRUE(plan.frame.materials[1].base().f0.is_constant());
}

TEST(BindStack, TheDiffuseShininessIsThatOfTheBase) {
    Scene scene = coated_scene();
    scene.materials[0].diffuse.model = DiffuseModel::oren_nayar;
    scene.materials[0].layers[1].specular.shininess = Parameter::of(12.0);
    EXPECT_EQ(bound_of(blender_layout(), scene).diffuse_shininess.constant, glm::dvec3(12.0));
    scene.materials[0].diffuse.shininess = Parameter::of(7.0);
    EXPECT_EQ(bound_of(blender_layout(), scene).diffuse_shininess.constant, glm::dvec3(7.0));
}

TEST(BindStack, AnIndexOfRefractionBecomesF0) {
    Scene scene = plain_scene();
    Parameter index = Parameter::of(glm::dvec3(0.75, 1.0, 0.5)); // times 2: 1.5, 2 and 1
    index.scale = 2.0;
    index.convert = Conversion::index_of_refraction;
    scene.materials[0].base().f0 = index;
    const glm::dvec3 f0 = bound_of(blender_layout(), scene).base().f0.constant;
    EXPECT_DOUBLE_EQ(f0.x, 0.04); // ((1.5 - 1) / (1.5 + 1))^2, models.md section 5
    EXPECT_DOUBLE_EQ(f0.y, 1.0 / 9.0);
    EXPECT_EQ(f0.z, 0.0);
    index.constant = glm::dvec3(0.25); // 0.5 counts as 1
    scene.materials[0].base().f0 = index;
    EXPECT_EQ(bound_of(blender_layout(), scene).base().f0.constant, glm::dvec3(0.0));
    index = Parameter::from("metallic", Conversion::index_of_refraction);
    scene.materials[0].base().f0 = index;
    EXPECT_EQ(bound_of(blender_layout(), scene).base().f0.convert, Conversion::index_of_refraction);
}

TEST(BindStack, SpectralLayersNeedConstantsAboveThem) {
    Scene scene = plain_scene();
    Material& material = scene.materials[0];
    material.name = "gilt";
    material.layers = {layer_of(SpecularModel::blinn_phong),
                       layer_of(SpecularModel::blinn_phong, Parameter::from("f0")),
                       layer_of(SpecularModel::blinn_phong_spectral), layer_of(SpecularModel::blinn_phong)};
    material.layers[1].where = {"scene.toml", 7, 3};
    EXPECT_THAT(plan_error(blender_layout(), scene),
                AllOf(HasSubstr("scene.toml:7:3: material 'gilt', layer 2: f0 comes from channels"),
                      HasSubstr("layer 3 below it is blinn_phong_spectral")));
    std::swap(material.layers[1], material.layers[3]); // below it anything goes
    EXPECT_EQ(plan_error(blender_layout(), scene), "no error");
    material.layers[0] = layer_of(SpecularModel::none, Parameter::from("f0")); // nobody reads it
    EXPECT_EQ(plan_error(blender_layout(), scene), "no error");
}

Scene anisotropic_scene() {
    Scene scene = plain_scene();
    scene.materials[0].name = "brushed";
    scene.materials[0].where = {"scene.toml", 4, 1};
    scene.materials[0].base().model = SpecularModel::blinn_phong_anisotropic;
    return scene;
}

TEST(BindTangent, TakesTheRole) {
    const ImageLayout layout = layout_of({layer("N", "XYZ"), layer("tangent", "XYZ")});
    const FramePlan plan = plan_of(layout, anisotropic_scene());
    const BoundParameter& tangent = plan.frame.materials[0].base().tangent;
    EXPECT_EQ(plane_of(plan, tangent.planes[0]), "tangent.X");
    EXPECT_EQ(plane_of(plan, tangent.planes[2]), "tangent.Z");
    EXPECT_TRUE(tangent.averaged);
}

TEST(BindTangent, WithoutARoleItIsAnErrorThatHelps) {
    EXPECT_EQ(
        plan_error(blender_layout(), anisotropic_scene()),
        "scene.toml:4:1: material 'brushed', layer 1: blinn_phong_anisotropic needs a tangent and picture.exr has "
        "no tangent role; write tangent = [0, 0, 1] (world space) or map tangent in [gbuffer]");
    Scene scene = anisotropic_scene();
    scene.gbuffer = testing::settings_with("tangent", {"none"});
    EXPECT_THAT(plan_error(layout_of({layer("N", "XYZ"), layer("tangent", "XYZ")}), scene),
                HasSubstr("has no tangent role"));
    const ImageLayout two = layout_of({layer("N", "XYZ"), layer("a.tangent", "XYZ"), layer("b.tangent", "XYZ")});
    EXPECT_THAT(plan_error(two, anisotropic_scene()), HasSubstr("may be a.tangent, b.tangent"));
}

TEST(BindTangent, AConstantOrChannelsOfItsOwn) {
    Scene scene = anisotropic_scene();
    scene.materials[0].base().tangent = Parameter::of(glm::dvec3(1.0, 2.0, -3.0));
    EXPECT_EQ(bound_of(blender_layout(), scene).base().tangent.constant, glm::dvec3(1.0, 2.0, -3.0));
    scene.materials[0].base().tangent = Parameter::from("ViewLayer.Position");
    const FramePlan plan = plan_of(blender_layout(), scene);
    EXPECT_EQ(plane_of(plan, plan.frame.materials[0].base().tangent.planes[1]), "ViewLayer.Position.Y");
    scene.materials[0].base().tangent = Parameter::from("roughness");
    EXPECT_THAT(plan_error(blender_layout(), scene),
                HasSubstr("material 'brushed', tangent: 'roughness' is one channel and three are needed"));
    Parameter scaled = Parameter::from("ViewLayer.Position");
    scaled.scale = 2.0;
    scene.materials[0].base().tangent = scaled;
    EXPECT_THAT(plan_error(blender_layout(), scene), HasSubstr("takes no scale, offset or convert"));
}

TEST(TangentRole, IsFoundByName) {
    const auto found = [](const std::vector<std::string>& names) {
        const ImageLayout layout = layout_of({layer("N", "XYZ"), names});
        return testing::names_of(layout, assign_roles(layout, {}, ""), Role::tangent);
    };
    const std::vector<std::string> three{"ViewLayer.tangent.X", "ViewLayer.tangent.Y", "ViewLayer.tangent.Z"};
    EXPECT_EQ(found(layer("ViewLayer.tangent", "ZYX")), three);
    EXPECT_EQ(found(layer("tangentW", "RGB")), layer("tangentW", "RGB"));
    EXPECT_TRUE(found(layer("tangents_of_shoes", "XYZ")).empty());
    EXPECT_TRUE(found(layer("tangent", "X")).empty());
}

BoundMaterial material_of(const std::vector<SpecularModel>& lobes, DiffuseModel diffuse) {
    BoundMaterial material;
    material.diffuse = diffuse;
    material.layers.resize(lobes.size());
    for (std::size_t k = 0; k < lobes.size(); ++k) {
        material.layers[k].specular = lobes[k];
    }
    return material;
}

TEST(ModelKey, OfSingleLayers) {
    BoundMaterial material = material_of({SpecularModel::blinn_phong}, DiffuseModel::lambert);
    EXPECT_EQ(model_key(material), "blinn_phong.lambert");
    material.fresnel = FresnelModel::exact;
    EXPECT_EQ(model_key(material), "blinn_phong.lambert.exact");
    EXPECT_EQ(model_key(material_of({SpecularModel::none}, DiffuseModel::oren_nayar_full)), "none.oren_nayar_full");
}

TEST(ModelKey, OfStacks) {
    BoundMaterial material =
        material_of({SpecularModel::blinn_phong, SpecularModel::blinn_phong}, DiffuseModel::lambert);
    material.absorption = AbsorptionModel::approximated;
    EXPECT_EQ(model_key(material), "layers2.blinn_phong.lambert.constant.approximated");
    material =
        material_of({SpecularModel::blinn_phong_anisotropic, SpecularModel::none, SpecularModel::blinn_phong_spectral},
                    DiffuseModel::none);
    material.fresnel = FresnelModel::exact;
    EXPECT_EQ(model_key(material), "layers3.blinn_phong_anisotropic+none+blinn_phong_spectral.none.exact.none");
}

} // namespace
} // namespace clshade
