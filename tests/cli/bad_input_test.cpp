// Every kind of bad input: the right exit code, one clear line, within seconds, in bounded memory, nothing left behind.
#include "tests/cli/gbuffers.h"
#include "tests/cli/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>

namespace clshade::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// No device is opened for bad input, so nothing here may be large or slow. The limits leave room for the libraries
// that a process maps, for slow machines and for sanitizers.
constexpr double most_seconds = 20.0;
constexpr double most_mib = 700.0;

struct BadInput {
    std::string name;
    int exit_code = 1;
    std::vector<std::string> words;                   ///< that the line must hold
    std::function<void(const TemporaryFolder&)> make; ///< writes in.exr and whatever else
    std::vector<std::string> flags;                   ///< beside "shade in.exr -o out.exr"
};

// How GoogleTest shows the case.
[[maybe_unused]] std::ostream& operator<<(std::ostream& stream, const BadInput& test) {
    return stream << test.name;
}

void good(const TemporaryFolder& folder) {
    write_gbuffer(folder / "in.exr", surface_planes());
}

// A scene without a light is refused as well; that must not be the complaint.
const std::string light = "\n[[light]]\nname = \"sun\"\ntype = \"distant\"\ndirection = [0, 0, -1]\nirradiance = 1.0\n";

BadInput bad_scene(const std::string& name, const std::string& text, std::vector<std::string> words) {
    words.emplace_back("scene.toml:");
    return {name,
            2,
            std::move(words),
            [text](const TemporaryFolder& folder) {
                good(folder);
                write_bytes(folder / "scene.toml", "version = 1\n" + text + light);
            },
            {"--scene", "scene.toml"}};
}

BadInput bad_planes(const std::string& name, const std::vector<TestPlane>& planes, std::vector<std::string> words,
                    std::vector<std::string> flags = {}) {
    return {name, 2, std::move(words),
            [planes](const TemporaryFolder& folder) { write_gbuffer(folder / "in.exr", planes); }, std::move(flags)};
}

