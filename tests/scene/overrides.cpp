// --set and --model.
#include "tests/scene/support.h"

#include <glm/gtc/constants.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clshade {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string with_material = head + "[material.default]\nspecular = { f0 = 0.1, shininess = 8 }\n"
                                         "diffuse = { model = 'lambert' }\n";

TEST(Overrides, ReplaceWhatIsWritten) {
    const Scene scene = parse(with_material, {"material.default.specular.shininess=32"});
    EXPECT_EQ(scene.materials[0].base().shininess.constant.x, 32.0);
    EXPECT_EQ(scene.materials[0].base().f0.constant.x, 0.1);
}

TEST(Overrides, TheLastOneWins) {
    const Scene scene =
        parse(with_material, {"material.default.specular.shininess=32", "material.default.specular.shininess = 33 "});
    EXPECT_EQ(scene.materials[0].base().shininess.constant.x, 33.0);
}

TEST(Overrides, TakeEveryKindOfValue) {
    const Scene scene = parse(with_material, {"material.default.diffuse.albedo=[0.1, 0.2, 0.3]",
                                              "material.default.diffuse.model=oren_nayar",
                                              "material.default.specular.f0={ channel = 'spec', scale = 0.5 }",
                                              "gbuffer.normal=\"View Layer.Normal\"", "gbuffer.normal_space=camera"});
    EXPECT_EQ(scene.materials[0].diffuse.albedo.constant, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(scene.materials[0].diffuse.model, DiffuseModel::oren_nayar);
    EXPECT_EQ(scene.materials[0].base().f0.channels.at(0), "spec");
    EXPECT_EQ(scene.materials[0].base().f0.scale, 0.5);
    EXPECT_EQ(scene.gbuffer.roles.at(0).channels.at(0), "View Layer.Normal");
    EXPECT_EQ(scene.gbuffer.normal_space, NormalSpace::camera);
}

TEST(Overrides, FindLightsByNameAndIndex) {
    const std::string two = head + "[material.default]\ndiffuse = {}\n";
    EXPECT_EQ(parse(two, {"light.key.irradiance=5"}).lights[0].power, glm::dvec3(5.0));
    EXPECT_EQ(parse(two, {"light.0.irradiance=6"}).lights[0].power, glm::dvec3(6.0));
    EXPECT_EQ(parse(two, {"light.key.direction.2=-2"}).lights[0].direction, glm::dvec3(0, 0, -2));
    EXPECT_THAT(error_of(two, {"light.kee.irradiance=5"}),
                HasSubstr("'light' has no element 'kee'; did you mean 'key'?"));
    EXPECT_THAT(error_of(two, {"light.1.irradiance=5"}), HasSubstr("it has 1, counted from 0"));
}

TEST(Overrides, CreateTables) {
    const Scene scene = parse(head, {"material.wax.ids=[4]", "material.wax.diffuse.albedo=0.25"});
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.materials[1].name, "wax");
    EXPECT_EQ(scene.materials[1].diffuse.albedo.constant.x, 0.25);
    EXPECT_TRUE(scene.automatic_material);
}

TEST(Overrides, ReachIntoLayers) {
    const std::string text = head + "[[material.default.layer]]\nspecular = { shininess = 9 }\n";
    EXPECT_EQ(parse(text, {"material.default.layer.0.specular.shininess=10"}).materials[0].base().shininess.constant.x,
              10.0);
    EXPECT_EQ(parse(text, {}, "blinn_phong_exact").materials[0].base().model, SpecularModel::blinn_phong_exact);
}

TEST(Overrides, FindTheLayerOfALobe) {
    const std::string one = head + "[[material.default.layer]]\nspecular = { f0 = 0.1 }\ndiffuse = {}\n";
    EXPECT_EQ(parse(one, {"material.default.specular.f0=0.2"}).materials[0].base().f0.constant.x, 0.2);
    const std::string two = head + "[[material.a.layer]]\nspecular = { f0 = 0.1 }\nabsorption = 0.1\n"
                                   "[[material.a.layer]]\ndiffuse = {}\n[material.a]\nids = [1]\n";
    const Material a =
        parse(two, {"material.a.layer.0.specular.f0=0.3", "material.a.diffuse.albedo=0.4"}).materials.at(1);
    EXPECT_EQ(a.layers[0].specular.f0.constant.x, 0.3);
    EXPECT_EQ(a.diffuse.albedo.constant.x, 0.4);
    EXPECT_THAT(error_of(two, {"material.a.specular.f0=0.3"}),
                StartsWith("--set material.a.specular.f0=0.3: material 'a' has 2 layers"));
    EXPECT_THAT(error_of(two, {"material.a.layer.2.specular.f0=0.3"}),
                HasSubstr("'layer' has no element '2'; it has 2, counted from 0"));
    EXPECT_THAT(error_of(with_material, {"material.default.layer.0.specular.f0=0.3"}),
                HasSubstr("material 'default' is not written as layers; write material.default.specular"));
}

