// Roles found by name, for every producer the conventions list.
#include "host/base/error.h"
#include "host/gbuffer/roles.h"
#include "tests/gbuffer/layouts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace clshade {
namespace {

using testing::add_channel;
using testing::blender_layout;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::layer;
using testing::layout_of;
using testing::names_of;
using ::testing::Not;

using Names = std::vector<std::string>;

RoleAssignment detect(const ImageLayout& layout) {
    return assign_roles(layout, {}, "");
}

TEST(Roles, NamesGoBothWays) {
    for (int i = 0; i < role_count; ++i) {
        const Role role = static_cast<Role>(i);
        EXPECT_EQ(role_from_name(name_of(role)), role);
    }
    EXPECT_EQ(role_from_name("Normal"), std::nullopt);
}

TEST(Roles, BlenderWithAovs) {
    const ImageLayout layout = blender_layout();
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::normal),
              (Names{"ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"}));
    EXPECT_EQ(names_of(layout, roles, Role::position),
              (Names{"ViewLayer.Position.X", "ViewLayer.Position.Y", "ViewLayer.Position.Z"}));
    EXPECT_EQ(names_of(layout, roles, Role::depth), (Names{"ViewLayer.Depth.Z"}));
    EXPECT_EQ(names_of(layout, roles, Role::albedo),
              (Names{"ViewLayer.DiffCol.R", "ViewLayer.DiffCol.G", "ViewLayer.DiffCol.B"}));
    EXPECT_THAT(roles[Role::albedo].runners_up, ElementsAre("ViewLayer.basecolor"));
    EXPECT_EQ(names_of(layout, roles, Role::f0), (Names{"ViewLayer.f0.R", "ViewLayer.f0.G", "ViewLayer.f0.B"}));
    EXPECT_EQ(names_of(layout, roles, Role::roughness), (Names{"ViewLayer.roughness.X"}));
    EXPECT_EQ(names_of(layout, roles, Role::metallic), (Names{"ViewLayer.metallic.X"}));
    EXPECT_EQ(names_of(layout, roles, Role::material_id), (Names{"ViewLayer.IndexMA.X"}));
    EXPECT_EQ(names_of(layout, roles, Role::coverage), (Names{"ViewLayer.UV.A"}));
    EXPECT_THAT(roles[Role::coverage].runners_up,
                ElementsAre("ViewLayer.f0.A", "ViewLayer.basecolor.A", "ViewLayer.Combined.A"));
    EXPECT_EQ(names_of(layout, roles, Role::emission),
              (Names{"ViewLayer.Emit.R", "ViewLayer.Emit.G", "ViewLayer.Emit.B"}));
    EXPECT_FALSE(roles.has(Role::shininess));
    EXPECT_THAT(roles.warnings, IsEmpty());
}

TEST(Roles, BlenderWithoutAovsTakesNoGlossColourForF0) {
    const ImageLayout layout = blender_layout("ViewLayer", false);
    const RoleAssignment roles = detect(layout);
    EXPECT_FALSE(roles.has(Role::f0));
    EXPECT_THAT(roles[Role::f0].rule, HasSubstr("GlossCol"));
    EXPECT_EQ(names_of(layout, roles, Role::coverage), (Names{"ViewLayer.Combined.A"}));
}

TEST(Roles, ViewLayerNamesMayHoldDotsAndSpaces) {
    const ImageLayout layout = blender_layout("View Layer.001 b");
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(roles[Role::normal].layer, "View Layer.001 b.Normal");
    EXPECT_EQ(roles[Role::depth].layer, "View Layer.001 b.Depth");
}

