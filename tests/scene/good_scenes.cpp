// What a correct scene means.
#include "tests/scene/support.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clshade {
namespace {

using testing::ElementsAre;

/// The example of the public interface, and a little more.
constexpr std::string_view full_example = R"(version = 1
units = "metres"

[camera]
matrix_world = [[1,0,0,2],[0,1,0,3],[0,0,1,5],[0,0,0,1]]
fov_y_degrees = 39.6

[gbuffer]
normal = "ViewLayer.Normal"
position = ["P.X", "P.Y", "P.Z"]
albedo = "none"
normal_space = "camera"
normal_encoding = "unorm"
depth_kind = "ray"

[[light]]
name = "key"
type = "distant"
direction = [0.3, -0.5, -0.8]
irradiance = 3.0
color = [1.0, 0.95, 0.9]

[[light]]
name = "lamp"
type = "spot"
position = [2.0, 1.0, 3.0]
direction = [0, 0, -1]
intensity = 40.0
cone_angle_degrees = 30.0
cone_softness = 0.2

[[light]]
type = "point"
position = [1, 2, 3]
intensity = 5
color = 0.5

[environment]
image = "studio.hdr"
intensity = 1.0
up = "z"
rotation_degrees = 0.0
diffuse = "sh2"

[output]
background = false

[material.default]
specular = { model = "blinn_phong", f0 = 0.04, shininess = { channel = "roughness", convert = "ggx_roughness" } }
diffuse  = { model = "oren_nayar", albedo = "albedo", shininess = 12.0 }

[material.wax]
ids = [3, 7]
fresnel = "constant"
specular = { model = "blinn_phong_exact", ior = 1.5, shininess = 512 }
diffuse  = { model = "lambert", albedo = { channel = ["a.R", "a.G", "a.B"], scale = 2, offset = -0.5 } }
)";

TEST(Scene, ReadsCameraAndGBuffer) {
    const Scene scene = parse(full_example);
    EXPECT_EQ(scene.file, "scene.toml");
    ASSERT_TRUE(scene.camera.has_value());
    EXPECT_EQ(scene.camera->matrix_world[3], glm::dvec4(2, 3, 5, 1)); // the last column holds the position
    EXPECT_EQ(scene.camera->lens, Lens::fov_y);
    EXPECT_DOUBLE_EQ(scene.camera->lens_value, 39.6 * glm::pi<double>() / 180.0);
    EXPECT_EQ(scene.gbuffer.normal_space, NormalSpace::camera);
    EXPECT_EQ(scene.gbuffer.normal_encoding, NormalEncoding::unorm);
    EXPECT_EQ(scene.gbuffer.depth_kind, DepthKind::ray);
    ASSERT_EQ(scene.gbuffer.roles.size(), 3U);
    EXPECT_EQ(scene.gbuffer.roles[0].role, "normal");
    EXPECT_THAT(scene.gbuffer.roles[0].channels, ElementsAre("ViewLayer.Normal"));
    EXPECT_EQ(scene.gbuffer.roles[0].where.line, 9);
    EXPECT_THAT(scene.gbuffer.roles[1].channels, ElementsAre("P.X", "P.Y", "P.Z"));
    EXPECT_THAT(scene.gbuffer.roles[2].channels, ElementsAre("none"));
    EXPECT_FALSE(scene.emission_mapped);
}

TEST(Scene, ReadsLights) {
    const Scene scene = parse(full_example);
    ASSERT_EQ(scene.lights.size(), 3U);
    const Light& key = scene.lights[0];
    EXPECT_EQ(key.type, LightType::distant);
    EXPECT_EQ(key.direction, glm::dvec3(0.3, -0.5, -0.8));
    EXPECT_EQ(key.power, 3.0 * glm::dvec3(1.0, 0.95, 0.9));
    EXPECT_FALSE(key.in_camera_space);
    const Light& lamp = scene.lights[1];
    EXPECT_EQ(lamp.type, LightType::spot);
    EXPECT_EQ(lamp.position, glm::dvec3(2, 1, 3));
    EXPECT_EQ(lamp.power, glm::dvec3(40.0));
    EXPECT_DOUBLE_EQ(lamp.cone_angle, glm::pi<double>() / 6.0);
    EXPECT_EQ(lamp.cone_softness, 0.2);
    EXPECT_EQ(scene.lights[2].name, "light3"); // named by place
    EXPECT_EQ(scene.lights[2].type, LightType::point);
    EXPECT_EQ(scene.lights[2].power, glm::dvec3(2.5)); // a grey colour is one number
}

