// Every mistake: one line, the right place, what to do.
#include "tests/scene/support.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

namespace clshade {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreNamedWithTheirPlace) {
    expect_mistake(error_of(head + GetParam().text), GetParam());
}

std::string camera(const std::string& rows, const std::string& more = {}) {
    return "[camera]\nmatrix_world = " + rows + "\n" + more;
}

const std::string identity = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";

INSTANTIATE_TEST_SUITE_P(
    Keys, Mistakes,
    testing::Values(
        Mistake{"top", "[materials.default]\n", "4:2", "did you mean 'material'?"},
        Mistake{"camera", camera(identity, "fov_y = 3\n"), "6:1", "unknown key 'fov_y' in [camera]"},
        Mistake{"gbuffer", "[gbuffer]\nnormals = 'N'\n", "5:1", "did you mean 'normal'?"},
        Mistake{"position_space", "[gbuffer]\nposition_space = 'world'\n", "5:1", "unknown key 'position_space'"},
        Mistake{"output", "[output]\nbackgroud = true\n", "5:1", "did you mean 'background'?"},
        Mistake{"material", "[material.wax]\nids = [1]\nspeculr = {}\n", "6:1", "did you mean 'specular'?"},
        Mistake{"specular", "[material.default]\nspecular = { shinines = 3 }\n", "5:14", "did you mean 'shininess'?"},
        Mistake{"diffuse", "[material.default]\ndiffuse = { colour = 1 }\n", "5:13",
                "known keys are 'model', 'albedo'"},
        Mistake{"parameter", "[material.default]\ndiffuse.albedo = { chanel = 'a' }\n", "5:20", "mean 'channel'?"},
        Mistake{"layer", "[[material.default.layer]]\nspec = {}\n", "5:1", "unknown key 'spec' in the layer of"}),
    name_of_mistake);