TEST(Roles, NewerBlenderNamesHoldSpaces) {
    const ImageLayout layout =
        layout_of({layer("A.Normal", "XYZ"), layer("A.Diffuse Color", "RGB"), layer("A.Glossy Color", "RGB"),
                   layer("A.Material Index", "X"), layer("A.Object Index", "X"), layer("A.Emission", "RGB")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(roles[Role::albedo].layer, "A.Diffuse Color");
    EXPECT_EQ(roles[Role::material_id].layer, "A.Material Index");
    EXPECT_EQ(roles[Role::emission].layer, "A.Emission");
    EXPECT_FALSE(roles.has(Role::f0));
}

TEST(Roles, BlenderFileOutput) {
    const ImageLayout layout =
        layout_of({layer("N", "XYZ"), layer("P", "XYZ"), layer("Z", "V"), layer("albedo", "ABGR"),
                   layer("beauty", "ABGR"), layer("f0", "ABGR"), layer("matid", "V"), layer("objid", "V"),
                   layer("roughness", "V"), layer("specular", "ABGR"), layer("uv", "XYZ")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::normal), (Names{"N.X", "N.Y", "N.Z"}));
    EXPECT_EQ(names_of(layout, roles, Role::position), (Names{"P.X", "P.Y", "P.Z"}));
    EXPECT_EQ(names_of(layout, roles, Role::depth), (Names{"Z.V"}));
    EXPECT_EQ(names_of(layout, roles, Role::material_id), (Names{"matid.V"}));
    EXPECT_EQ(names_of(layout, roles, Role::f0), (Names{"f0.R", "f0.G", "f0.B"}));
    EXPECT_EQ(names_of(layout, roles, Role::coverage), (Names{"uv.Z"}));
}

TEST(Roles, FileOutputsAlbedoAlphaIsTheLastResort) {
    // Measured: the alpha of a pass piped through the compositor is 1 everywhere.
    const ImageLayout layout = layout_of({layer("N", "XYZ"), layer("albedo", "ABGR"), layer("beauty", "ABGR")});
    EXPECT_EQ(names_of(layout, detect(layout), Role::coverage), (Names{"beauty.A"}));
    const ImageLayout aov =
        layout_of({layer("V.Normal", "XYZ"), layer("V.albedo", "ABGR"), layer("V.Combined", "ABGR")});
    EXPECT_EQ(names_of(aov, detect(aov), Role::coverage), (Names{"V.albedo.A"}));
}

TEST(Roles, WordsInsideLongerNamesDoNotMatch) {
    const ImageLayout layout =
        layout_of({layer("V.Denoising Normal", "XYZ"), layer("V.Denoising Depth", "Z"), layer("V.Mist", "Z"),
                   layer("V.Denoising Albedo", "RGB"), layer("V.MyNormal", "XYZ"), layer("V.Normal2", "XYZ"),
                   layer("V.DepthOfField", "Z"), layer("XN", "XYZ")});
    const RoleAssignment roles = detect(layout);
    for (int i = 0; i < role_count; ++i) {
        EXPECT_FALSE(roles.has(static_cast<Role>(i))) << name_of(static_cast<Role>(i));
    }
    EXPECT_THAT(roles[Role::normal].rule, HasSubstr("Denoising Normal"));
    EXPECT_THAT(roles[Role::depth].rule, HasSubstr("Denoising Depth"));
}

TEST(Roles, TwoViewLayersAreAnAmbiguity) {
    ImageLayout layout = blender_layout("A");
    const ImageLayout other = blender_layout("B");
    layout.channels.insert(layout.channels.end(), other.channels.begin(), other.channels.end());
    const RoleAssignment roles = detect(layout);
    EXPECT_FALSE(roles.has(Role::normal));
    EXPECT_THAT(roles[Role::normal].ambiguous, ElementsAre("A.Normal", "B.Normal"));
    // Once the normal is named, its view layer decides the rest.
    const RoleAssignment chosen = assign_roles(layout, testing::settings_with("normal", {"B.Normal"}), "");
    EXPECT_EQ(chosen[Role::normal].layer, "B.Normal");
    EXPECT_EQ(chosen[Role::depth].layer, "B.Depth");
    EXPECT_EQ(chosen[Role::coverage].layer, "B.UV.A");
    EXPECT_EQ(chosen[Role::albedo].layer, "B.DiffCol");
    EXPECT_THAT(chosen[Role::albedo].ambiguous, IsEmpty());
}

TEST(Roles, PlanesOfAnotherViewLayerAreTakenWithAWarning) {
    const ImageLayout layout = layout_of({layer("A.Normal", "XYZ"), layer("B.Depth", "Z")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(roles[Role::depth].layer, "B.Depth");
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("different view layers")));
}

TEST(Roles, TheNormalsViewLayerBeatsABetterNameElsewhere) {
    const ImageLayout layout =
        layout_of({layer("A.Normal", "XYZ"), layer("A.albedo", "RGB"), layer("B.DiffCol", "RGB")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(roles[Role::albedo].layer, "A.albedo");
    EXPECT_THAT(roles[Role::albedo].runners_up, ElementsAre("B.DiffCol"));
}

TEST(Roles, TheWholeNameBeatsOneBehindAViewLayer) {
    const ImageLayout layout = layout_of({layer("character.Normal", "XYZ"), layer("Normal", "XYZ")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(roles[Role::normal].layer, "Normal");
    EXPECT_THAT(roles[Role::normal].runners_up, ElementsAre("character.Normal"));
}

TEST(Roles, ArnoldBareNames) {
    ImageLayout layout = layout_of({{"A", "B", "G", "R", "Z", "id", "instanceID", "pscale"},
                                    layer("N", "XYZ"),
                                    layer("P", "XYZ"),
                                    layer("albedo", "RGB"),
                                    layer("diffuse_albedo", "RGB")});
    layout.strings["arnold/color_space"] = "ACEScg";
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::depth), (Names{"Z"}));
    EXPECT_EQ(names_of(layout, roles, Role::coverage), (Names{"A"}));
    EXPECT_EQ(roles[Role::albedo].layer, "diffuse_albedo");
    EXPECT_FALSE(roles.has(Role::material_id));
    EXPECT_THAT(roles[Role::material_id].rule, HasSubstr("id numbers objects"));
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("ACEScg")));
}

TEST(Roles, ArnoldMultichannelOfAnOlderVersion) { // psyop_multichannel.exr
    ImageLayout layout = layout_of({{"A", "B", "G", "R", "pscale"},
                                    layer("Cd", "BGR"),
                                    layer("crypto_asset", "BGR"),
                                    layer("crypto_asset00", "ABGR"),
                                    layer("shape", "BGR")});
    layout.strings["arnold/color_space"] = "linear";
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::coverage), (Names{"A"}));
    for (const Role role : {Role::normal, Role::position, Role::depth, Role::albedo, Role::f0}) {
        EXPECT_FALSE(roles.has(role)) << name_of(role);
    }
    EXPECT_THAT(roles.warnings, IsEmpty());
}