TEST(Scene, ReadsTheEnvironment) {
    const Scene scene = parse(full_example);
    ASSERT_TRUE(scene.environment.has_value());
    EXPECT_EQ(scene.environment->image, "studio.hdr");
    EXPECT_EQ(scene.environment->up, UpAxis::z);
    EXPECT_EQ(scene.environment->where.line, 38);
    EXPECT_FALSE(scene.background);
}

TEST(Scene, ReadsMaterials) {
    const Scene scene = parse(full_example);
    EXPECT_FALSE(scene.automatic_material);
    EXPECT_FALSE(scene.automatic.albedo || scene.automatic.f0 || scene.automatic.shininess);
    ASSERT_EQ(scene.materials.size(), 2U);
    const Material& base = scene.materials[0];
    EXPECT_EQ(base.name, "default");
    EXPECT_TRUE(base.ids.empty());
    EXPECT_EQ(base.base().model, SpecularModel::blinn_phong);
    EXPECT_EQ(base.base().f0.constant, glm::dvec3(0.04));
    EXPECT_THAT(base.base().shininess.channels, ElementsAre("roughness"));
    EXPECT_EQ(base.base().shininess.convert, Conversion::ggx_roughness);
    EXPECT_EQ(base.diffuse.model, DiffuseModel::oren_nayar);
    EXPECT_THAT(base.diffuse.albedo.channels, ElementsAre("albedo"));
    ASSERT_TRUE(base.diffuse.shininess.has_value());
    EXPECT_EQ(base.diffuse.shininess->constant, glm::dvec3(12.0));
    const Material& wax = scene.materials[1];
    EXPECT_EQ(wax.name, "wax");
    EXPECT_THAT(wax.ids, ElementsAre(3, 7));
    EXPECT_EQ(wax.base().model, SpecularModel::blinn_phong_exact);
    EXPECT_NEAR(wax.base().f0.constant.g, 0.04, 1e-15); // (0.5 / 2.5)^2, to rounding
    EXPECT_EQ(wax.base().shininess.constant, glm::dvec3(512.0));
    EXPECT_THAT(wax.diffuse.albedo.channels, ElementsAre("a.R", "a.G", "a.B"));
    EXPECT_EQ(wax.diffuse.albedo.scale, 2.0);
    EXPECT_EQ(wax.diffuse.albedo.offset, -0.5);
    EXPECT_FALSE(wax.diffuse.shininess.has_value());
}

TEST(Scene, DefaultMaterialComesFirstAndOthersInFileOrder) {
    const Scene scene = parse(head + "[material.zinc]\nids = [1]\nspecular = {}\n[material.default]\ndiffuse = {}\n"
                                     "[material.alu]\nids = [2]\nspecular = {}\n");
    ASSERT_EQ(scene.materials.size(), 3U);
    EXPECT_EQ(scene.materials[0].name, "default");
    EXPECT_EQ(scene.materials[1].name, "zinc");
    EXPECT_EQ(scene.materials[2].name, "alu");
}

TEST(Scene, AbsentLobeOfAWrittenMaterialIsNone) {
    const Scene scene =
        parse(head + "[material.default]\nspecular = {}\n[material.chalk]\nids = [1]\ndiffuse = { albedo = 0.9 }\n");
    EXPECT_EQ(scene.materials[0].base().model, SpecularModel::blinn_phong);
    EXPECT_EQ(scene.materials[0].base().shininess.constant.x, 64.0);
    EXPECT_EQ(scene.materials[0].diffuse.model, DiffuseModel::none);
    EXPECT_EQ(scene.materials[1].base().model, SpecularModel::none);
    EXPECT_EQ(scene.materials[1].diffuse.model, DiffuseModel::lambert);
}

