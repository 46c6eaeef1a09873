// Plans: which planes a scene needs of a file and how they are bound.
#include "host/base/error.h"
#include "host/gbuffer/camera.h"
#include "host/gbuffer/frame_builder.h"
#include "tests/gbuffer/layouts.h"
#include "tests/gbuffer/plans.h"
#include "tests/gbuffer/views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace clshade {
namespace {

using testing::add_channel;
using ::testing::AllOf;
using testing::automatic_scene;
using testing::blender_layout;
using testing::camera_at;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::layer;
using testing::layout_of;
using ::testing::Not;
using testing::plain_scene;
using testing::plan_error;
using testing::plan_of;
using testing::plane_of;

using Names = std::vector<std::string>;

TEST(PlanFrame, ReadsOnlyWhatConstantsLeave) {
    const FramePlan plan = plan_of(blender_layout(), plain_scene());
    EXPECT_THAT(plan.frame.plane_names,
                ElementsAre("ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z", "ViewLayer.Position.X",
                            "ViewLayer.Position.Y", "ViewLayer.Position.Z", "ViewLayer.Depth.Z", "ViewLayer.UV.A"));
    EXPECT_EQ(plan.channels.size(), plan.frame.plane_names.size());
    EXPECT_EQ(plan.channels.size(), 8U);
    EXPECT_EQ(plan.frame.data_window, (Window{0, 0, 63, 31}));
    EXPECT_EQ(plan.frame.planes.count(), 0) << "planes cost memory that bands do not need";
    EXPECT_EQ(plane_of(plan, plan.frame.roles.depth), "ViewLayer.Depth.Z");
    EXPECT_EQ(plane_of(plan, plan.frame.roles.coverage), "ViewLayer.UV.A");
    EXPECT_EQ(plan.frame.roles.material_id, no_plane);
    EXPECT_TRUE(plan.frame.materials[0].base().f0.is_constant());
    EXPECT_EQ(plan.frame.materials[0].base().shininess.constant, glm::dvec3(64.0));
    EXPECT_FALSE(plan.frame.has_emission);
    EXPECT_FALSE(plan.recover_camera);
    EXPECT_EQ(plan.frame.file, "picture.exr");
}

TEST(PlanFrame, AutomaticMaterialFollowsTheRoles) {
    const FramePlan plan = plan_of(blender_layout(), automatic_scene());
    const BoundMaterial& material = plan.frame.materials[0];
    EXPECT_EQ(plane_of(plan, material.albedo.planes[2]), "ViewLayer.DiffCol.B");
    EXPECT_EQ(plane_of(plan, material.base().f0.planes[0]), "ViewLayer.f0.R");
    EXPECT_EQ(plane_of(plan, material.base().shininess.planes[0]), "ViewLayer.roughness.X");
    EXPECT_TRUE(material.base().shininess.is_grey());
    EXPECT_EQ(material.base().shininess.convert, Conversion::ggx_roughness);
    EXPECT_EQ(material.albedo.convert, Conversion::none);
    EXPECT_TRUE(material.albedo.averaged);
    EXPECT_TRUE(material.base().shininess.averaged);
}

TEST(PlanFrame, AutomaticMaterialFallsBack) {
    const ImageLayout with_shininess = layout_of({layer("N", "XYZ"), layer("shininess", "V")});
    const FramePlan plan = plan_of(with_shininess, automatic_scene());
    const BoundMaterial& material = plan.frame.materials[0];
    EXPECT_EQ(plane_of(plan, material.base().shininess.planes[0]), "shininess.V");
    EXPECT_EQ(material.base().shininess.convert, Conversion::none);
    EXPECT_EQ(material.albedo.constant, glm::dvec3(0.5));
    EXPECT_EQ(material.base().f0.constant, glm::dvec3(0.04));
    const FramePlan bare = plan_of(layout_of({layer("N", "XYZ")}), automatic_scene());
    EXPECT_EQ(bare.frame.materials[0].base().shininess.constant, glm::dvec3(64.0));
    EXPECT_EQ(bare.channels.size(), 3U);
}

TEST(PlanFrame, UnusedParametersAreNotRead) {
    Scene scene = plain_scene();
    Material& material = scene.materials[0];
    material.base().f0 = Parameter::from("f0");
    material.base().shininess = Parameter::from("roughness", Conversion::ggx_roughness);
    material.diffuse.albedo = Parameter::from("albedo");
    material.diffuse.shininess = Parameter::from("metallic");
    const auto reads = [&] { return plan_of(blender_layout(), scene).frame.plane_names; };
    EXPECT_THAT(reads(), AllOf(Contains("ViewLayer.f0.R"), Contains("ViewLayer.roughness.X"),
                               Contains("ViewLayer.DiffCol.R"), Not(Contains("ViewLayer.metallic.X"))));
    material.diffuse.model = DiffuseModel::oren_nayar;
    EXPECT_THAT(reads(), Contains("ViewLayer.metallic.X"));
    material.base().model = SpecularModel::none;
    EXPECT_THAT(reads(), AllOf(Not(Contains("ViewLayer.f0.R")), Not(Contains("ViewLayer.roughness.X"))));
    material.diffuse.shininess.reset(); // now the specular shininess stands in, though there is no lobe
    const FramePlan plan = plan_of(blender_layout(), scene);
    EXPECT_EQ(plane_of(plan, plan.frame.materials[0].diffuse_shininess.planes[0]), "ViewLayer.roughness.X");
    EXPECT_EQ(plan.frame.materials[0].diffuse_shininess.convert, Conversion::ggx_roughness);
    material.diffuse.model = DiffuseModel::none;
    EXPECT_THAT(reads(), AllOf(Not(Contains("ViewLayer.DiffCol.R")), Not(Contains("ViewLayer.roughness.X"))));
}

TEST(PlanFrame, AChannelIsReadOnceHoweverOftenUsed) {
    Scene scene = plain_scene();
    scene.materials[0].base().f0 = Parameter::from("f0");
    scene.materials[0].diffuse.albedo = Parameter::from("f0");
    const FramePlan plan = plan_of(blender_layout(), scene);
    EXPECT_EQ(plan.frame.materials[0].base().f0.planes, plan.frame.materials[0].albedo.planes);
    EXPECT_EQ(std::count(plan.frame.plane_names.begin(), plan.frame.plane_names.end(), "ViewLayer.f0.G"), 1);
}

TEST(PlanFrame, ScaleOffsetAndConversionGoWithThePlane) {
    Scene scene = plain_scene();
    Parameter shininess = Parameter::from("roughness", Conversion::smoothness);
    shininess.scale = 2.0;
    shininess.offset = 0.25;
    scene.materials[0].base().shininess = shininess;
    const FramePlan plan = plan_of(blender_layout(), scene);
    const BoundParameter& bound = plan.frame.materials[0].base().shininess;
    EXPECT_EQ(bound.scale, 2.0);
    EXPECT_EQ(bound.offset, 0.25);
    EXPECT_EQ(bound.convert, Conversion::smoothness);
}

TEST(PlanFrame, AConstantIsConvertedAtOnce) {
    Scene scene = plain_scene();
    Parameter shininess = Parameter::of(0.25);
    shininess.scale = 2.0;
    shininess.convert = Conversion::ggx_roughness; // r = 0.5: 2 / 0.0625 - 2
    scene.materials[0].base().shininess = shininess;
    const BoundParameter bound = plan_of(blender_layout(), scene).frame.materials[0].base().shininess;
    EXPECT_DOUBLE_EQ(bound.constant.x, 30.0);
    EXPECT_EQ(bound.convert, Conversion::none);
    EXPECT_EQ(bound.scale, 1.0);
    shininess.constant = glm::dvec3(0.0);
    scene.materials[0].base().shininess = shininess;
    EXPECT_GE(plan_of(blender_layout(), scene).frame.materials[0].base().shininess.constant.x, 65536.0);
}

TEST(PlanFrame, AScalarTakesOneChannel) {
    Scene scene = plain_scene();
    scene.materials[0].base().shininess = Parameter::from("f0");
    EXPECT_THAT(plan_error(blender_layout(), scene), AllOf(HasSubstr("material 'default', specular shininess"),
                                                           HasSubstr("3 channels"), HasSubstr("ViewLayer.f0.R")));
}

TEST(PlanFrame, IdsAreReadForMaterialsThatHaveThem) {
    Scene scene = plain_scene();
    Material paint;
    paint.name = "paint";
    paint.ids = {3, 7};
    scene.materials.push_back(paint);
    const FramePlan plan = plan_of(blender_layout(), scene);
    EXPECT_EQ(plane_of(plan, plan.frame.roles.material_id), "ViewLayer.IndexMA.X");
    EXPECT_THAT(plan.frame.materials[1].ids, ElementsAre(3, 7));
    EXPECT_THAT(plan_error(layout_of({layer("N", "XYZ"), {"id"}}), scene),
                AllOf(HasSubstr("no material_id"), HasSubstr("ids of the materials"), HasSubstr("id numbers objects")));
}

TEST(PlanFrame, EmissionOnlyWhereTheSceneMapsIt) {
    Scene scene = plain_scene();
    EXPECT_FALSE(plan_of(blender_layout(), scene).frame.has_emission);
    scene.emission_mapped = true;
    scene.gbuffer = testing::settings_with("emission", {"ViewLayer.Emit"});
    const FramePlan plan = plan_of(blender_layout(), scene);
    ASSERT_TRUE(plan.frame.has_emission);
    EXPECT_EQ(plane_of(plan, plan.frame.emission.planes[0]), "ViewLayer.Emit.R");
    EXPECT_TRUE(plan.frame.emission.averaged);
    scene.gbuffer = testing::settings_with("emission", {"none"});
    EXPECT_FALSE(plan_of(blender_layout(), scene).frame.has_emission);
}

TEST(PlanFrame, AMissingNormalIsAnErrorThatHelps) {
    const std::string error = plan_error(layout_of({layer("beauty", "RGBA"), layer("depth", "Z")}), plain_scene());
    EXPECT_THAT(error, AllOf(HasSubstr("picture.exr: no normal"), HasSubstr("beauty, depth"),
                             HasSubstr("normal = \"LAYER\" in [gbuffer]")));
}

TEST(PlanFrame, AmbiguityMattersOnlyWhereUsed) {
    ImageLayout layout = layout_of({layer("N", "XYZ"), layer("a.albedo", "RGB"), layer("b.albedo", "RGB")});
    EXPECT_EQ(plan_error(layout, plain_scene()), "no error");
    EXPECT_THAT(plan_error(layout, automatic_scene()), HasSubstr("may be a.albedo, b.albedo"));
    layout = layout_of({layer("a.Normal", "XYZ"), layer("b.Normal", "XYZ")});
    EXPECT_THAT(plan_error(layout, plain_scene()), HasSubstr("normal may be a.Normal, b.Normal"));
    layout = layout_of({layer("N", "XYZ"), layer("a.Depth", "Z"), layer("b.Depth", "Z")});
    EXPECT_THAT(plan_error(layout, plain_scene()), HasSubstr("depth = \"a.Depth\" in [gbuffer]"));
}

TEST(PlanFrame, KeepPassesLayersThrough) {
    const FramePlan plan =
        plan_of(blender_layout(), plain_scene(), {"Combined", "ViewLayer.Normal", "ViewLayer.Mist.Z"});
    Names kept;
    for (const int plane : plan.keep) {
        kept.push_back(plane_of(plan, plane));
    }
    EXPECT_THAT(kept,
                ::testing::UnorderedElementsAre("ViewLayer.Combined.A", "ViewLayer.Combined.B", "ViewLayer.Combined.G",
                                                "ViewLayer.Combined.R", "ViewLayer.Normal.X", "ViewLayer.Normal.Y",
                                                "ViewLayer.Normal.Z", "ViewLayer.Mist.Z"));
    EXPECT_EQ(plan.channels.size(), 8U + 5U); // the normal is read anyway
    EXPECT_THAT(plan_error(blender_layout(), plain_scene(), {"Combned"}),
                AllOf(HasSubstr("--keep"), HasSubstr("did you mean 'Combined'?")));
}

ImageLayout two_parts(const Window& second) {
    ImageLayout layout = layout_of({layer("N", "XYZ")});
    layout.parts.push_back(layout.parts[0]);
    layout.parts[0].name = "normals";
    layout.parts[1].name = "depths";
    layout.parts[1].data_window = second;
    add_channel(layout, "Z", SampleType::float32, "", 1);
    return layout;
}

TEST(PlanFrame, DataWindowIsTheUnionOfThePartsUsed) {
    const FramePlan plan = plan_of(two_parts({40, -10, 99, 20}), plain_scene());
    EXPECT_EQ(plan.frame.data_window, (Window{0, -10, 99, 31}));
    EXPECT_EQ(plan.frame.display_window, (Window{0, 0, 63, 31}));
    // A part nobody reads does not count.
    Scene scene = plain_scene();
    scene.gbuffer = testing::settings_with("depth", {"none"});
    EXPECT_EQ(plan_of(two_parts({40, -10, 99, 20}), scene).frame.data_window, (Window{0, 0, 63, 31}));
}

TEST(PlanFrame, WindowsThatDoNotOverlapAreRefused) {
    EXPECT_THAT(plan_error(two_parts({64, 0, 90, 31}), plain_scene()),
                AllOf(HasSubstr("'normals' (0, 0)-(63, 31)"), HasSubstr("'depths'"), HasSubstr("do not overlap")));
    EXPECT_EQ(plan_error(two_parts({63, 31, 90, 40}), plain_scene()), "no error");
}

TEST(PlanFrame, TheSceneCameraWins) {
    ImageLayout layout = blender_layout();
    layout.matrices["worldToCamera"] = glm::dmat4(1.0);
    const FramePlan plan = plan_of(layout, plain_scene());
    EXPECT_LT(glm::length(plan.frame.view.eye - glm::dvec3(0, -5, 0)), 1e-12);
    EXPECT_TRUE(plan.frame.view.has_rays);
    EXPECT_FALSE(plan.recover_camera);
}

TEST(PlanFrame, TheHeaderCameraIsNext) {
    ImageLayout layout = layout_of({layer("N", "XYZ")});
    layout.display_window = layout.parts[0].data_window = {0, 0, 31, 31};
    layout.matrices["worldToCamera"] = glm::dmat4(1.0);
    layout.matrices["worldToCamera"][3] = glm::dvec4(1.0, 2.0, 3.0, 1.0); // translation in the last row
    layout.numbers["CameraFov"] = 45.0;
    Scene scene = plain_scene();
    scene.camera.reset();
    const FramePlan plan = plan_of(layout, scene);
    EXPECT_EQ(plan.frame.view.eye, glm::dvec3(-1.0, -2.0, -3.0));
    EXPECT_FALSE(plan.recover_camera);
    layout.numbers.clear(); // an eye is not enough without positions
    EXPECT_THAT(plan_error(layout, scene), AllOf(HasSubstr("worldToCamera"), HasSubstr("[camera]")));
}

TEST(PlanFrame, WithoutACameraPositionsOrAnError) {
    Scene scene = plain_scene();
    scene.camera.reset();
    EXPECT_TRUE(plan_of(blender_layout(), scene).recover_camera);
    EXPECT_THAT(plan_error(layout_of({layer("N", "XYZ"), layer("Z", "V")}), scene),
                AllOf(HasSubstr("no camera"), HasSubstr("[camera]"), HasSubstr("matrix_world"),
                      HasSubstr("fov_y_degrees"), HasSubstr("orthographic_height")));
}

TEST(PlanFrame, ASceneCameraWithoutALensNeedsPositions) {
    Scene scene = plain_scene();
    scene.camera->lens = Lens::unknown;
    EXPECT_EQ(plan_error(blender_layout(), scene), "no error");
    EXPECT_THAT(plan_error(layout_of({layer("N", "XYZ"), layer("Z", "V")}), scene), HasSubstr("fov_y_degrees"));
}

TEST(PlanFrame, PlanesAreAllocatedForTheWholePicture) {
    FramePlan plan = plan_of(blender_layout(), plain_scene());
    allocate_planes(plan);
    EXPECT_EQ(plan.frame.planes.count(), 8);
    EXPECT_EQ(plan.frame.planes.width(), 64);
    EXPECT_EQ(plan.frame.planes.height(), 32);
    EXPECT_EQ(plan.frame.planes.at(7, 63, 31), 0.0F);
}

TEST(PlanFrame, WarningsOfFileAndRolesArePassedOn) {
    ImageLayout layout = blender_layout();
    layout.warnings = {"an oddity"};
    layout.parts[0].compression = "dwaa";
    const FramePlan plan = plan_of(layout, plain_scene());
    EXPECT_THAT(plan.frame.warnings, AllOf(Contains("an oddity"), Contains(HasSubstr("dwaa"))));
}

View view_from_camera_of(const Camera& camera, const ImageLayout& layout) {
    return view_from_camera(camera, layout.parts[0].data_window, layout.display_window, layout.pixel_aspect);
}

FramePlan allocated_plan(const ImageLayout& layout, const Scene& scene) {
    FramePlan plan = plan_of(layout, scene);
    allocate_planes(plan);
    return plan;
}

/// A plan whose planes hold what `view` sees; roles as plan_frame binds them for Normal, Position, Depth and UV.A.
FramePlan filled_plan(const ImageLayout& layout, const Scene& scene, const View& view) {
    FramePlan plan = allocated_plan(layout, scene);
    const Frame seen =
        testing::make_frame(view, plan.frame.data_window, plan.frame.display_window, 1.0, testing::blocks);
    const RolePlanes& roles = plan.frame.roles;
    for (int y = 0; y < seen.planes.height(); ++y) {
        for (int x = 0; x < seen.planes.width(); ++x) {
            for (int i = 0; i < 3; ++i) {
                plan.frame.planes.at(roles.position[static_cast<std::size_t>(i)], x, y) = seen.planes.at(i, x, y);
            }
            plan.frame.planes.at(roles.depth, x, y) = seen.planes.at(testing::depth_plane, x, y);
            plan.frame.planes.at(roles.coverage, x, y) = seen.planes.at(testing::coverage_plane, x, y);
        }
    }
    return plan;
}

Light camera_light() {
    Light light;
    light.in_camera_space = true;
    light.direction = {0.0, 0.0, -1.0}; // as the camera looks
    light.position = {0.0, 0.0, 0.0};   // at the camera
    return light;
}

TEST(FinishFrame, RecoversTheCameraAndTurnsLights) {
    const ImageLayout layout = blender_layout();
    const Camera camera = camera_at({2, -9, 4}, {0, 0, 1}, Lens::fov_y, 0.7);
    const View view = view_from_camera_of(camera, layout);
    Scene scene = plain_scene();
    scene.camera.reset();
    scene.lights = {camera_light(), Light()};
    scene.lights[1].direction = {1.0, 0.0, 0.0};
    const Frame frame = finish_frame(filled_plan(layout, scene, view));
    EXPECT_LT(glm::length(frame.view.eye - glm::dvec3(2, -9, 4)), 1e-3);
    EXPECT_FALSE(frame.lights[0].in_camera_space);
    EXPECT_LT(glm::length(frame.lights[0].direction - view.view_axis), 1e-4);
    EXPECT_LT(glm::length(frame.lights[0].position - view.eye), 1e-3);
    EXPECT_EQ(frame.lights[1].direction, glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_THAT(frame.notes, ElementsAre(HasSubstr("camera recovered from Position: median error")));
}

TEST(FinishFrame, ChecksAGivenCameraAgainstThePositions) {
    const ImageLayout layout = blender_layout();
    Scene scene = plain_scene();
    scene.camera = camera_at({2, -9, 4}, {0, 0, 1}, Lens::fov_y, 0.7);
    const View view = view_from_camera_of(*scene.camera, layout);
    EXPECT_THAT(finish_frame(filled_plan(layout, scene, view)).warnings, IsEmpty());
    scene.camera = camera_at({2, -9, 4}, {1, 0, 1}, Lens::fov_y, 0.7);
    EXPECT_THAT(finish_frame(filled_plan(layout, scene, view)).warnings,
                ElementsAre(AllOf(HasSubstr("camera and Position disagree"), HasSubstr(" px"))));
}

TEST(FinishFrame, AnEyeFromTheHeaderIsKeptWhenNothingBetterCanBeHad) {
    ImageLayout layout = blender_layout();
    layout.matrices["worldToCamera"] = glm::dmat4(1.0);
    layout.matrices["worldToCamera"][3] = glm::dvec4(1.0, 2.0, 3.0, 1.0);
    Scene scene = plain_scene();
    scene.camera.reset();
    const Frame frame = finish_frame(allocated_plan(layout, scene)); // planes of zeros: nothing to recover from
    EXPECT_EQ(frame.view.eye, glm::dvec3(-1.0, -2.0, -3.0));
    EXPECT_FALSE(frame.view.has_rays);
    EXPECT_THAT(frame.warnings, ElementsAre(HasSubstr("only the eye is known")));
    layout.matrices.clear();
    EXPECT_THROW((void)finish_frame(allocated_plan(layout, scene)), UsageError);
}

TEST(OutputPlanes, NamesInOrder) {
    Frame frame;
    frame.lights.resize(2);
    frame.lights[0].name = "key";
    frame.lights[1].name = "rim";
    EXPECT_THAT(output_plane_names(frame, {}), ElementsAre("R", "G", "B", "A"));
    EXPECT_THAT(output_plane_names(frame, {true, true, true}),
                ElementsAre("R", "G", "B", "A", "diffuse.R", "diffuse.G", "diffuse.B", "specular.R", "specular.G",
                            "specular.B", "light.key.R", "light.key.G", "light.key.B", "light.rim.R", "light.rim.G",
                            "light.rim.B"));
    AovSelection with_environment;
    with_environment.lights = true;
    with_environment.environment = true;
    EXPECT_THAT(output_plane_names(frame, with_environment), Not(Contains("environment.R"))); // it has none
    frame.environment.emplace();
    EXPECT_THAT(output_plane_names(frame, with_environment),
                ElementsAre("R", "G", "B", "A", "light.key.R", "light.key.G", "light.key.B", "light.rim.R",
                            "light.rim.G", "light.rim.B", "environment.R", "environment.G", "environment.B"));
    EXPECT_THAT(output_plane_names(frame, {}), ElementsAre("R", "G", "B", "A"));
}

} // namespace
} // namespace clshade