TEST(Roles, ABareVectorIsNoDepth) {
    const ImageLayout layout = layout_of({{"X", "Y", "Z"}});
    EXPECT_FALSE(detect(layout).has(Role::depth));
}

TEST(Roles, NukeLayers) {
    const ImageLayout layout = layout_of({{"A", "B", "G", "R"},
                                          {"character.Z", "character.ZBack", "character.alpha", "character.blue",
                                           "character.custom", "character.green", "character.mask", "character.red"},
                                          {"depth.Z"},
                                          {"other.ZBack", "other.custom", "other.mask"},
                                          {"normal.red", "normal.green", "normal.blue"}});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::depth), (Names{"depth.Z"}));
    EXPECT_EQ(names_of(layout, roles, Role::normal), (Names{"normal.red", "normal.green", "normal.blue"}));
    EXPECT_EQ(names_of(layout, roles, Role::coverage), (Names{"A"}));
    const std::vector<int> character = find_channels(layout, roles, Parameter::from("character"), "albedo");
    EXPECT_EQ(names_of(layout, character), (Names{"character.red", "character.green", "character.blue"}));
    const std::vector<int> mask = find_channels(layout, roles, Parameter::from("other.mask"), "shininess");
    EXPECT_EQ(names_of(layout, mask), (Names{"other.mask"}));
}

TEST(Roles, ImageSpreadOverParts) { // gaffer_weirdPartNames.exr: every letter in a part of its own
    ImageLayout layout = layout_of({});
    layout.parts.resize(6, layout.parts.front());
    const Names names{"R", "G", "B", "layer.R", "A", "layer.G", "layer.B", "layer.A"};
    const std::vector<int> parts{0, 1, 2, 2, 3, 3, 4, 5};
    for (std::size_t i = 0; i < names.size(); ++i) {
        add_channel(layout, names[i], SampleType::half, "", parts[i]);
    }
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::coverage), (Names{"A"}));
    EXPECT_EQ(names_of(layout, find_channels(layout, roles, Parameter::from("layer"), "albedo")),
              (Names{"layer.R", "layer.G", "layer.B"}));
}