TEST(Overrides, ObeyTheSameRules) {
    EXPECT_THAT(error_of(with_material, {"material.default.specular.shininess=-3"}),
                StartsWith("--set material.default.specular.shininess=-3: 'shininess' is -3; it must be"));
    EXPECT_THAT(error_of(with_material, {"material.default.specular.shinines=3"}),
                StartsWith("--set material.default.specular.shinines=3: unknown key 'shinines'"));
    EXPECT_THAT(error_of(with_material, {"material.default.specular.model=blin_phong"}), HasSubstr("did you mean"));
    EXPECT_THAT(error_of(with_material, {"material.default.specular.f0=nan"}), HasSubstr("finite"));
    EXPECT_THAT(error_of(with_material, {"version=2"}), HasSubstr("--set version=2: scene version 2"));
    EXPECT_THAT(error_of(with_material, {"material.default.specular.shininess=1e"}), // no number: a bare word
                testing::Eq(""));                                                    // a layer of that name may exist
    EXPECT_THAT(error_of(with_material, {"light.key.irradiance=1e"}), HasSubstr("is a string; write a number"));
}

TEST(Overrides, ReachTheEnvironment) {
    const std::string text = head + "[environment]\nimage = 'a.hdr'\n[[material.x.layer]]\nabsorption = 0.1\n"
                                    "[[material.x.layer]]\ndiffuse = {}\n[material.x]\nids = [1]\n";
    const Scene scene =
        parse(text, {"environment.rotation_degrees=90", "environment.intensity=[1, 2, 3]", "environment.up=y",
                     "environment.diffuse=sh3", "output.background=true", "material.x.absorption_ibl=clamped",
                     "material.x.transmittance_ibl=none", "material.x.diffuse.model=oren_nayar",
                     "material.x.diffuse.shininess=4", "material.x.diffuse.ambient=coarsest"});
    ASSERT_TRUE(scene.environment.has_value());
    EXPECT_EQ(scene.environment->image, "a.hdr");
    EXPECT_DOUBLE_EQ(scene.environment->rotation, glm::half_pi<double>());
    EXPECT_EQ(scene.environment->intensity, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.environment->up, UpAxis::y);
    EXPECT_EQ(scene.environment->diffuse, AmbientSource::sh3);
    EXPECT_TRUE(scene.background);
    EXPECT_EQ(scene.materials[1].absorption_ibl, AmbientAbsorption::clamped);
    EXPECT_EQ(scene.materials[1].transmittance_ibl, AmbientTransmittance::none);
    EXPECT_EQ(scene.materials[1].diffuse.ambient, AmbientDiffuse::coarsest);
    // Without [environment] in the file they make one.
    EXPECT_EQ(parse(head, {"environment.image=studio.hdr"}).environment->image, "studio.hdr");
    EXPECT_THAT(error_of(head, {"output.background=true"}),
                StartsWith("--set output.background=true: 'background' of [output]"));
    EXPECT_THAT(error_of(text, {"environment.rotatoin_degrees=90"}),
                StartsWith("--set environment.rotatoin_degrees=90: unknown key 'rotatoin_degrees' in [environment]; "
                           "did you mean 'rotation_degrees'?"));
    EXPECT_THAT(error_of(text, {"environment.intensity=-1"}), HasSubstr("it must be 0 or more"));
}

TEST(Overrides, AModelDropsTheAmbientThatItLacks) {
    const std::string rough = head + "[material.default]\ndiffuse = { model = 'oren_nayar', shininess = 3, ambient = "
                                     "'fit' }\n";
    EXPECT_EQ(parse(rough).materials[0].diffuse.ambient, AmbientDiffuse::fit);
    EXPECT_EQ(parse(rough, {}, "oren_nayar_full").materials[0].diffuse.ambient, AmbientDiffuse::fit);
    EXPECT_EQ(parse(rough, {}, "lambert").materials[0].diffuse.ambient, AmbientDiffuse::precise);
    EXPECT_THAT(error_of(rough, {"material.default.diffuse.ambient=fit"}, "lambert"),
                HasSubstr("'ambient' does nothing with model lambert"));
}