INSTANTIATE_TEST_SUITE_P(
    Materials, Mistakes,
    testing::Values(
        Mistake{"model", "[material.default]\nspecular.model = 'blin_phong'\n", "5:18", "did you mean 'blinn_phong'?"},
        Mistake{"diffuse_model", "[material.default]\ndiffuse.model = 'oren_naya'\n", "5:17", "mean 'oren_nayar'?"},
        Mistake{"convert", "[material.default]\nspecular.shininess = { channel = 'r', convert = 'ggx' }\n", "5:49",
                "'convert' is 'ggx', which is unknown; write one of"},
        Mistake{"no_channel", "[material.default]\nspecular.shininess = { convert = 'smoothness' }\n", "5:22",
                "lacks 'channel'"},
        Mistake{"reflectance_convert", "[material.default]\nspecular.f0 = { channel = 'r', convert = 'smoothness' }\n",
                "5:15", "remove 'convert'"},
        Mistake{"f0_high", "[material.default]\nspecular.f0 = 1.5\n", "5:15",
                "'f0' is 1.5; it must be between 0 and 1"},
        Mistake{"f0_low", "[material.default]\nspecular.f0 = [0.1, -0.1, 0.1]\n", "5:21", "'f0' is -0.1"},
        Mistake{"f0_two", "[material.default]\nspecular.f0 = [0.1, 0.1]\n", "5:15", "write one number or three"},
        Mistake{"f0_bool", "[material.default]\nspecular.f0 = true\n", "5:15", "is true or false; write a number"},
        Mistake{"f0_empty", "[material.default]\nspecular.f0 = ''\n", "5:15", "'f0' is empty"},
        Mistake{"f0_two_channels", "[material.default]\nspecular.f0 = ['a', 'b']\n", "5:15", "lists 2 channels"},
        Mistake{"albedo", "[material.default]\ndiffuse.albedo = 1.01\n", "5:18", "'albedo' is 1.01"},
        Mistake{"shininess_high", "[material.default]\nspecular.shininess = 65537\n", "5:22", "between 0 and 65536"},
        Mistake{"shininess_low", "[material.default]\nspecular.shininess = -1\n", "5:22", "'shininess' is -1"},
        Mistake{"shininess_three", "[material.default]\nspecular.shininess = [1, 2, 3]\n", "5:22", "one number"},
        Mistake{"shininess_channels", "[material.default]\nspecular.shininess = ['a','b','c']\n", "5:22", "write one"},
        Mistake{"ior", "[material.default]\nspecular.ior = 0.9\n", "5:16", "'ior' is 0.9; it must be 1 or more"},
        Mistake{"ior_and_f0", "[material.default]\nspecular = { f0 = 0.1, ior = 2 }\n", "5:24", "keep one"},
        Mistake{"nan", "[material.default]\nspecular.f0 = nan\n", "5:15", "write a finite number"},
        Mistake{"inf", "[material.default]\nspecular.shininess = inf\n", "5:22", "write a finite number"},
        Mistake{"nan_scale", "[material.default]\nspecular.f0 = { channel = 'a', scale = nan }\n", "5:40", "'scale'"},
        Mistake{"not_a_table", "[material.default]\nspecular = 'blinn_phong'\n", "5:12", "is a string; write a table"},
        Mistake{"materials_not_a_table", "material = 3\n", "4:12", "write materials as [material.NAME]"},
        Mistake{"neither", "[material.default]\n", "4:1", "has neither 'specular' nor 'diffuse'"},
        Mistake{"both_none", "[material.default]\nspecular.model = 'none'\ndiffuse.model = 'none'\n", "4:1", "black"},
        Mistake{"only_none", "[material.default]\nspecular.model = 'none'\n", "4:1", "black"},
        Mistake{"rough_alone", "[material.default]\ndiffuse = { model = 'oren_nayar' }\n", "5:11", "add shininess"},
        Mistake{"no_ids", "[material.wax]\ndiffuse = {}\n", "4:1", "material 'wax' lacks 'ids'"},
        Mistake{"empty_ids", "[material.wax]\nids = []\ndiffuse = {}\n", "5:7", "claims no pixel"},
        Mistake{"real_ids", "[material.wax]\nids = [1.5]\ndiffuse = {}\n", "5:8", "write a list of whole numbers"},
        Mistake{"one_id", "[material.wax]\nids = 3\ndiffuse = {}\n", "5:7", "write a list of whole numbers"},
        Mistake{"large_id", "[material.wax]\nids = [16777217]\ndiffuse = {}\n", "5:8", "id 16777217"},
        Mistake{"default_ids", "[material.default]\nids = [1]\ndiffuse = {}\n", "5:1", "remove 'ids'"},
        Mistake{"ids_twice", "[material.wax]\nids = [1, 2, 1]\ndiffuse = {}\n", "5:7", "id 1 is claimed twice"},
        Mistake{"ids_of_two", "[material.b]\nids = [1]\ndiffuse = {}\n[material.a]\nids = [2, 1]\ndiffuse = {}\n",
                "8:7", "by material 'b' and material 'a'"},
        Mistake{"same_name", "[material.a]\nids = [1]\ndiffuse = {}\n[material.a]\nids = [2]\n", "7:1", "a"},
        Mistake{"lobe_beside_layer", "[material.default]\nspecular = {}\n[[material.default.layer]]\ndiffuse = {}\n",
                "5:1", "both 'specular' and [[layer]]"},
        Mistake{"layer_table", "[material.default]\nlayer = { diffuse = {} }\n", "5:1", "[[material.NAME.layer]]"}),
    name_of_mistake);