TEST(Scene, OneLayerIsTheMaterialItself) {
    const Scene scene = parse(head + "[material.paint]\nids = [4]\n[[material.paint.layer]]\n"
                                     "specular = { shininess = 99 }\ndiffuse = { albedo = [0.1, 0.2, 0.3] }\n");
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.materials[1].base().shininess.constant.x, 99.0);
    EXPECT_EQ(scene.materials[1].diffuse.albedo.constant, glm::dvec3(0.1, 0.2, 0.3));
}

TEST(Scene, WithoutMaterialsEverythingIsAutomatic) {
    const Scene scene = parse(head);
    EXPECT_TRUE(scene.automatic_material);
    EXPECT_TRUE(scene.automatic.albedo && scene.automatic.f0 && scene.automatic.shininess);
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].base().model, SpecularModel::blinn_phong);
    EXPECT_EQ(scene.materials[0].diffuse.model, DiffuseModel::lambert);
}

TEST(Scene, DefaultIsAutomaticBesideOtherMaterials) {
    const Scene scene = parse(head + "[material.chalk]\nids = [1]\ndiffuse = {}\n");
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_TRUE(scene.automatic_material);
    EXPECT_TRUE(scene.automatic.f0);
    EXPECT_EQ(scene.materials[0].diffuse.model, DiffuseModel::lambert);
}

TEST(Scene, EmissionAloneLightsAScene) {
    const Scene scene = parse("version = 1\n[gbuffer]\nemission = 'Emit'\n");
    EXPECT_TRUE(scene.emission_mapped);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_FALSE(parse(head + "[gbuffer]\nemission = 'none'\n").emission_mapped);
}

TEST(Scene, EndsOfRangesAreAllowed) {
    const Scene scene = parse("version = 1\n[[light]]\ntype = 'spot'\nposition = [0,0,0]\ndirection = [0,0,1e-6]\n"
                              "intensity = 0\ncone_angle_degrees = 180\ncone_softness = 1\n"
                              "[material.default]\nspecular = { f0 = 1, shininess = 65536 }\n"
                              "diffuse = { albedo = 0, shininess = 0 }\n"
                              "[material.air]\nids = [-1, 16777216]\nspecular = { ior = 1 }\n");
    EXPECT_EQ(scene.lights[0].cone_angle, glm::pi<double>());
    EXPECT_EQ(scene.lights[0].cone_softness, 1.0);
    EXPECT_EQ(scene.materials[0].base().f0.constant, glm::dvec3(1.0));
    EXPECT_EQ(scene.materials[0].base().shininess.constant.x, 65536.0);
    EXPECT_EQ(scene.materials[0].diffuse.shininess->constant.x, 0.0);
    EXPECT_EQ(scene.materials[1].base().f0.constant, glm::dvec3(0.0));
    EXPECT_THAT(scene.materials[1].ids, ElementsAre(-1, 16777216));
}

TEST(Scene, CamerasKnowTheirLens) {
    const std::string matrix = "[camera]\nmatrix_world = [[1,0,0,0],[0,0,-1,0],[0,1,0,0],[0,0,0,1]]\n";
    EXPECT_EQ(parse(head + matrix).camera->lens, Lens::unknown);
    EXPECT_EQ(parse(head + matrix + "fov_x_degrees = 90\n").camera->lens, Lens::fov_x);
    const Scene orthographic = parse(head + matrix + "orthographic_height = 2.5\n");
    EXPECT_EQ(orthographic.camera->lens, Lens::orthographic);
    EXPECT_EQ(orthographic.camera->lens_value, 2.5);
    // Rows in the file are rows of the matrix: the camera's Y axis (second column) is world +Z.
    EXPECT_EQ(glm::dvec3(orthographic.camera->matrix_world[1]), glm::dvec3(0, 0, 1));
}