TEST(Overrides, MustBeAssignments) {
    EXPECT_THAT(error_of(head, {"units"}), StartsWith("--set units: the assignment has no '='"));
    EXPECT_THAT(error_of(head, {"=3"}), HasSubstr("is not a path of keys"));
    EXPECT_THAT(error_of(head, {"a..b=3"}), HasSubstr("is not a path of keys"));
    EXPECT_THAT(error_of(head, {"a b=3"}), HasSubstr("is not a path of keys"));
    EXPECT_THAT(error_of(head, {"units="}), HasSubstr("is not a TOML value"));
    EXPECT_THAT(error_of(head, {"units=[1, 2"}), HasSubstr("is not a TOML value"));
    EXPECT_THAT(error_of(head, {"units=3\nversion=1"}), HasSubstr("is not a TOML value"));
    EXPECT_THAT(error_of(head, {"version.x=3"}), HasSubstr("'version' is a whole number and has no key 'x'"));
}

TEST(Overrides, QuotedKeysMayHoldDots) {
    const Scene scene = parse(head, {"material.\"my.wax\".ids=[4]", "material.'my.wax'.diffuse.albedo=0.25"});
    EXPECT_EQ(scene.materials.at(1).name, "my.wax");
}

TEST(Model, ChoosesTheLobeByName) {
    EXPECT_EQ(parse(with_material, {}, "blinn_phong_exact").materials[0].base().model,
              SpecularModel::blinn_phong_exact);
    EXPECT_EQ(parse(with_material, {}, "oren_nayar_full").materials[0].diffuse.model, DiffuseModel::oren_nayar_full);
    EXPECT_THAT(error_of(with_material, {}, "blinn_phong_exakt"),
                StartsWith("--model blinn_phong_exakt: unknown model; did you mean 'blinn_phong_exact'?"));
    EXPECT_THAT(error_of(with_material, {}, "none"), HasSubstr("--set material.default.specular.model=none"));
    EXPECT_THAT(error_of(with_material, {}, "zzz"), HasSubstr("write one of 'blinn_phong'"));
}

TEST(Model, OfAnisotropyAndMetalsNeedsTheirKeys) {
    EXPECT_THAT(error_of(with_material, {}, "blinn_phong_anisotropic"),
                StartsWith("--model blinn_phong_anisotropic: specular of material 'default' lacks 'shininess_u'"));
    EXPECT_THAT(error_of(head, {}, "blinn_phong_anisotropic"),
                StartsWith("--model blinn_phong_anisotropic: specular of material 'default' lacks 'shininess_u'"));
    EXPECT_THAT(error_of(with_material, {}, "blinn_phong_spectral"),
                StartsWith("--model blinn_phong_spectral: specular of material 'default' lacks 'metal'"));
    // The file's own shininess and f0 give way to a model that lacks them.
    const Specular brushed =
        parse(with_material, {"material.default.specular.shininess_u=3", "material.default.specular.shininess_v=5"},
              "blinn_phong_anisotropic")
            .materials[0]
            .base();
    EXPECT_EQ(brushed.model, SpecularModel::blinn_phong_anisotropic);
    EXPECT_EQ(brushed.f0.constant.x, 0.1);
    EXPECT_EQ(brushed.shininess_v.constant.x, 5.0);
    const Specular copper =
        parse(with_material, {"material.default.specular.metal=copper"}, "blinn_phong_spectral").materials[0].base();
    EXPECT_EQ(copper.metal.name, "copper");
    EXPECT_EQ(copper.shininess.constant.x, 8.0);
    const Scene matte = parse(with_material, {"material.default.specular.model=none"});
    EXPECT_EQ(matte.materials[0].base().model, SpecularModel::none);
}

TEST(Automatic, LeavesOutWhatTheModelLacks) {
    const Scene brushed = default_scene(
        std::vector<std::string>{"material.default.specular.shininess_u=3", "material.default.specular.shininess_v=5"},
        "blinn_phong_anisotropic");
    EXPECT_TRUE(brushed.automatic.albedo && brushed.automatic.f0);
    EXPECT_FALSE(brushed.automatic.shininess);
    const Scene metal =
        default_scene(std::vector<std::string>{"material.default.specular.metal=gold"}, "blinn_phong_spectral");
    EXPECT_TRUE(metal.automatic.albedo && metal.automatic.shininess);
    EXPECT_FALSE(metal.automatic.f0);
}