INSTANTIATE_TEST_SUITE_P(
    Camera, Mistakes,
    testing::Values(
        Mistake{"missing", "[camera]\nfov_y_degrees = 40\n", "4:1", "lacks 'matrix_world'"},
        Mistake{"three_rows", camera("[[1,0,0,0],[0,1,0,0],[0,0,1,0]]"), "5:16", "has 3 rows"},
        Mistake{"short_row", camera("[[1,0,0,0],[0,1,0],[0,0,1,0],[0,0,0,1]]"), "5:27",
                "row 2 of 'matrix_world' has 3"},
        Mistake{"text", camera("[[1,0,0,'x'],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"), "5:24", "write a number"},
        Mistake{"nan", camera("[[1,0,0,nan],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"), "5:24", "finite"},
        Mistake{"singular", camera("[[1,0,0,0],[0,1,0,0],[0,1,0,0],[0,0,0,1]]"), "5:16", "is singular"},
        Mistake{"zero", camera("[[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,1]]"), "5:16", "is singular"},
        Mistake{"scale", camera("[[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]"), "5:16", "column 1 has length 2"},
        Mistake{"shear", camera("[[1,0.6,0,0],[0,0.8,0,0],[0,0,1,0],[0,0,0,1]]"), "5:16", "shears"},
        Mistake{"mirror", camera("[[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"), "5:16", "mirrors"},
        Mistake{"row_vectors", camera("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[2,3,5,1]]"), "5:16", "is not affine"},
        Mistake{"two_lenses", camera(identity, "fov_x_degrees = 40\northographic_height = 2\n"), "7:1", "keep one"},
        Mistake{"fov_zero", camera(identity, "fov_x_degrees = 0\n"), "6:17", "more than 0 and less than 180"},
        Mistake{"fov_180", camera(identity, "fov_y_degrees = 180\n"), "6:17", "more than 0 and less than 180"},
        Mistake{"height", camera(identity, "orthographic_height = -1\n"), "6:23", "more than 0"},
        Mistake{"not_a_table", "camera = 3\n", "4:10", "[camera] is a whole number; write a table"}),
    name_of_mistake);

INSTANTIATE_TEST_SUITE_P(
    GBuffer, Mistakes,
    testing::Values(Mistake{"number", "[gbuffer]\nnormal = 3\n", "5:10", "write a string or a list of strings"},
                    Mistake{"empty_list", "[gbuffer]\nnormal = []\n", "5:10", "is an empty list"},
                    Mistake{"mixed_list", "[gbuffer]\nnormal = ['N.X', 3]\n", "5:18", "write a string"},
                    Mistake{"space", "[gbuffer]\nnormal_space = 'wrld'\n", "5:16", "did you mean 'world'?"},
                    Mistake{"encoding", "[gbuffer]\nnormal_encoding = 'snorm'\n", "5:19", "did you mean 'unorm'?"},
                    Mistake{"depth", "[gbuffer]\ndepth_kind = 'z'\n", "5:14", "write one of 'planar', 'ray'"},
                    Mistake{"date", "[gbuffer]\nnormal = 2012-08-09\n", "5:10", "is a date"}),
    name_of_mistake);

INSTANTIATE_TEST_SUITE_P(
    Environment, Mistakes,
    testing::Values(
        Mistake{"key", "[environment]\nrotation_degree = 90\n", "5:1", "did you mean 'rotation_degrees'?"},
        Mistake{"misspelt", "[enviroment]\n", "4:2", "did you mean 'environment'?"},
        Mistake{"not_a_table", "environment = 'studio.hdr'\n", "4:15", "[environment] is a string; write a table"},
        Mistake{"list", "[[environment]]\nimage = 'a.hdr'\n", "4:1", "[environment] is a list"},
        Mistake{"image_number", "[environment]\nimage = 3\n", "5:9", "write a string"},
        Mistake{"image_empty", "[environment]\nimage = ''\n", "5:9", "'image' is empty"},
        Mistake{"negative", "[environment]\nintensity = -1\n", "5:13", "'intensity' is -1; it must be 0 or more"},
        Mistake{"negative_channel", "[environment]\nintensity = [1, -0.5, 1]\n", "5:17", "'intensity' is -0.5"},
        Mistake{"intensity_nan", "[environment]\nintensity = [1, 1, nan]\n", "5:20", "write a finite number"},
        Mistake{"intensity_two", "[environment]\nintensity = [1, 1]\n", "5:13", "write one number or three"},
        Mistake{"rotation_inf", "[environment]\nrotation_degrees = inf\n", "5:20", "write a finite number"},
        Mistake{"rotation_text", "[environment]\nrotation_degrees = '90'\n", "5:20", "write a number"},
        Mistake{"up", "[environment]\nup = 'x'\n", "5:6", "'up' is 'x', which is unknown; write one of 'z', 'y'"},
        Mistake{"diffuse", "[environment]\ndiffuse = 'irradiance_mop'\n", "5:11", "did you mean 'irradiance_map'?"},
        Mistake{"background_alone", "[output]\nbackground = true\n", "5:1", "; add [environment] with image"},
        Mistake{"background_text", "[environment]\n[output]\nbackground = 'yes'\n", "6:14", "write true or false"},
        Mistake{"absorption_ibl", "[material.default]\nabsorption_ibl = 'clampd'\ndiffuse = {}\n", "5:18",
                "did you mean 'clamped'?"},
        Mistake{"transmittance_ibl", "[material.default]\ntransmittance_ibl = 'deck'\ndiffuse = {}\n", "5:21",
                "write one of 'fresnel', 'none'"},
        Mistake{"absorption_ibl_key", "[material.default]\nabsorbtion_ibl = 'deck'\ndiffuse = {}\n", "5:1",
                "did you mean 'absorption_ibl'?"},
        Mistake{"ambient_choice",
                "[material.default]\ndiffuse = { model = 'oren_nayar', shininess = 3, ambient = 'corse' }\n", "5:60",
                "did you mean 'coarse'?"},
        Mistake{"ambient_of_lambert", "[material.default]\ndiffuse = { model = 'lambert', ambient = 'fit' }\n", "5:32",
                "'ambient' does nothing with model lambert"},
        Mistake{"ambient_of_the_default", "[material.default]\ndiffuse = { ambient = 'fit' }\n", "5:13",
                "'ambient' does nothing with model lambert"},
        Mistake{"ambient_of_none", "[material.default]\nspecular = {}\ndiffuse = { model = 'none', ambient = 'fit' }\n",
                "6:29", "'ambient' does nothing with model none"}),
    name_of_mistake);