TEST(Roles, KarmaWritesEveryPlaneAsAColour) {
    const ImageLayout layout = layout_of(
        {layer("N", "RGB"), layer("P", "RGB"), layer("Pz", "RGB"), layer("albedo", "RGB"), layer("roughness", "RGB")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::normal), (Names{"N.R", "N.G", "N.B"}));
    EXPECT_EQ(names_of(layout, roles, Role::depth), (Names{"Pz.R"}));
    EXPECT_EQ(names_of(layout, roles, Role::roughness), (Names{"roughness.R"}));
    EXPECT_THAT(roles[Role::roughness].rule, HasSubstr("first of its channels"));
}

TEST(Roles, PbrtPrefersTheShadingNormalAndSaysItsSpace) {
    const ImageLayout layout =
        layout_of({layer("N", "XYZ"), layer("Ns", "XYZ"), layer("P", "XYZ"), layer("Albedo", "RGB")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(roles[Role::normal].layer, "Ns");
    EXPECT_EQ(roles[Role::albedo].layer, "Albedo");
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("normal_space = \"camera\"")));
    GBufferSettings camera_space;
    camera_space.normal_space = NormalSpace::camera;
    EXPECT_THAT(assign_roles(layout, camera_space, "").warnings, IsEmpty());
}

TEST(Roles, RenderManWorldPlanesBeatTheBuiltInOnes) {
    const ImageLayout layout = layout_of(
        {layer("Nn", "XYZ"), layer("__Nworld", "rgb"), layer("P", "XYZ"), layer("__Pworld", "rgb"), {"z", "__depth"}});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::normal), (Names{"__Nworld.r", "__Nworld.g", "__Nworld.b"}));
    EXPECT_EQ(roles[Role::position].layer, "__Pworld");
    EXPECT_EQ(names_of(layout, roles, Role::depth), (Names{"__depth"}));
    EXPECT_THAT(roles[Role::depth].runners_up, ElementsAre("z"));
}

TEST(Roles, VRayNormalsAreNotTaken) {
    const ImageLayout layout =
        layout_of({layer("normals", "XYZ"), layer("VRayBumpNormals", "XYZ"), layer("VRayDiffuseFilter", "RGB"),
                   layer("VRayMtlID", "X"), layer("VRayMtlReflectGlossiness", "X")});
    const RoleAssignment roles = detect(layout);
    EXPECT_FALSE(roles.has(Role::normal));
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("not in world space")));
    EXPECT_EQ(roles[Role::albedo].layer, "VRayDiffuseFilter");
    EXPECT_EQ(roles[Role::material_id].layer, "VRayMtlID");
    EXPECT_FALSE(roles.has(Role::roughness));
    EXPECT_THAT(roles[Role::roughness].runners_up, ElementsAre("VRayMtlReflectGlossiness"));
}

TEST(Roles, RedshiftPrefersBumpNormals) {
    const ImageLayout layout =
        layout_of({layer("Normals", "RGB"), layer("BumpNormals", "RGB"), layer("WorldPosition", "RGB"), layer("Z", "R"),
                   layer("DiffuseFilter", "RGB"), layer("ReflectionsFilter", "RGB")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(roles[Role::normal].layer, "BumpNormals");
    EXPECT_EQ(roles[Role::position].layer, "WorldPosition");
    EXPECT_EQ(roles[Role::albedo].layer, "DiffuseFilter");
    EXPECT_FALSE(roles.has(Role::f0));
}

TEST(Roles, UnrealQueueNamesAreLeftHanded) {
    const std::string queue = "FinalImageMovieRenderQueue_";
    const ImageLayout layout = layout_of({layer(queue + "WorldNormal", "RGB"), layer(queue + "WorldDepth", "RGB"),
                                          layer(queue + "BaseColor", "RGB"), layer(queue + "Roughness", "RGB"),
                                          layer(queue + "Specular", "RGB"), layer("SomethingWorldNormal", "RGB")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(roles[Role::normal].layer, queue + "WorldNormal");
    EXPECT_EQ(names_of(layout, roles, Role::depth), (Names{queue + "WorldDepth.R"}));
    EXPECT_EQ(roles[Role::albedo].layer, queue + "BaseColor");
    EXPECT_EQ(roles[Role::roughness].layer, queue + "Roughness");
    EXPECT_FALSE(roles.has(Role::f0));
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("left-handed")));
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("base colour")));
}