std::vector<BadInput> bad_files() {
    const auto bytes = [](const std::string& content) {
        return [content](const TemporaryFolder& folder) { write_bytes(folder / "in.exr", content); };
    };
    const auto cut = [](double share) {
        return [share](const TemporaryFolder& folder) {
            good(folder);
            const std::string whole = bytes_of(folder / "in.exr");
            write_bytes(folder / "in.exr",
                        whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
        };
    };
    const auto window = [](int x_min, int y_min, int x_max, int y_max) {
        return [=](const TemporaryFolder& folder) {
            write_with_data_window(folder / "in.exr", x_min, y_min, x_max, y_max);
        };
    };
    return {
        {"missing", 1, {"in.exr", "no such file"}, [](const TemporaryFolder&) {}, {}},
        {"folder",
         1,
         {"in.exr"},
         [](const TemporaryFolder& f) { std::filesystem::create_directory(f / "in.exr"); },
         {}},
        {"empty", 1, {"in.exr", "empty"}, bytes(""), {}},
        {"text", 1, {"in.exr", "not an"}, bytes("Lorem ipsum dolor sit amet, consectetur adipiscing elit.\n"), {}},
        {"magic_only", 1, {"in.exr"}, bytes(std::string("\x76\x2f\x31\x01\x02\x00\x00\x00", 8)), {}},
        {"truncated_header", 1, {"in.exr"}, cut(0.02), {}},
        {"truncated_pixels", 1, {"in.exr"}, cut(0.6), {}},
        {"deep", 1, {"in.exr", "deep"}, [](const TemporaryFolder& f) { write_deep(f / "in.exr"); }, {}},
        {"subsampled", 1, {"in.exr", "sampled"}, [](const TemporaryFolder& f) { write_subsampled(f / "in.exr"); }, {}},
        {"zero_sized", 1, {"in.exr"}, window(0, 0, -1, -1), {}},
        {"inverted", 1, {"in.exr"}, window(10, 10, 0, 0), {}},
        {"claims_450_million_lines", 1, {"in.exr"}, window(0, 0, test_width - 1, 450'000'000), {}},
        {"claims_everything",
         1,
         {"in.exr"},
         window(std::numeric_limits<int>::min(), std::numeric_limits<int>::min(), std::numeric_limits<int>::max(),
                std::numeric_limits<int>::max()),
         {}},
    };
}

std::vector<BadInput> bad_roles() {
    const TestPlane filtered_id{"MaterialID.V", [](int x, int /*y*/) { return 0.3F * static_cast<float>(x); }};
    std::vector<TestPlane> no_green = surface_planes_without("Albedo.G");
    std::erase_if(no_green, [](const TestPlane& plane) { return plane.name == "Albedo.B"; });
    no_green.push_back({"Albedo.G", [](int, int) { return 0.5F; }}); // R and G but no B
    return {
        bad_planes("no_normal", surface_planes_without("Normal"), {"in.exr", "normal"}),
        bad_planes("half_a_normal", surface_planes_without("Normal.Z"), {"in.exr", "ormal"}),
        bad_planes("two_of_three_colours", no_green, {"Albedo"},
                   {"--set", "material.default.diffuse.albedo=\"Albedo\""}),
        bad_planes("unknown_channel", surface_planes(), {"Albdo", "did you mean", "Albedo"},
                   {"--set", "material.default.diffuse.albedo=\"Albdo\""}),
        bad_planes("unknown_role_channel", surface_planes(), {"Nromal"}, {"--set", "gbuffer.normal=\"Nromal\""}),
        bad_planes("filtered_ids", surface_planes_and(filtered_id), {"in.exr", "filtered", "pixels"},
                   {"--set", "material.a={ids=[1],diffuse={model=\"lambert\"}}"}),
        bad_planes("unknown_view", surface_planes(), {"middle"}, {"--view", "middle"}),
        bad_planes("unknown_kept_layer", surface_planes(), {"--keep", "Albdo"}, {"--keep", "Albdo"}),
        {"no_camera",
         2,
         {"[camera]"},
         [](const TemporaryFolder& folder) {
             write_gbuffer_without_camera(folder / "in.exr", surface_planes_without("Position"));
         },
         {}},
    };
}

std::vector<BadInput> bad_scenes() {
    return {
        {"scene_missing", 2, {"scene.toml"}, good, {"--scene", "scene.toml"}},
        bad_scene("scene_syntax", "[camera\n", {":2:"}),
        bad_scene("scene_unknown_key", "[material.default]\nspecluar = { model = \"blinn_phong\" }\n",
                  {":3:", "specluar", "did you mean 'specular'?"}),
        bad_scene("scene_unknown_section", "[cmaera]\n", {"cmaera", "did you mean 'camera'?"}),
        bad_scene("scene_wrong_type", "[[light]]\ntype = \"distant\"\ndirection = \"down\"\n", {":4:", "direction"}),
        bad_scene("scene_nan", "[material.default]\nspecular = { model = \"blinn_phong\", shininess = nan }\n",
                  {":3:", "shininess"}),
        bad_scene("scene_inf", "[material.default]\nspecular = { model = \"blinn_phong\", f0 = inf }\n", {":3:", "f0"}),
        bad_scene("scene_duplicate_ids",
                  "[material.a]\nids = [3]\ndiffuse = { model = \"lambert\" }\n"
                  "[material.b]\nids = [3]\ndiffuse = { model = \"lambert\" }\n",
                  {"3", "id"}),
        bad_scene("scene_singular_camera",
                  "[camera]\nmatrix_world = [[1,0,0,0],[1,0,0,0],[0,0,1,5],[0,0,0,1]]\nfov_y_degrees = 40\n",
                  {"matrix_world"}),
        {"set_unknown_key", 2, {"shinyness", "did you mean"}, good, {"--set", "material.default.specular.shinyness=3"}},
        {"set_no_value", 2, {"--set"}, good, {"--set", "material.default.specular.shininess"}},
        {"model_unknown", 2, {"lambret", "did you mean 'lambert'?"}, good, {"--model", "lambret"}},
        {"bad_compression", 2, {"--compression", "zpi"}, good, {"--compression", "zpi"}},
        {"bad_type", 2, {"-d", "quarter"}, good, {"-d", "quarter"}},
        {"bad_aov", 2, {"--aov", "difuse", "did you mean 'diffuse'?"}, good, {"--aov", "difuse"}},
        {"frames_without_sequence", 2, {"--frames"}, good, {"--frames", "1-10"}},
    };
}

const std::string one_layer = "[[material.default.layer]]\nspecular = { shininess = 9 }\n";
const std::string lambert_base = "[[material.default.layer]]\ndiffuse = { model = \"lambert\" }\n";

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) {
        all += text;
    }
    return all;
}