/// Lights, each replacing the list of `head`.
class LightMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(LightMistakes, AreNamedWithTheirPlace) {
    const Mistake& mistake = GetParam();
    expect_mistake(error_of("version = 1\n[[light]]\n" + mistake.text), mistake);
}

const std::string distant = "type = 'distant'\n";
const std::string full_spot = "type = 'spot'\nposition = [0,0,0]\ndirection = [0,0,1]\nintensity = 1\n";

INSTANTIATE_TEST_SUITE_P(
    Light, LightMistakes,
    testing::Values(
        Mistake{"key", "colour = 3\n", "3:1", "did you mean 'color'?"},
        Mistake{"no_type", "name = 'k'\n", "2:1", "lacks 'type'"},
        Mistake{"type", "type = 'distand'\n", "3:8", "did you mean 'distant'?"},
        Mistake{"no_direction", distant + "irradiance = 1\n", "2:1", "lacks 'direction'"},
        Mistake{"zero_direction", distant + "direction = [0, 0, 0]\nirradiance = 1\n", "4:13", "is zero"},
        Mistake{"two_numbers", distant + "direction = [0, 1]\nirradiance = 1\n", "4:13", "write three"},
        Mistake{"scalar_direction", distant + "direction = 1\nirradiance = 1\n", "4:13", "write a list of three"},
        Mistake{"nan_direction", distant + "direction = [0, nan, 1]\nirradiance = 1\n", "4:17", "finite"},
        Mistake{"no_irradiance", distant + "direction = [0, 0, 1]\n", "2:1", "lacks 'irradiance'"},
        Mistake{"negative", distant + "direction = [0, 0, 1]\nirradiance = -3\n", "5:14", "it must be 0 or more"},
        Mistake{"intensity_of_distant", distant + "direction = [0, 0, 1]\nintensity = 3\n", "5:1", "does not belong"},
        Mistake{"cone_of_point", "type = 'point'\nposition = [0,0,0]\nintensity = 1\ncone_softness = 0\n", "6:1",
                "does not belong to light 'light1' of type point"},
        Mistake{"no_position", "type = 'point'\nintensity = 1\n", "2:1", "lacks 'position'"},
        Mistake{"color", distant + "direction = [0,0,1]\nirradiance = 1\ncolor = [1, -1, 1]\n", "6:13",
                "'color' is -1"},
        Mistake{"huge", distant + "direction = [0,0,1]\nirradiance = 1e20\ncolor = 1e20\n", "2:1", "exceeds 1e30"},
        Mistake{"no_cone", full_spot, "2:1", "lacks 'cone_angle_degrees'"},
        Mistake{"cone_zero", full_spot + "cone_angle_degrees = 0\n", "7:22", "at most 180"},
        Mistake{"cone_wide", full_spot + "cone_angle_degrees = 180.5\n", "7:22", "at most 180"},
        Mistake{"softness", full_spot + "cone_angle_degrees = 9\ncone_softness = 1.1\n", "8:17", "between 0 and 1"},
        Mistake{"name_number", "name = 3\n", "3:8", "write a string"},
        Mistake{"name_control", "name = \"a\\nb\"\ntype = 'distant'\n", "3:8", "control characters"},
        Mistake{"twice",
                "name = 'a'\ntype = 'point'\nposition = [0,0,0]\nintensity = 1\n[[light]]\nname = 'a'\n"
                "type = 'point'\nposition = [0,0,0]\nintensity = 1\n",
                "7:1", "two lights are called 'a'"}),
    name_of_mistake);

