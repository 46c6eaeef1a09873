// Mistakes in lobes, stacks, claims and presets.
#include "tests/scene/support.h"

namespace clshade {
namespace {

using testing::HasSubstr;

class MaterialMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(MaterialMistakes, AreNamedWithTheirPlace) {
    expect_mistake(error_of(head + GetParam().text), GetParam());
}

/// [material.default] with a specular lobe: `keys` start in column 14 of line 5.
std::string lobe(const std::string& keys) {
    return "[material.default]\nspecular = { " + keys + " }\n";
}

INSTANTIATE_TEST_SUITE_P(
    Lobes, MaterialMistakes,
    testing::Values(
        Mistake{"no_shininess_u", lobe("model = 'blinn_phong_anisotropic', shininess_v = 3"), "5:22",
                "lacks 'shininess_u', which blinn_phong_anisotropic needs; write for instance shininess_u = 16"},
        Mistake{"no_shininess_v", lobe("model = 'blinn_phong_anisotropic', shininess_u = 3"), "5:22",
                "lacks 'shininess_v'"},
        Mistake{"one_shininess", lobe("model = 'blinn_phong_anisotropic', shininess = 3"), "5:49",
                "write 'shininess_u' (along the tangent) and 'shininess_v'"},
        Mistake{"shininess_u_range", lobe("model = 'blinn_phong_anisotropic', shininess_u = -1, shininess_v = 3"),
                "5:63", "'shininess_u' is -1; it must be between 0 and 65536"},
        Mistake{"shininess_v_range", lobe("model = 'blinn_phong_anisotropic', shininess_u = 1, shininess_v = 65537"),
                "5:80", "'shininess_v' is 65537"},
        Mistake{"shininess_u_of_another", lobe("shininess_u = 3"), "5:14",
                "'shininess_u' does nothing with model blinn_phong; remove it, or choose a model that has it: "
                "'blinn_phong_anisotropic'"},
        Mistake{"tangent_of_another", lobe("tangent = [0, 0, 1]"), "5:14", "'blinn_phong_anisotropic'"},
        Mistake{"metal_of_another", lobe("model = 'blinn_phong_exact', metal = 'gold'"), "5:43",
                "'metal' does nothing with model blinn_phong_exact; remove it, or choose a model that has it: "
                "'blinn_phong_spectral'"},
        Mistake{"f0_of_a_metal", lobe("model = 'blinn_phong_spectral', metal = 'gold', f0 = 0.9"), "5:62",
                "'blinn_phong', 'blinn_phong_exact', 'blinn_phong_anisotropic'"},
        Mistake{"ior_of_a_metal", lobe("model = 'blinn_phong_spectral', metal = 'gold', ior = 2"), "5:62",
                "'ior' does nothing with model blinn_phong_spectral"},
        Mistake{"f0_of_none", lobe("model = 'none', f0 = 0.1") + "diffuse = {}\n", "5:30",
                "'f0' does nothing with model none"},
        Mistake{"no_metal", lobe("model = 'blinn_phong_spectral'"), "5:22",
                "lacks 'metal', which blinn_phong_spectral needs; write for instance metal = \"gold\""},
        Mistake{"metal_name", lobe("model = 'blinn_phong_spectral', metal = 'golf'"), "5:54",
                "metal 'golf' is neither built in nor a file (golf); did you mean 'gold'?"},
        Mistake{"metal_number", lobe("model = 'blinn_phong_spectral', metal = 3"), "5:54", "write a string"},
        Mistake{"tangent_zero",
                lobe("model = 'blinn_phong_anisotropic', shininess_u = 1, shininess_v = 1, "
                     "tangent = [0, 0.0, 0]"),
                "5:93", "'tangent' is zero; write a direction such as [0, 0, 1]"},
        Mistake{"tangent_number",
                lobe("model = 'blinn_phong_anisotropic', shininess_u = 1, shininess_v = 1, "
                     "tangent = 1"),
                "5:93", "write three numbers, or a role or layer name"},
        Mistake{"tangent_two",
                lobe("model = 'blinn_phong_anisotropic', shininess_u = 1, shininess_v = 1, "
                     "tangent = [0, 1]"),
                "5:93", "write three"},
        Mistake{"tangent_nan",
                lobe("model = 'blinn_phong_anisotropic', shininess_u = 1, shininess_v = 1, "
                     "tangent = [0, 1, nan]"),
                "5:100", "finite"},
        Mistake{"tangent_scale",
                lobe("model = 'blinn_phong_anisotropic', shininess_u = 1, shininess_v = 1, "
                     "tangent = { channel = 't', scale = 2 }"),
                "5:110", "which 'scale' would turn; remove it"},
        Mistake{"ior_below", lobe("ior = [1.5, 0.99, 1.5]"), "5:26", "'ior' is 0.99; it must be 1 or more"},
        Mistake{"ior_convert", lobe("ior = { channel = 'n', convert = 'none' }"), "5:37", "remove 'convert'"},
        Mistake{"rough_over_aniso",
                lobe("model = 'blinn_phong_anisotropic', shininess_u = 1, shininess_v = 1") +
                    "diffuse = { model = 'oren_nayar' }\n",
                "6:11", "the anisotropic lobe has two; add shininess to diffuse"}),
    name_of_mistake);

const std::string layer = "[[material.default.layer]]\n";

std::string nine_layers() {
    std::string text;
    for (int i = 0; i < 9; ++i) {
        text += layer + "specular = {}\n";
    }
    return text;
}

INSTANTIATE_TEST_SUITE_P(
    Stacks, MaterialMistakes,
    testing::Values(
        Mistake{"nine", nine_layers(), "20:1", "has 9 layers; remove some: a stack has one to 8"},
        Mistake{"empty", "[material.default]\nlayer = []\n", "5:1", "write at least one [[material.NAME.layer]]"},
        Mistake{"not_tables", "[material.default]\nlayer = [1, 2]\n", "5:10", "is a whole number; write a table"},
        Mistake{"diffuse_beside_layers", "[material.default]\ndiffuse = {}\n" + layer + "specular = {}\n", "5:1",
                "has both 'diffuse' and [[layer]]"},
        Mistake{"diffuse_above", layer + "specular = {}\n" + layer + "diffuse = {}\n" + layer + "specular = {}\n",
                "7:1",
                "layer 2 of material 'default' (counted from the top) has 'diffuse', which only the last layer, the "
                "base, may have; move it to layer 3"},
        Mistake{"nothing_above", layer + layer + "specular = {}\n", "4:1", "layer 1 of material 'default' has neither"},
        Mistake{"nothing_below", layer + "specular = {}\n" + layer, "6:1",
                "layer 2 of material 'default' has neither 'specular' nor 'diffuse'"},
        Mistake{"black", layer + "absorption = 1\n" + layer + "specular.model = 'none'\n", "4:1",
                "no lobe and no diffuse part in any of its 2 layers and would be black"},
        Mistake{"absorption_of_the_base", layer + "specular = {}\n" + layer + "specular = {}\nabsorption = 0\n", "8:1",
                "'absorption' of layer 2 of material 'default' dims what lies below, and below it lies nothing; move "
                "it to the layer above"},
        Mistake{"absorption_of_one_layer", layer + "specular = {}\nabsorption = 0.1\n", "6:1",
                "remove it, or write a second [[material.NAME.layer]]"},
        Mistake{"absorption_without_layers", "[material.default]\nabsorption = 0.1\ndiffuse = {}\n", "5:1",
                "write the material as a list of [[material.default.layer]]"},
        Mistake{"absorption_negative", layer + "absorption = [0, -0.1, 0]\n" + layer + "diffuse = {}\n", "5:18",
                "'absorption' is -0.1; it must be 0 or more"},
        Mistake{"absorption_inf", layer + "absorption = inf\n" + layer + "diffuse = {}\n", "5:14", "finite"},
        Mistake{"absorption_convert",
                layer + "absorption = { channel = 'a', convert = 'smoothness' }\n" + layer + "diffuse = {}\n", "5:14",
                "'absorption' is an absorption; remove 'convert'"},
        Mistake{"absorption_two_channels", layer + "absorption = ['a', 'b']\n" + layer + "diffuse = {}\n", "5:14",
                "lists 2 channels"},
        Mistake{"unknown_key", layer + "absorbtion = 1\n" + layer + "diffuse = {}\n", "5:1",
                "unknown key 'absorbtion' in layer 1 of material 'default'; did you mean 'absorption'?"},
        Mistake{"lobe_in_a_layer", layer + "specular = { metal = 'gold' }\n" + layer + "diffuse = {}\n", "5:14",
                "specular of layer 1 of material 'default': 'metal' does nothing"},
        Mistake{"rough_base_without_lobe", layer + "specular = {}\n" + layer + "diffuse.model = 'oren_nayar'\n", "7:1",
                "add shininess to diffuse"},
        Mistake{"mapped_f0_above_a_metal",
                layer + "specular.ior = 'n'\n" + layer +
                    "specular = { model = 'blinn_phong_spectral', metal = 'gold' }\n",
                "5:16", "needs a constant index above it"},
        Mistake{"fresnel", "[material.default]\nfresnel = 'exakt'\ndiffuse = {}\n", "5:11", "did you mean 'exact'?"},
        Mistake{"absorption_model", "[material.default]\nabsorption_model = 'orignal'\ndiffuse = {}\n", "5:20",
                "did you mean 'original'?"}),
    name_of_mistake);

INSTANTIATE_TEST_SUITE_P(
    Claims, MaterialMistakes,
    testing::Values(
        Mistake{"neither", "[material.hat]\ndiffuse = {}\n", "4:1",
                "lacks 'ids' or 'names', so that it claims no pixel; write for instance ids = [3, 7] or names = "
                "[\"hat\"]"},
        Mistake{"one_name", "[material.hat]\nnames = 'hat'\ndiffuse = {}\n", "5:9", "write a list of Cryptomatte"},
        Mistake{"no_names", "[material.hat]\nnames = []\ndiffuse = {}\n", "5:9", "claims no pixel"},
        Mistake{"empty_name", "[material.hat]\nnames = ['hat', '']\ndiffuse = {}\n", "5:17", "'names' is empty"},
        Mistake{"number", "[material.hat]\nnames = ['hat', 3]\ndiffuse = {}\n", "5:17", "write a string"},
        Mistake{"default_names", "[material.default]\nnames = ['hat']\ndiffuse = {}\n", "5:1", "remove 'names'"},
        Mistake{"twice", "[material.hat]\nnames = ['hat', 'hat']\ndiffuse = {}\n", "5:9",
                "Cryptomatte name hat is claimed twice by material 'hat'; keep one"},
        Mistake{"by_two",
                "[material.b]\nnames = ['x', 'hat']\ndiffuse = {}\n"
                "[material.a]\nids = [3]\nnames = ['hat']\ndiffuse = {}\n",
                "9:9", "Cryptomatte name hat is claimed twice, by material 'b' and material 'a'"}),
    name_of_mistake);

INSTANTIATE_TEST_SUITE_P(
    Presets, MaterialMistakes,
    testing::Values(
        Mistake{"unknown", "[material.default]\npreset = 'skinn'\n", "5:10",
                "preset 'skinn' is unknown; did you mean 'skin'?"},
        Mistake{"far_off", "[material.default]\npreset = 'zzzzzzzz'\n", "5:10", "write one of 'skin', 'car_paint'"},
        Mistake{"number", "[material.default]\npreset = 1\n", "5:10", "write a string"},
        Mistake{"specular_of_a_stack", "[material.a]\nids = [1]\npreset = 'skin'\nspecular.shininess = 3\n", "7:1",
                "'specular' of material 'a' could mean any of the 2 layers of preset 'skin'; write the layers as "
                "[[material.a.layer]]"},
        Mistake{"diffuse_key", "[material.default]\npreset = 'skin'\ndiffuse.colour = 3\n", "6:9",
                "unknown key 'colour' in diffuse of layer 2"},
        Mistake{"diffuse_value", "[material.default]\npreset = 'skin'\ndiffuse = 3\n", "6:11", "write a table"},
        Mistake{"misspelt", "[material.default]\npreste = 'skin'\n", "5:1", "did you mean 'preset'?"},
        Mistake{"key_of_another_lobe", "[material.default]\npreset = 'brushed_metal'\nspecular.shininess = 3\n", "6:10",
                "write 'shininess_u'"},
        Mistake{"model_that_needs_more",
                "[material.default]\npreset = 'gold'\nspecular.model = 'blinn_phong_anisotropic'\n", "6:18",
                "lacks 'shininess_u'"},
        Mistake{"both_reflectances", "[material.default]\npreset = 'cloth'\nspecular = { f0 = 0.1, ior = 2 }\n", "6:24",
                "keep one"},
        Mistake{"claims_nothing", "[material.skin]\npreset = 'skin'\n", "4:1", "lacks 'ids' or 'names'"}),
    name_of_mistake);

TEST(BadMaterial, KeysOfOneRankDoNotGiveWay) {
    // The same command line chose the model and wrote a key that it lacks.
    EXPECT_THAT(error_of(head, {"material.default.specular.shininess=3"}, "blinn_phong_anisotropic"),
                HasSubstr("write 'shininess_u'"));
    EXPECT_THAT(error_of(head, {"material.default.specular.f0=0.2", "material.default.specular.ior=1.2"}),
                HasSubstr("both 'f0' and 'ior'"));
}

} // namespace
} // namespace clshade