TEST(Scene, NamesOfModelsAreTheirTomlNames) {
    for (const SpecularModel model : all_specular_models) {
        std::string needs;
        if (model == SpecularModel::blinn_phong_anisotropic) {
            needs = ", shininess_u = 1, shininess_v = 2";
        } else if (model == SpecularModel::blinn_phong_spectral) {
            needs = ", metal = 'gold'";
        }
        const std::string text = fmt::format("{}[material.default]\ndiffuse = {{}}\nspecular = {{ model = '{}'{} }}\n",
                                             head, name_of(model), needs);
        EXPECT_EQ(parse(text).materials[0].base().model, model) << text;
    }
    for (const DiffuseModel model : all_diffuse_models) {
        const std::string text =
            head + "[material.default]\nspecular = {}\ndiffuse.model = '" + std::string(name_of(model)) + "'\n";
        EXPECT_EQ(parse(text).materials[0].diffuse.model, model) << text;
    }
    for (const auto convert :
         {Conversion::none, Conversion::ggx_roughness, Conversion::smoothness, Conversion::oren_nayar_sigma}) {
        const std::string text = head + "[material.default]\nspecular.shininess = { channel = 'r', convert = '" +
                                 std::string(name_of(convert)) + "' }\n";
        EXPECT_EQ(parse(text).materials[0].base().shininess.convert, convert) << text;
    }
}

TEST(Scene, NamesOfAmbientChoicesAreTheirTomlNames) {
    const auto material_of = [](std::string_view key, std::string_view name) {
        return parse(fmt::format("{}[material.default]\ndiffuse = {{}}\n{} = '{}'\n", head, key, name)).materials[0];
    };
    for (const AmbientAbsorption each : all_ambient_absorptions) {
        EXPECT_EQ(material_of("absorption_ibl", name_of(each)).absorption_ibl, each);
    }
    for (const AmbientTransmittance each : all_ambient_transmittances) {
        EXPECT_EQ(material_of("transmittance_ibl", name_of(each)).transmittance_ibl, each);
    }
    for (const AmbientDiffuse each : all_ambient_diffuses) {
        for (const DiffuseModel model : all_diffuse_models) {
            if (name_of(model).starts_with("oren_nayar")) {
                const Scene scene = parse(fmt::format("{}[material.default]\ndiffuse = {{ model = '{}', shininess = 1, "
                                                      "ambient = '{}' }}\n",
                                                      head, name_of(model), name_of(each)));
                EXPECT_EQ(scene.materials[0].diffuse.ambient, each);
            }
        }
    }
    for (const UpAxis each : all_up_axes) {
        EXPECT_EQ(parse(fmt::format("{}[environment]\nup = '{}'\n", head, name_of(each))).environment->up, each);
    }
    for (const AmbientSource each : all_ambient_sources) {
        EXPECT_EQ(parse(fmt::format("{}[environment]\ndiffuse = '{}'\n", head, name_of(each))).environment->diffuse,
                  each);
    }
}

/// Arrays that leave a value out would pass every test that walks them.
TEST(Scene, ListsOfChoicesAreWhole) {
    const auto expect_whole = [](const auto& all) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            EXPECT_EQ(static_cast<std::size_t>(all.at(i)), i);
            EXPECT_NE(name_of(all.at(i)), "");
        }
        return all.size();
    };
    EXPECT_EQ(expect_whole(all_specular_models), 5U);
    EXPECT_EQ(expect_whole(all_diffuse_models), 8U);
    EXPECT_EQ(expect_whole(all_fresnel_models), 2U);
    EXPECT_EQ(expect_whole(all_absorption_models), 3U);
    EXPECT_EQ(expect_whole(all_ambient_absorptions), 3U);
    EXPECT_EQ(expect_whole(all_ambient_transmittances), 2U);
    EXPECT_EQ(expect_whole(all_ambient_diffuses), 6U);
    EXPECT_EQ(expect_whole(all_up_axes), 2U);
    EXPECT_EQ(expect_whole(all_ambient_sources), 3U);
}