std::vector<BadInput> bad_stacks() {
    return {
        bad_scene("nine_layers", repeated(one_layer, 8) + lambert_base, {":18:", "default", "9 layers", "one to 8"}),
        bad_scene("empty_stack", "[material.default]\nlayer = []\n", {":3:", "default", "at least one"}),
        bad_scene("layer_without_anything", "[[material.default.layer]]\n" + one_layer, {":2:", "layer 1"}),
        bad_scene("diffuse_above_the_base",
                  "[[material.default.layer]]\ndiffuse = { model = \"lambert\" }\n" + one_layer,
                  {":3:", "layer 1", "'diffuse'", "base"}),
        bad_scene("ior_below_1", "[[material.default.layer]]\nspecular = { ior = 0.99 }\n" + lambert_base,
                  {":3:", "ior", "0.99", "1"}),
        bad_scene("negative_absorption", "[[material.default.layer]]\nabsorption = [0.1, -0.1, 0.1]\n" + lambert_base,
                  {":3:", "absorption", "-0.1"}),
        bad_scene("absorption_in_the_base",
                  one_layer + "[[material.default.layer]]\nspecular = { f0 = 0.1 }\nabsorption = 0.1\n",
                  {":6:", "absorption", "below"}),
        bad_scene("unknown_fresnel", "[material.default]\nfresnel = \"exat\"\n" + one_layer,
                  {":3:", "exat", "did you mean 'exact'?"}),
        bad_scene("unknown_preset", "[material.default]\npreset = \"car_piant\"\n",
                  {":3:", "car_piant", "did you mean 'car_paint'?"}),
        bad_scene("zero_tangent",
                  "[material.default]\nspecular = { model = \"blinn_phong_anisotropic\", shininess_u = 9, "
                  "shininess_v = 99, tangent = [0, 0, 0] }\n",
                  {":3:", "tangent"}),
        bad_planes("no_tangent_role", surface_planes(), {"in.exr", "tangent", "default"},
                   {"--set", "material.default.specular={model=\"blinn_phong_anisotropic\",shininess_u=9,"
                             "shininess_v=99}"}),
        bad_planes("names_without_cryptomatte", surface_planes(), {"in.exr", "no Cryptomatte", "gold"},
                   {"--set", "material.a={names=[\"gold\"],diffuse={model=\"lambert\"}}"}),
    };
}

// A Cryptomatte file, a name that is not in it, and what the message must hold.
BadInput bad_name(const std::string& name, const std::string& written, std::vector<std::string> words) {
    return {name,
            2,
            std::move(words),
            [](const TemporaryFolder& folder) {
                std::filesystem::copy(std::filesystem::path(CLSHADE_TEST_DATA) / "crypto_crop.exr", folder / "in.exr");
            },
            {"--set", "material.a={names=[\"" + written + "\"],diffuse={model=\"lambert\"}}"}};
}

BadInput bad_metal(const std::string& name, const std::string& table, std::vector<std::string> words) {
    words.emplace_back("metal.nk:");
    return {name,
            2,
            std::move(words),
            [table](const TemporaryFolder& folder) {
                good(folder);
                write_bytes(folder / "metal.nk", table);
            },
            {"--model", "blinn_phong_spectral", "--set", "material.default.specular.metal=\"metal.nk\""}};
}

