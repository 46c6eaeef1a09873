// Presets and how keys beside them change them.
#include "host/scene/model_catalog.h"
#include "tests/scene/support.h"

#include <fmt/format.h>

#include <set>

namespace clshade {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Material with_preset(const std::string& preset, const std::string& keys = {},
                     const std::vector<std::string>& overrides = {}, std::string_view model = {}) {
    return parse(head + "[material.default]\npreset = '" + preset + "'\n" + keys, overrides, model).materials.at(0);
}

TEST(Presets, AreWhatAUserCouldWrite) {
    std::set<std::string_view> names;
    for (const PresetInfo& preset : preset_catalog()) {
        EXPECT_TRUE(names.insert(preset.name).second) << preset.name << " is listed twice";
        const std::string name(preset.name);
        EXPECT_THAT(std::string(preset.toml), StartsWith("[material." + name + "]\n"));
        EXPECT_THAT(std::string(preset.source), HasSubstr("models.md section")) << name;
        EXPECT_FALSE(preset.summary.empty()) << name;
        // The text pasted into a scene and the preset taken by name are one material.
        const std::string claim = "material." + name + ".ids=[1]";
        const Scene pasted = parse(head + std::string(preset.toml), {claim});
        const Scene named = parse(head + fmt::format("[material.{0}]\nids = [1]\npreset = '{0}'\n", name));
        const Material& a = pasted.materials.at(1);
        const Material& b = named.materials.at(1);
        EXPECT_EQ(a.fresnel, b.fresnel) << name;
        EXPECT_EQ(a.absorption_model, b.absorption_model) << name;
        EXPECT_EQ(a.diffuse.model, b.diffuse.model) << name;
        EXPECT_EQ(a.diffuse.albedo.constant, b.diffuse.albedo.constant) << name;
        ASSERT_EQ(a.layers.size(), b.layers.size()) << name;
        for (std::size_t k = 0; k < a.layers.size(); ++k) {
            EXPECT_EQ(a.layers[k].specular.model, b.layers[k].specular.model) << name << k;
            EXPECT_EQ(a.layers[k].specular.f0.constant, b.layers[k].specular.f0.constant) << name << k;
            EXPECT_EQ(a.layers[k].specular.shininess.constant, b.layers[k].specular.shininess.constant) << name << k;
            EXPECT_EQ(a.layers[k].absorption.constant, b.layers[k].absorption.constant) << name << k;
        }
    }
    EXPECT_EQ(names,
              (std::set<std::string_view>{"skin", "car_paint", "lacquered_wood", "brushed_metal", "cloth", "gold"}));
}

TEST(Presets, NeedNoPlane) {
    for (const PresetInfo& preset : preset_catalog()) {
        const Material material = with_preset(std::string(preset.name));
        EXPECT_TRUE(material.diffuse.albedo.is_constant()) << preset.name;
        EXPECT_TRUE(!material.diffuse.shininess.has_value() || material.diffuse.shininess->is_constant());
        for (const Layer& layer : material.layers) {
            const Specular& lobe = layer.specular;
            EXPECT_TRUE(layer.absorption.is_constant() && lobe.f0.is_constant() && lobe.shininess.is_constant() &&
                        lobe.shininess_u.is_constant() && lobe.shininess_v.is_constant())
                << preset.name;
            EXPECT_TRUE(lobe.model != SpecularModel::blinn_phong_anisotropic ||
                        (lobe.tangent.has_value() && lobe.tangent->is_constant()))
                << preset.name;
        }
    }
}

TEST(Presets, SkinIsTheStackOfTheSpecification) {
    // models.md section 10.1; its test vectors have albedo 0.6 and a' = 0.02, here the red channel.
    const Material skin = with_preset("skin");
    EXPECT_EQ(skin.fresnel, FresnelModel::constant);
    EXPECT_EQ(skin.absorption_model, AbsorptionModel::approximated);
    ASSERT_EQ(skin.layers.size(), 2U);
    const double oil = 0.47 / 2.47;
    const double tissue = 0.40 / 2.40;
    EXPECT_NEAR(skin.layers[0].specular.f0.constant.r, oil * oil, 1e-15); // to rounding
    EXPECT_EQ(skin.layers[0].specular.shininess.constant.r, 128.0);
    EXPECT_EQ(skin.layers[0].absorption.constant.r, 0.02);
    EXPECT_NEAR(skin.base().f0.constant.r, tissue * tissue, 1e-15);
    EXPECT_EQ(skin.base().shininess.constant.r, 12.0);
    EXPECT_EQ(skin.diffuse.model, DiffuseModel::oren_nayar);
    EXPECT_EQ(skin.diffuse.albedo.constant.r, 0.6);
    EXPECT_EQ(skin.diffuse.shininess->constant.r, 5.945);
}

TEST(Presets, HaveTheLobesTheyAreNamedFor) {
    EXPECT_EQ(with_preset("gold").base().model, SpecularModel::blinn_phong_spectral);
    EXPECT_EQ(with_preset("gold").base().metal.name, "gold");
    EXPECT_EQ(with_preset("gold").diffuse.model, DiffuseModel::none);
    const Specular brushed = with_preset("brushed_metal").base();
    EXPECT_EQ(brushed.model, SpecularModel::blinn_phong_anisotropic);
    EXPECT_EQ(brushed.tangent->constant, glm::dvec3(0, 0, 1));
    EXPECT_GT(brushed.shininess_v.constant.x, 10.0 * brushed.shininess_u.constant.x);
    EXPECT_EQ(with_preset("car_paint").layers.size(), 2U);
    EXPECT_EQ(with_preset("lacquered_wood").layers.size(), 2U);
    EXPECT_EQ(with_preset("cloth").diffuse.model, DiffuseModel::oren_nayar);
}

TEST(Presets, GiveWayToKeysBesideThem) {
    const Material cloth = with_preset("cloth", "fresnel = 'exact'\ndiffuse.albedo = [0.1, 0.2, 0.3]\n"
                                                "specular = { shininess = { channel = 'r' }, f0 = 0.3 }\n");
    EXPECT_EQ(cloth.fresnel, FresnelModel::exact);
    EXPECT_EQ(cloth.diffuse.albedo.constant, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(cloth.diffuse.shininess->constant.x, 2.0); // of the preset
    EXPECT_EQ(cloth.base().model, SpecularModel::blinn_phong_exact);
    EXPECT_THAT(cloth.base().shininess.channels, ElementsAre("r"));
    EXPECT_EQ(cloth.base().f0.constant.x, 0.3); // in place of the preset's ior
}

TEST(Presets, AnotherModelDropsTheKeysItLacks) {
    const Specular plain = with_preset("gold", "specular = { model = 'blinn_phong', f0 = 0.9 }\n").base();
    EXPECT_EQ(plain.model, SpecularModel::blinn_phong);
    EXPECT_EQ(plain.f0.constant.x, 0.9);
    EXPECT_EQ(plain.shininess.constant.x, 256.0); // both models have it
    const Specular round =
        with_preset("brushed_metal", "specular = { model = 'blinn_phong', shininess = 30 }\n").base();
    EXPECT_EQ(round.f0.constant, glm::dvec3(0.67, 0.64, 0.60));
    EXPECT_EQ(round.shininess.constant.x, 30.0);
    EXPECT_FALSE(round.tangent.has_value());
    EXPECT_EQ(with_preset("cloth", "specular.model = 'none'\n").base().model, SpecularModel::none);
}

TEST(Presets, DiffuseChangesTheBaseOfAStack) {
    const Material skin = with_preset("skin", "diffuse = { albedo = 'albedo', model = 'lambert' }\n");
    ASSERT_EQ(skin.layers.size(), 2U);
    EXPECT_THAT(skin.diffuse.albedo.channels, ElementsAre("albedo"));
    EXPECT_EQ(skin.diffuse.model, DiffuseModel::lambert);
    EXPECT_EQ(skin.diffuse.shininess->constant.x, 5.945);
    EXPECT_EQ(skin.base().shininess.constant.x, 12.0);
}

TEST(Presets, LayersReplaceItsLayersWholly) {
    const std::string layer = "[[material.default.layer]]\nspecular = { f0 = 0.2 }\n";
    const Material skin = with_preset("skin", "fresnel = 'exact'\n" + layer);
    ASSERT_EQ(skin.layers.size(), 1U);
    EXPECT_EQ(skin.base().f0.constant.x, 0.2);
    EXPECT_EQ(skin.diffuse.model, DiffuseModel::none);
    EXPECT_EQ(skin.fresnel, FresnelModel::exact);
    const Material gold = with_preset("gold", layer); // its lobe stands straight in the material
    EXPECT_EQ(gold.base().model, SpecularModel::blinn_phong);
}

TEST(Presets, ObeyTheCommandLine) {
    const Material paint =
        with_preset("car_paint", {},
                    {"material.default.layer.0.specular.shininess=64", "material.default.layer.1.specular.ior=2",
                     "material.default.diffuse.albedo=0.7", "material.default.absorption_model=original"});
    EXPECT_EQ(paint.layers.at(0).specular.shininess.constant.x, 64.0);
    EXPECT_NEAR(paint.base().f0.constant.x, 1.0 / 9.0, 1e-15); // in place of the preset's f0; to rounding
    EXPECT_EQ(paint.diffuse.albedo.constant, glm::dvec3(0.7));
    EXPECT_EQ(paint.absorption_model, AbsorptionModel::original);
    EXPECT_EQ(with_preset("skin", {}, {}, "oren_nayar_full").diffuse.model, DiffuseModel::oren_nayar_full);
    EXPECT_EQ(with_preset("gold", {}, {"material.default.specular.f0=0.8"}, "blinn_phong").base().f0.constant.x, 0.8);
    EXPECT_THAT(error_of(head + "[material.default]\npreset = 'skin'\n", {}, "blinn_phong"),
                StartsWith("--model blinn_phong: material 'default' has 2 layers, each with its own specular lobe"));
    EXPECT_THAT(error_of(head + "[material.default]\npreset = 'skin'\n", {"material.default.specular.f0=0"}),
                HasSubstr("layers counted from 0 = top"));
}

TEST(Presets, MayComeFromTheCommandLine) {
    // The order of --set does not matter: a preset comes first, what changes it after it.
    const Scene scene = default_scene(
        std::vector<std::string>{"material.default.layer.0.specular.shininess=9", "material.default.preset=skin"},
        "lambert");
    const Material& skin = scene.materials.at(0);
    ASSERT_EQ(skin.layers.size(), 2U);
    EXPECT_EQ(skin.layers[0].specular.shininess.constant.x, 9.0);
    EXPECT_EQ(skin.diffuse.model, DiffuseModel::lambert);
    EXPECT_FALSE(scene.automatic_material);
    EXPECT_FALSE(scene.automatic.albedo || scene.automatic.f0 || scene.automatic.shininess);
    const std::vector<std::string> gold{"material.default.preset=gold"};
    EXPECT_EQ(default_scene(gold, {}).materials.at(0).diffuse.model, DiffuseModel::none); // not automatic
    const std::vector<std::string> whole{"material.default={preset='gold', specular={shininess=3}}"};
    EXPECT_EQ(default_scene(whole, {}).materials.at(0).base().shininess.constant.x, 3.0);
    EXPECT_EQ(with_preset("gold", {}, {"material.default.preset=cloth"}).base().model,
              SpecularModel::blinn_phong_exact);
    EXPECT_THAT(error_of(head, {"material.default.preset=golt"}),
                StartsWith("--set material.default.preset=golt: preset 'golt' is unknown; did you mean 'gold'?"));
    EXPECT_THAT(error_of(head, {}, "skin"), HasSubstr("write --set material.default.preset=skin"));
}

} // namespace
} // namespace clshade