TEST(Roles, UnitySmoothnessIsNotRoughness) {
    const ImageLayout layout = layout_of({layer("Normals", "RGB"), layer("Depth", "R"), layer("Albedo", "RGB"),
                                          layer("Specular", "RGB"), layer("Smoothness", "R"), layer("Metal", "R")});
    const RoleAssignment roles = detect(layout);
    EXPECT_FALSE(roles.has(Role::roughness));
    EXPECT_THAT(roles[Role::roughness].runners_up, ElementsAre("Smoothness"));
    EXPECT_THAT(roles[Role::roughness].rule, HasSubstr("convert = \"smoothness\""));
    EXPECT_FALSE(roles.has(Role::f0));
    EXPECT_EQ(roles[Role::metallic].layer, "Metal");
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("left-handed")));
}

TEST(Roles, MitsubaDepthIsARayDistance) {
    const ImageLayout layout = layout_of({layer("sh_normal", "XYZ"), layer("position", "XYZ"), layer("dd.y", "T"),
                                          layer("albedo", "RGB"), layer("prim", "I")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::depth), (Names{"dd.y.T"}));
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("depth_kind = \"ray\"")));
    GBufferSettings ray;
    ray.depth_kind = DepthKind::ray;
    EXPECT_THAT(assign_roles(layout, ray, "").warnings, IsEmpty());
    const ImageLayout named = layout_of({layer("sh_normal", "XYZ"), layer("depth", "T")});
    EXPECT_THAT(detect(named).warnings, Contains(HasSubstr("depth_kind = \"ray\"")));
}

TEST(Roles, FalcorPacksRoughnessIntoAlpha) {
    const ImageLayout layout =
        layout_of({layer("normW", "RGBA"), layer("posW", "RGBA"), layer("specRough", "RGBA"),
                   layer("diffuseOpacity", "RGBA"), layer("mtlData", "XYZ"), layer("depth", "R")});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::roughness), (Names{"specRough.A"}));
    EXPECT_EQ(names_of(layout, roles, Role::f0), (Names{"specRough.R", "specRough.G", "specRough.B"}));
    EXPECT_EQ(names_of(layout, roles, Role::material_id), (Names{"mtlData.X"}));
    EXPECT_EQ(roles[Role::normal].layer, "normW");
}

TEST(Roles, OidnNames) {
    const ImageLayout layout = layout_of({layer("nrm", "RGB"), layer("alb", "RGB")});
    EXPECT_EQ(detect(layout)[Role::normal].layer, "nrm");
    EXPECT_EQ(detect(layout)[Role::albedo].layer, "alb");
}

TEST(Roles, SuffixesInEveryCase) {
    const ImageLayout layout =
        layout_of({layer("N", "xyz"), layer("P", "rgb"), {"albedo.Red", "albedo.GREEN"}, {"albedo.blue"}});
    const RoleAssignment roles = detect(layout);
    EXPECT_EQ(names_of(layout, roles, Role::normal), (Names{"N.x", "N.y", "N.z"}));
    EXPECT_EQ(names_of(layout, roles, Role::position), (Names{"P.r", "P.g", "P.b"}));
    EXPECT_EQ(names_of(layout, roles, Role::albedo), (Names{"albedo.Red", "albedo.GREEN", "albedo.blue"}));
}

TEST(Roles, GreyAlbedoIsOneChannel) {
    const ImageLayout layout = layout_of({layer("N", "XYZ"), layer("albedo", "V"), layer("roughness", "V")});
    EXPECT_EQ(names_of(layout, detect(layout), Role::albedo), (Names{"albedo.V"}));
}

TEST(Roles, ComponentsOfAVectorMustBeComplete) {
    EXPECT_FALSE(detect(layout_of({layer("Normal", "XY")})).has(Role::normal));
    EXPECT_FALSE(detect(layout_of({layer("Normal", "V")})).has(Role::normal));
}