TEST(Automatic, IsTheBaseOfAStack) {
    const Scene scene = default_scene(
        std::vector<std::string>{"material.default.layer=[{specular={ior=1.5}, absorption=0.1}, {}]"}, {});
    const Material& material = scene.materials[0];
    ASSERT_EQ(material.layers.size(), 2U);
    EXPECT_EQ(material.layers[0].absorption.constant.x, 0.1);
    EXPECT_EQ(material.base().model, SpecularModel::blinn_phong);
    EXPECT_EQ(material.diffuse.model, DiffuseModel::lambert);
    EXPECT_FALSE(scene.automatic_material);
    EXPECT_TRUE(scene.automatic.albedo && scene.automatic.f0 && scene.automatic.shininess);
}

TEST(Automatic, OverridesLeaveTheRestAutomatic) {
    const Scene scene = default_scene(std::vector<std::string>{"material.default.specular.shininess=32"}, {});
    EXPECT_FALSE(scene.automatic_material);
    EXPECT_TRUE(scene.automatic.albedo);
    EXPECT_TRUE(scene.automatic.f0);
    EXPECT_FALSE(scene.automatic.shininess);
    EXPECT_EQ(scene.materials[0].base().shininess.constant.x, 32.0);
    EXPECT_EQ(scene.materials[0].diffuse.model, DiffuseModel::lambert); // not "none": nobody wrote the material
}

TEST(Automatic, AModelLeavesAllParametersAutomatic) {
    const Scene scene = default_scene({}, "oren_nayar");
    EXPECT_FALSE(scene.automatic_material);
    EXPECT_TRUE(scene.automatic.albedo && scene.automatic.f0 && scene.automatic.shininess);
    EXPECT_EQ(scene.materials[0].base().model, SpecularModel::blinn_phong);
    EXPECT_EQ(scene.materials[0].diffuse.model, DiffuseModel::oren_nayar);
    EXPECT_FALSE(scene.materials[0].diffuse.shininess.has_value());
}

TEST(Automatic, IorIsAWrittenF0) {
    const Scene scene = default_scene(std::vector<std::string>{"material.default.specular.ior=3"}, {});
    EXPECT_FALSE(scene.automatic.f0);
    EXPECT_EQ(scene.materials[0].base().f0.constant.x, 0.25);
}

TEST(Automatic, WrittenMaterialsStayWritten) {
    const Scene scene = parse(with_material, {"material.default.specular.shininess=32"});
    EXPECT_FALSE(scene.automatic_material);
    EXPECT_FALSE(scene.automatic.albedo || scene.automatic.f0 || scene.automatic.shininess);
}

TEST(DefaultScene, TakesOverrides) {
    const Scene scene = default_scene(std::vector<std::string>{"light.key.irradiance=9", "light.key.color=1"}, {});
    EXPECT_EQ(scene.lights[0].power, glm::dvec3(9.0));
    EXPECT_TRUE(scene.lights[0].in_camera_space);
    EXPECT_TRUE(scene.automatic_material);
    EXPECT_TRUE(scene.environment->in_camera_space);
    EXPECT_THROW((void)default_scene(std::vector<std::string>{"light.kye.irradiance=9"}, {}), UsageError);
}

TEST(DefaultScene, OnlyTheStudioTurnsWithTheCamera) {
    const auto environment_of = [](const std::string& assignment) {
        return default_scene(std::vector<std::string>{assignment}, {}).environment.value();
    };
    EXPECT_TRUE(environment_of("environment.rotation_degrees=20").in_camera_space);
    EXPECT_FALSE(environment_of("environment.image=workshop.hdr").in_camera_space);
    EXPECT_EQ(environment_of("environment.image=workshop.hdr").intensity, glm::dvec3(1.0)); // not the studio's
    EXPECT_EQ(environment_of("environment.intensity=3").intensity, glm::dvec3(3.0));
    EXPECT_FALSE(environment_of("environment.up=z").in_camera_space);
    EXPECT_TRUE(default_scene(std::vector<std::string>{"output.background=true"}, {}).background);
    EXPECT_TRUE(default_scene(std::vector<std::string>{"light=[]"}, {}).lights.empty()); // the studio is light enough
}

} // namespace
} // namespace clshade