TEST(BadScene, MessagesStayOneLine) {
    EXPECT_THAT(error_of(head + "\"a\\nb\" = 3\n"), HasSubstr("unknown key 'a?b'"));
    EXPECT_THAT(error_of(head, {"units=3\nversion=1"}), Not(HasSubstr("\n")));
}

TEST(BadScene, VersionIsAsked) {
    EXPECT_THAT(error_of(""), StartsWith("scene.toml:1:1: the scene lacks 'version'"));
    EXPECT_THAT(error_of("# note\nversion = 2\n"), StartsWith("scene.toml:2:11: scene version 2 is unknown"));
    EXPECT_THAT(error_of("version = '1'\n"),
                StartsWith("scene.toml:1:11: 'version' is a string; write the whole number 1"));
    EXPECT_THAT(error_of("version = 1.0\n"), StartsWith("scene.toml:1:11: 'version' is a number; write the whole"));
}

TEST(BadScene, LightIsAsked) {
    EXPECT_THAT(error_of("version = 1\n"), HasSubstr("add a [[light]] or an [environment]"));
    EXPECT_THAT(error_of("version = 1\nlight = []\n"), HasSubstr("add a [[light]]"));
    EXPECT_THAT(error_of("version = 1\n[light]\ntype = 'point'\n"), HasSubstr("write [[light]]"));
    EXPECT_THAT(error_of("version = 1\n[gbuffer]\nemission = 'none'\n"), HasSubstr("add a [[light]]"));
}

TEST(BadScene, SyntaxHasItsPlace) {
    EXPECT_THAT(error_of("version = 1\n[light\n"), StartsWith("scene.toml:2:"));
    EXPECT_THAT(error_of("version = 1\nversion = 1\n"), StartsWith("scene.toml:2:"));
    EXPECT_THAT(error_of(std::string("version = 1\n\x00\x01", 14)), StartsWith("scene.toml:2:"));
    EXPECT_THAT(error_of("version = 1\nunits = \"\xff\xfe\"\n"), StartsWith("scene.toml:2:"));
}

TEST(BadScene, FilesThatCannotBeReadAreNamed) {
    const auto message = [](const std::filesystem::path& file) -> std::string {
        try {
            (void)read_scene(file, {}, {});
        } catch (const UsageError& error) {
            return error.what();
        }
        return {};
    };
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    EXPECT_THAT(message(folder / "no such scene.toml"), HasSubstr("no such scene.toml: cannot open the scene"));
    EXPECT_THAT(message(folder), HasSubstr("is a folder"));
    EXPECT_THAT(message("/dev/zero"), HasSubstr("larger than 16 MiB"));
}

TEST(BadScene, AGoodFileIsRead) {
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "clshade_test_scene.toml";
    std::ofstream(file) << head << "[material.default]\ndiffuse.albedo = 7\n";
    try {
        (void)read_scene(file, {}, {});
        ADD_FAILURE() << "albedo 7 was accepted";
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), StartsWith(file.string() + ":5:18: 'albedo' is 7"));
    }
    std::ofstream(file) << head;
    EXPECT_EQ(read_scene(file, {}, {}).lights.size(), 1U);
    std::filesystem::remove(file);
}

} // namespace
} // namespace clshade
