// [gbuffer] overrides and the channels of material parameters.
#include "host/base/error.h"
#include "host/gbuffer/roles.h"
#include "tests/gbuffer/layouts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace clshade {
namespace {

using ::testing::AllOf;
using testing::blender_layout;
using ::testing::HasSubstr;
using testing::layer;
using testing::layout_of;
using testing::names_of;
using testing::settings_with;

using Names = std::vector<std::string>;

/// The channels an override gives a role.
Names overridden(const ImageLayout& layout, Role role, const Names& channels) {
    const RoleAssignment roles = assign_roles(layout, settings_with(std::string(name_of(role)), channels), "");
    return names_of(layout, roles, role);
}

std::string override_error(const ImageLayout& layout, const std::string& role, const Names& channels) {
    try {
        (void)assign_roles(layout, settings_with(role, channels), "");
    } catch (const UsageError& error) {
        return error.what();
    }
    return "no error";
}

std::string parameter_error(const ImageLayout& layout, const Parameter& parameter) {
    try {
        (void)find_channels(layout, assign_roles(layout, {}, ""), parameter, "material 'paint', albedo");
    } catch (const UsageError& error) {
        return error.what();
    }
    return "no error";
}

TEST(RoleOverrides, TakeALayerAListOrOneChannel) {
    const ImageLayout layout = blender_layout();
    EXPECT_EQ(overridden(layout, Role::albedo, {"ViewLayer.basecolor"}),
              (Names{"ViewLayer.basecolor.R", "ViewLayer.basecolor.G", "ViewLayer.basecolor.B"}));
    EXPECT_EQ(overridden(layout, Role::normal, {"ViewLayer.Position.Z", "ViewLayer.Position.Y", "ViewLayer.Normal.X"}),
              (Names{"ViewLayer.Position.Z", "ViewLayer.Position.Y", "ViewLayer.Normal.X"}));
    EXPECT_EQ(overridden(layout, Role::coverage, {"ViewLayer.Combined.A"}), (Names{"ViewLayer.Combined.A"}));
    EXPECT_EQ(overridden(layout, Role::roughness, {"ViewLayer.metallic"}), (Names{"ViewLayer.metallic.X"}));
    EXPECT_EQ(overridden(layout, Role::depth, {"ViewLayer.Mist"}), (Names{"ViewLayer.Mist.Z"}));
}

TEST(RoleOverrides, MayLeaveOutTheViewLayer) {
    const ImageLayout layout = blender_layout("Some.View Layer");
    EXPECT_EQ(overridden(layout, Role::albedo, {"GlossCol"}),
              (Names{"Some.View Layer.GlossCol.R", "Some.View Layer.GlossCol.G", "Some.View Layer.GlossCol.B"}));
    EXPECT_EQ(overridden(layout, Role::coverage, {"Combined.A"}), (Names{"Some.View Layer.Combined.A"}));
}

TEST(RoleOverrides, AOneChannelPlaneFillsAColour) {
    EXPECT_EQ(overridden(blender_layout(), Role::f0, {"ViewLayer.metallic"}), (Names{"ViewLayer.metallic.X"}));
}

TEST(RoleOverrides, NoneEmptiesARole) {
    const ImageLayout layout = blender_layout();
    const RoleAssignment roles = assign_roles(layout, settings_with("coverage", {"none"}), "");
    EXPECT_FALSE(roles.has(Role::coverage));
    EXPECT_TRUE(roles[Role::coverage].ambiguous.empty());
}

TEST(RoleOverrides, SayTheSceneFile) {
    const RoleAssignment roles = assign_roles(blender_layout(), settings_with("albedo", {"ViewLayer.basecolor"}), "");
    EXPECT_EQ(roles[Role::albedo].rule, "[gbuffer] in scene.toml");
    EXPECT_EQ(roles[Role::albedo].layer, "ViewLayer.basecolor");
    EXPECT_EQ(roles[Role::albedo].runners_up, (Names{"ViewLayer.DiffCol"}));
}

TEST(RoleOverrides, MisspeltNamesGetASuggestion) {
    const ImageLayout layout = blender_layout();
    EXPECT_THAT(
        override_error(layout, "normal", {"ViewLayer.Norml"}),
        AllOf(HasSubstr("scene.toml:12:5: "), HasSubstr("did you mean 'ViewLayer.Normal'?"), HasSubstr("picture.exr")));
    EXPECT_THAT(override_error(layout, "normal", {"Norml"}), HasSubstr("did you mean 'Normal'?"));
    EXPECT_THAT(override_error(layout, "normal", {"viewlayer.normal"}), HasSubstr("did you mean 'ViewLayer.Normal'?"));
    EXPECT_THAT(override_error(layout, "depth", {"ViewLayer.Depth.Y"}), HasSubstr("did you mean 'ViewLayer.Depth"));
    EXPECT_THAT(override_error(layout, "normal", {"quite different"}), HasSubstr("it has ViewLayer.Combined"));
    EXPECT_THAT(override_error(layout, "normals", {"ViewLayer.Normal"}), HasSubstr("did you mean 'normal'?"));
}

TEST(RoleOverrides, ShapesMustFit) {
    const ImageLayout layout = blender_layout();
    EXPECT_THAT(override_error(layout, "normal", {"ViewLayer.Depth"}), HasSubstr("three channels"));
    EXPECT_THAT(override_error(layout, "normal", {"ViewLayer.Depth.Z"}), HasSubstr("three channels"));
    EXPECT_THAT(override_error(layout, "depth", {"ViewLayer.Normal"}), HasSubstr("one channel is needed"));
    EXPECT_THAT(override_error(layout, "depth", {"ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"}),
                HasSubstr("one channel is needed"));
    EXPECT_THAT(override_error(layout, "normal", {"ViewLayer.Normal.X", "ViewLayer.Normal.Y"}),
                HasSubstr("three channels"));
    EXPECT_THAT(override_error(layout, "albedo", {"ViewLayer.UV"}), HasSubstr("ViewLayer.UV.U"));
}

TEST(RoleOverrides, TwoViewLayersNeedTheFullName) {
    ImageLayout layout = blender_layout("A");
    const ImageLayout other = blender_layout("B");
    layout.channels.insert(layout.channels.end(), other.channels.begin(), other.channels.end());
    EXPECT_THAT(override_error(layout, "normal", {"Normal"}), HasSubstr("may be A.Normal, B.Normal"));
}

TEST(FindChannels, RoleThenLayerThenChannel) {
    const ImageLayout layout = blender_layout();
    const RoleAssignment roles = assign_roles(layout, {}, "");
    const auto find = [&](const Parameter& parameter) {
        return names_of(layout, find_channels(layout, roles, parameter, "x"));
    };
    EXPECT_EQ(find(Parameter::from("albedo")),
              (Names{"ViewLayer.DiffCol.R", "ViewLayer.DiffCol.G", "ViewLayer.DiffCol.B"}));
    EXPECT_EQ(find(Parameter::from("basecolor")),
              (Names{"ViewLayer.basecolor.R", "ViewLayer.basecolor.G", "ViewLayer.basecolor.B"}));
    EXPECT_EQ(find(Parameter::from("ViewLayer.GlossCol.G")), (Names{"ViewLayer.GlossCol.G"}));
    EXPECT_EQ(find(Parameter::from("ViewLayer.Mist")), (Names{"ViewLayer.Mist.Z"}));
    Parameter three;
    three.channels = {"ViewLayer.f0.B", "ViewLayer.f0.G", "metallic"};
    EXPECT_EQ(find(three), (Names{"ViewLayer.f0.B", "ViewLayer.f0.G", "ViewLayer.metallic.X"}));
}

TEST(FindChannels, AnEmptyRoleThatIsALayersNameIsTheLayer) {
    const ImageLayout layout = layout_of({layer("N", "XYZ"), layer("emission", "XY"), layer("shininess", "RGB")});
    const RoleAssignment roles = assign_roles(layout, settings_with("shininess", {"none"}), "");
    EXPECT_EQ(names_of(layout, find_channels(layout, roles, Parameter::from("shininess"), "x")),
              (Names{"shininess.R", "shininess.G", "shininess.B"}));
}

TEST(FindChannels, ErrorsNameTheMaterial) {
    const ImageLayout layout = blender_layout();
    EXPECT_THAT(parameter_error(layout, Parameter::from("DifCol")),
                AllOf(HasSubstr("material 'paint', albedo"), HasSubstr("did you mean 'DiffCol'?")));
    EXPECT_THAT(parameter_error(layout, Parameter::from("shininess")),
                AllOf(HasSubstr("role 'shininess'"), HasSubstr("is empty")));
    EXPECT_THAT(parameter_error(layout, Parameter::from("UV")), HasSubstr("one channel or three"));
    Parameter placed = Parameter::from("nothing like it");
    placed.where = {"scene.toml", 7, 3};
    EXPECT_THAT(parameter_error(layout, placed), ::testing::StartsWith("scene.toml:7:3: material 'paint', albedo: "));
}

TEST(FindChannels, AnAmbiguousRoleIsRefused) {
    ImageLayout layout = layout_of({layer("N", "XYZ"), layer("a.albedo", "RGB"), layer("b.albedo", "RGB")});
    EXPECT_THAT(parameter_error(layout, Parameter::from("albedo")), HasSubstr("may be a.albedo, b.albedo"));
}

} // namespace
} // namespace clshade