std::vector<BadInput> bad_tables() {
    return {
        bad_name("crypto_misspelt", "car_piant", {"in.exr", "'car_piant'", "did you mean 'car_paint'?"}),
        bad_name("crypto_unknown", "something else entirely", {"in.exr", "'something else entirely'", "EmitTorus"}),
        bad_metal("nk_out_of_order", "400, 1, 2\n500, 1, 2\n450, 1, 2\n", {":3:", "450", "500"}),
        bad_metal("nk_twice", "400, 1, 2\n400, 1, 2\n", {":2:", "400"}),
        bad_metal("nk_one_row", "400, 1, 2\n", {"1 row", "two or more"}),
        bad_metal("nk_nan", "400, nan, 2\n500, 1, 2\n", {":1:", "nan"}),
        bad_metal("nk_negative_k", "400, 1, 2\n500, 1, -2\n", {":2:", "-2"}),
        bad_metal("nk_text", "wavelength n k\n400, 1, 2\n500, 1, two\n", {":3:", "two"}),
        {"nk_missing",
         2,
         {"silver.nk", "gold"},
         good,
         {"--model", "blinn_phong_spectral", "--set", "material.default.specular.metal=\"silver.nk\""}},
    };
}

std::vector<BadInput> all_bad_inputs() {
    std::vector<BadInput> all;
    for (const auto& part : {bad_files(), bad_roles(), bad_scenes(), bad_stacks(), bad_tables()}) {
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

void expect_one_clear_line(const Outcome& run, int exit_code, const std::vector<std::string>& words) {
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_EQ(run.signal, 0);
    ASSERT_EQ(run.error_lines().size(), 1U) << run.err;
    EXPECT_THAT(run.err, StartsWith("clshade: "));
    for (const std::string& word : words) {
        EXPECT_THAT(run.err, HasSubstr(word));
    }
    EXPECT_EQ(run.out, "");
    EXPECT_LT(run.seconds, most_seconds);
}

class BadInputs : public ::testing::TestWithParam<BadInput> {};

TEST_P(BadInputs, GivesOneLineAndLeavesNothing) {
    const BadInput& bad = GetParam();
    const TemporaryFolder folder;
    bad.make(folder);
    const std::vector<std::string> before = folder.names();
    std::vector<std::string> arguments{"shade", "in.exr", "-o", "out.exr"};
    arguments.insert(arguments.end(), bad.flags.begin(), bad.flags.end());
    RunSettings settings;
    settings.folder = folder.path();
    const Outcome run = run_clshade(arguments, settings);
    expect_one_clear_line(run, bad.exit_code, bad.words);
    EXPECT_LT(run.peak_mib, most_mib);
    EXPECT_EQ(folder.names(), before) << "an output or a temporary was left";
}

INSTANTIATE_TEST_SUITE_P(Kinds, BadInputs, ::testing::ValuesIn(all_bad_inputs()),
                         [](const auto& test) { return test.param.name; });

// The same files must not trouble `inspect` and `check` either.
TEST(BadFiles, AreRefusedByInspectAndCheck) {
    for (const BadInput& bad : bad_files()) {
        const TemporaryFolder folder;
        bad.make(folder);
        RunSettings settings;
        settings.folder = folder.path();
        for (const char* verb : {"inspect", "check"}) {
            const Outcome run = run_clshade({verb, "in.exr", "-q"}, settings);
            EXPECT_EQ(run.exit_code, 1) << verb << " " << bad.name << ": " << run.err;
            EXPECT_EQ(run.error_lines().size(), 1U) << verb << " " << bad.name << ": " << run.err;
            EXPECT_LT(run.peak_mib, most_mib) << verb << " " << bad.name;
        }
    }
}

struct Conformance {
    const char* file;
    const char* word;
};

// Files that others have damaged; their licences keep them out of this repository.
TEST(BadFiles, OfTheConformanceSuite) {
    const std::filesystem::path suite = std::filesystem::path(CLSHADE_SHARED_DATA) / "conformance";
    if (!std::filesystem::exists(suite)) {
        GTEST_SKIP() << "the conformance files are not part of the repository";
    }
    for (const Conformance& c :
         {Conformance{"damaged/memory_DOS_1.exr", ""}, Conformance{"damaged/invalid.exr", ""},
          Conformance{"damaged/unfinished_multipart.exr", ""}, Conformance{"deep/deep_11.exr", "deep"},
          Conformance{"lumchroma/XYZ_YC.exr", "sampled"}}) {
        const TemporaryFolder folder;
        const Outcome run = run_clshade({"shade", (suite / c.file).string(), "-o", (folder / "out.exr").string()});
        SCOPED_TRACE(c.file);
        expect_one_clear_line(run, 1, {c.file, c.word});
        EXPECT_LT(run.peak_mib, most_mib);
        EXPECT_TRUE(folder.names().empty());
    }
    // Reads well until the pixels: only `inspect` gets so far, for the file has no roles.
    const Outcome run = run_clshade({"inspect", (suite / "damaged/asan_heap-oob_7f4d5.exr").string()});
    EXPECT_EQ(run.signal, 0);
    EXPECT_LE(run.exit_code, 1);
}

TEST(BadOutput, IsRefusedBeforeAnythingIsShaded) {
    const TemporaryFolder folder;
    good(folder);
    std::filesystem::create_directory(folder / "taken.exr");
    std::filesystem::create_symlink("in.exr", folder / "link.exr");
    const std::vector<std::string> before = folder.names();
    const std::string input = bytes_of(folder / "in.exr");
    RunSettings settings;
    settings.folder = folder.path();
    struct Target {
        const char* output;
        int exit_code;
        const char* word;
    };
    for (const Target& target :
         {Target{"no/such/folder/out.exr", 1, "no/such/folder"}, Target{"taken.exr", 1, "taken.exr"},
          Target{"in.exr", 2, "overwrite"}, Target{"./in.exr", 2, "overwrite"}, Target{"link.exr", 2, "overwrite"},
          Target{"out.tif", 2, ".tif"}, Target{"out", 2, "out"}}) {
        SCOPED_TRACE(target.output);
        const Outcome run = run_clshade({"shade", "in.exr", "-o", target.output}, settings);
        expect_one_clear_line(run, target.exit_code, {target.word});
        EXPECT_EQ(folder.names(), before);
        EXPECT_EQ(bytes_of(folder / "in.exr"), input);
    }
}

TEST(BadOutput, AFullDiskLeavesNothing) {
    const TemporaryFolder folder;
    // Noise does not compress: the output cannot fit into the limit.
    const auto noise = [](int x, int y) { return static_cast<float>((x * 7919 + y * 104729) % 1009) / 1009.0F; };
    std::vector<TestPlane> planes = surface_planes_without("Albedo");
    for (const char* name : {"Albedo.R", "Albedo.G", "Albedo.B"}) {
        planes.push_back({name, noise});
    }
    write_gbuffer(folder / "in.exr", planes);
    RunSettings settings;
    settings.folder = folder.path();
    const std::vector<std::string> arguments{"shade", "in.exr", "-o", "out.exr", "-d", "float", "-q"};
    ASSERT_EQ(run_clshade(arguments, settings).exit_code, 0); // the kernel is in the cache from here on
    std::filesystem::remove(folder / "out.exr");
    const std::vector<std::string> before = folder.names();
    settings.file_size_limit = 4096;
    for (const char* output : {"out.exr", "out.png"}) {
        const Outcome run = run_clshade({"shade", "in.exr", "-o", output, "-q"}, settings);
        EXPECT_EQ(run.exit_code, 1) << output << run.err;
        ASSERT_GE(run.error_lines().size(), 1U);
        EXPECT_THAT(run.error_lines().back(), HasSubstr(output));
        EXPECT_EQ(folder.names(), before);
    }
    settings.file_size_limit = 300; // nor can a report be written; the error line can
    EXPECT_EQ(run_clshade({"models", "-q", "--json", "r.json"}, settings).exit_code, 1);
    EXPECT_EQ(folder.names(), before);
}

} // namespace
} // namespace clshade::tests