TEST(Roles, StereoViewIsChosen) {
    ImageLayout layout = layout_of({});
    layout.views = {"left", "right"};
    for (const char* c : {"X", "Y", "Z"}) {
        add_channel(layout, std::string("ViewLayer.Normal.") + c, SampleType::float32, "left");
        add_channel(layout, std::string("ViewLayer.Normal.right.") + c, SampleType::float32, "right");
    }
    add_channel(layout, "ViewLayer.Depth.left.Z", SampleType::float32, "left");
    add_channel(layout, "ViewLayer.Depth.right.Z", SampleType::float32, "right");
    add_channel(layout, "ViewLayer.roughness.X");
    const RoleAssignment left = assign_roles(layout, {}, "");
    EXPECT_EQ(left.view, "left");
    EXPECT_THAT(left.warnings, ElementsAre(HasSubstr("--view")));
    EXPECT_EQ(names_of(layout, left, Role::normal),
              (Names{"ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"}));
    EXPECT_EQ(names_of(layout, left, Role::depth), (Names{"ViewLayer.Depth.left.Z"}));
    const RoleAssignment right = assign_roles(layout, {}, "right");
    EXPECT_THAT(right.warnings, IsEmpty());
    EXPECT_EQ(names_of(layout, right, Role::normal),
              (Names{"ViewLayer.Normal.right.X", "ViewLayer.Normal.right.Y", "ViewLayer.Normal.right.Z"}));
    EXPECT_EQ(names_of(layout, right, Role::depth), (Names{"ViewLayer.Depth.right.Z"}));
    EXPECT_EQ(names_of(layout, right, Role::roughness), (Names{"ViewLayer.roughness.X"}));
}

TEST(Roles, UnknownViewListsTheViews) {
    ImageLayout layout = blender_layout();
    layout.views = {"left", "right"};
    try {
        (void)assign_roles(layout, {}, "righ");
        FAIL() << "an unknown view was accepted";
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), HasSubstr("left, right"));
        EXPECT_THAT(error.what(), HasSubstr("did you mean 'right'"));
    }
    layout.views.clear();
    EXPECT_THROW((void)assign_roles(layout, {}, "left"), UsageError);
}

TEST(Roles, WarnsOfHalfPositionsAndIds) {
    ImageLayout layout = blender_layout();
    EXPECT_THAT(detect(layout).warnings, IsEmpty());
    for (ChannelInfo& channel : layout.channels) {
        channel.type = SampleType::half;
    }
    const RoleAssignment roles = detect(layout);
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("position 'ViewLayer.Position' is stored as half")));
    EXPECT_THAT(roles.warnings, Contains(HasSubstr("above 2048")));
}

TEST(Roles, WarnsOfDwaOnDataChannels) {
    for (const char* compression : {"dwaa", "dwab"}) {
        ImageLayout layout = blender_layout();
        layout.parts[0].compression = compression;
        const RoleAssignment roles = detect(layout);
        EXPECT_THAT(roles.warnings, Contains(HasSubstr("ViewLayer.Normal.Y is damaged")));
        EXPECT_THAT(roles.warnings, Contains(HasSubstr("ViewLayer.Position.Y is damaged")));
        EXPECT_THAT(roles.warnings, Not(Contains(HasSubstr("Normal.X"))));
    }
}

TEST(Roles, WarnsOfOtherChromaticities) {
    ImageLayout layout = blender_layout();
    layout.strings["chromaticities"] = "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329";
    EXPECT_THAT(detect(layout).warnings, IsEmpty());
    layout.strings["chromaticities"] = "1 0 0 1 0 0 0.33333 0.33333";
    EXPECT_THAT(detect(layout).warnings, ElementsAre(HasSubstr("not Rec.709")));
}

TEST(Roles, ThousandsOfChannelsStayCheap) {
    ImageLayout layout = blender_layout();
    for (int i = 0; i < 20000; ++i) {
        add_channel(layout, "aov" + std::to_string(i) + ".R");
    }
    EXPECT_EQ(detect(layout)[Role::normal].layer, "ViewLayer.Normal");
}

} // namespace
} // namespace clshade