TEST(Environment, HasDefaults) {
    EXPECT_FALSE(parse(head).environment.has_value());
    EXPECT_FALSE(parse(head).background);
    const Scene scene = parse("version = 1\n[environment]\n"); // light enough by itself
    EXPECT_TRUE(scene.lights.empty());
    ASSERT_TRUE(scene.environment.has_value());
    EXPECT_EQ(scene.environment->image, "");
    EXPECT_EQ(scene.environment->intensity, glm::dvec3(1.0));
    EXPECT_FALSE(scene.environment->up.has_value());
    EXPECT_EQ(scene.environment->rotation, 0.0);
    EXPECT_EQ(scene.environment->diffuse, AmbientSource::sh2);
    EXPECT_FALSE(scene.environment->in_camera_space);
    EXPECT_EQ(scene.environment->where.line, 2);
    EXPECT_FALSE(scene.background);
    EXPECT_FALSE(parse(head + "[output]\nbackground = false\n").background);
    EXPECT_EQ(environment_path(scene), "");
    EXPECT_EQ(environment_path(parse(head)), "");
}

TEST(Environment, IsReadWhole) {
    const Scene scene = parse(head + "[environment]\nimage = 'maps/studio.hdr'\nintensity = [0, 0.5, 2]\nup = 'y'\n"
                                     "rotation_degrees = -450\ndiffuse = 'irradiance_map'\n[output]\n"
                                     "background = true\n");
    EXPECT_EQ(scene.environment->image, "maps/studio.hdr");
    EXPECT_EQ(scene.environment->intensity, glm::dvec3(0, 0.5, 2));
    EXPECT_EQ(scene.environment->up, UpAxis::y);
    EXPECT_DOUBLE_EQ(scene.environment->rotation, -2.5 * glm::pi<double>());
    EXPECT_EQ(scene.environment->diffuse, AmbientSource::irradiance_map);
    EXPECT_TRUE(scene.background);
    EXPECT_EQ(parse(head + "[environment]\nintensity = 3\n").environment->intensity, glm::dvec3(3.0));
}

TEST(Environment, ItsPathStartsAtTheSceneFile) {
    const auto path_of = [](const std::string& file, const std::string& image) {
        return environment_path(parse_scene("version = 1\n[environment]\nimage = '" + image + "'\n", file, {}, {}));
    };
    EXPECT_EQ(path_of("shots/a/scene.toml", "../maps/sky.exr"), "shots/a/../maps/sky.exr");
    EXPECT_EQ(path_of("scene.toml", "sky.exr"), "sky.exr");
    EXPECT_EQ(path_of("shots/scene.toml", "/maps/sky.exr"), "/maps/sky.exr");
}

TEST(DefaultScene, HasAKeyAStudioAndAnAutomaticMaterial) {
    const Scene scene = default_scene();
    EXPECT_TRUE(scene.file.empty());
    EXPECT_FALSE(scene.camera.has_value());
    EXPECT_TRUE(scene.automatic_material);
    ASSERT_EQ(scene.lights.size(), 1U);
    EXPECT_EQ(scene.lights[0].name, "key");
    EXPECT_EQ(scene.lights[0].type, LightType::distant);
    EXPECT_TRUE(scene.lights[0].in_camera_space);
    // The key travels to the right, down and away from the camera: it comes over the left shoulder.
    const glm::dvec3 key = scene.lights[0].direction;
    EXPECT_GT(key.x, 0.0);
    EXPECT_LT(key.y, 0.0);
    EXPECT_LT(key.z, 0.0);
    ASSERT_TRUE(scene.environment.has_value());
    EXPECT_TRUE(scene.environment->in_camera_space);
    EXPECT_TRUE(scene.environment->image.empty());
    EXPECT_TRUE(scene.environment->where.file.empty());
    EXPECT_FALSE(scene.background);
    // A grey surface facing the key: albedo (1 - F0) E_0/pi is a quarter, as much again is left to the studio.
    const double grey = 0.5 * 0.96 * scene.lights[0].power.g / glm::pi<double>();
    EXPECT_GT(grey, 0.2);
    EXPECT_LT(grey, 0.3);
    EXPECT_EQ(scene.environment->intensity, glm::dvec3(0.5));
}

} // namespace
} // namespace clshade
