// Stacks of layers, claims by name, tangents and dumped kernels, end to end.
#include "host/images/image_reader.h"
#include "tests/cli/gbuffers.h"
#include "tests/cli/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace clshade::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Outcome run_in(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
    RunSettings settings;
    settings.folder = folder.path();
    return run_clshade(arguments, settings);
}

nlohmann::json first_result(const std::filesystem::path& file) {
    return nlohmann::json::parse(bytes_of(file))["results"][0];
}

std::string crypto_crop() {
    return (std::filesystem::path(CLSHADE_TEST_DATA) / "crypto_crop.exr").string();
}

// A tangent plane that is the normal itself for 7 pixels, zero for 5, and sound elsewhere.
std::vector<TestPlane> planes_with_tangents() {
    std::vector<TestPlane> planes = surface_planes();
    for (const char* axis : {"X", "Y", "Z"}) {
        const std::string normal_name = std::string("Normal.") + axis;
        const auto normal = std::find_if(planes.begin(), planes.end(),
                                         [&](const TestPlane& plane) { return plane.name == normal_name; });
        const float sound = *axis == 'X' ? 1.0F : 0.0F;
        planes.push_back({std::string("Tangent.") + axis, [value = normal->value, sound](int x, int y) {
                              const bool parallel = y == 4 && x < 7;
                              const bool zero = y == 6 && x < 5;
                              return parallel ? value(x, y) : (zero ? 0.0F : sound);
                          }});
    }
    return planes;
}

const std::vector<std::string> anisotropic{"--model", "blinn_phong_anisotropic",
                                           "--set",   "material.default.specular.shininess_u=20",
                                           "--set",   "material.default.specular.shininess_v=300",
                                           "--set",   "material.default.diffuse.shininess=50"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

TEST(Tangents, AreCountedWhereThereAreNone) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", planes_with_tangents());
    const Outcome run = run_in(folder, with({"shade", "in.exr", "-o", "out.exr", "--json", "r.json"}, anisotropic));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(run.error_lines().size(), 1U) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr("in.exr: 12 pixels"), HasSubstr("tangent that is missing or parallel")));
    const nlohmann::json result = first_result(folder / "r.json");
    EXPECT_EQ(result["no_tangent"], 12);
    ASSERT_EQ(result["warnings"].size(), 1U);
    EXPECT_THAT(result["warnings"][0].get<std::string>(), HasSubstr("12 pixels"));
    // A frame around the normal stands in: those pixels are lit like the others.
    const Decoded image = decode(folder / "out.exr");
    for (int x = 0; x < 7; ++x) {
        EXPECT_GT(image.plane("G")[static_cast<std::size_t>(4 * test_width + x)], 0.0F) << x;
    }
    // The reference counts the same.
    const Outcome check = run_in(folder, with({"check", "in.exr"}, anisotropic));
    EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
}

// A device that counts something else must not get through.
TEST(Tangents, AreCountedOnBothSides) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", planes_with_tangents());
    std::filesystem::create_directory(folder / "kernels");
    std::string text = bytes_of(std::filesystem::path(CLSHADE_SOURCE_DIR) / "kernels/shade.cl");
    const std::string counter = "COUNT_NO_TANGENT";
    const std::size_t at = text.find(counter);
    ASSERT_NE(at, std::string::npos) << "the counter has moved; change this test with it";
    text.replace(at, counter.size(), "COUNT_CLAMPED");
    write_bytes(folder / "kernels/shade.cl", text);
    const Outcome run = run_in(folder, with({"check", "in.exr", "--kernel-dir", "kernels"}, anisotropic));
    EXPECT_EQ(run.exit_code, 3) << run.out << run.err;
    EXPECT_THAT(run.out, HasSubstr("pixels without a tangent: device 0, reference 12"));
}

TEST(Tangents, ThatAreSoundAreNotWarnedAbout) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", planes_with_tangents());
    // The faulty pixels belong to a material that needs no tangent.
    const Outcome run = run_in(folder, {"shade", "in.exr", "-o", "out.exr"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
}

class DumpedKernel : public ::testing::Test {
  protected:
    void SetUp() override {
        write_gbuffer(folder / "in.exr", surface_planes());
        write_bytes(folder / "scene.toml",
                    "version = 1\n"
                    "[material.default]\nabsorption_model = \"original\"\n"
                    "[[material.default.layer]]\n"
                    "specular = { ior = 1.5, shininess = 512 }\nabsorption = [0.1, 0.2, 0.3]\n"
                    "[[material.default.layer]]\n"
                    "specular = { f0 = 0.1, shininess = 20 }\ndiffuse = { albedo = \"albedo\" }\n"
                    "[[light]]\ntype = \"distant\"\ndirection = [0, 0, -1]\nirradiance = 1.0\n");
    }
    TemporaryFolder folder;
};

TEST_F(DumpedKernel, IsTheOneThatShades) {
    const std::vector<std::string> shade{"shade", "in.exr", "-o", "out.exr", "--scene", "scene.toml", "-d", "float"};
    const Outcome run = run_in(folder, with(shade, {"--dump-kernel", "new/kernel"}));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string picture = bytes_of(folder / "out.exr");
    for (const char* file : {"shade.cl", "blinn_phong.cl", "frame_layout.h", "materials.cl", "options.txt"}) {
        EXPECT_TRUE(std::filesystem::exists(folder / "new/kernel" / file)) << file;
    }
    const std::string key = "layers2.blinn_phong.lambert.constant.original";
    EXPECT_THAT(bytes_of(folder / "new/kernel/options.txt"),
                AllOf(HasSubstr("kernel   shade." + key), HasSubstr("-cl-std=CL1.2 -DLANES="),
                      HasSubstr("material default: " + key)));
    EXPECT_THAT(bytes_of(folder / "new/kernel/materials.cl"), HasSubstr(key));
    EXPECT_FALSE(std::filesystem::exists(folder / "new/kernel/2"));
    // Existing files are replaced, and what has been dumped builds to the same picture.
    write_bytes(folder / "new/kernel/materials.cl", "no kernel");
    ASSERT_EQ(run_in(folder, with(shade, {"--dump-kernel", "new/kernel"})).exit_code, 0);
    EXPECT_THAT(bytes_of(folder / "new/kernel/materials.cl"), HasSubstr(key));
    std::filesystem::remove(folder / "out.exr");
    ASSERT_EQ(run_in(folder, with(shade, {"--kernel-dir", "new/kernel"})).exit_code, 0);
    EXPECT_EQ(decode(folder / "out.exr").plane("G"), [&] {
        write_bytes(folder / "first.exr", picture);
        return decode(folder / "first.exr").plane("G");
    }());
}

TEST_F(DumpedKernel, OfASequenceIsOneForEachProgram) {
    write_gbuffer(folder / "in.0001.exr", surface_planes());
    write_gbuffer(folder / "in.0002.exr", surface_planes());
    write_gbuffer(folder / "in.0003.exr", surface_planes_without("Roughness"));
    const Outcome run = run_in(folder, {"shade", "in.####.exr", "-o", "out.####.exr", "--dump-kernel", "k", "-q"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "k/materials.cl"));
    EXPECT_TRUE(std::filesystem::exists(folder / "k/2/materials.cl"));
    EXPECT_FALSE(std::filesystem::exists(folder / "k/3"));
    EXPECT_NE(bytes_of(folder / "k/frame_layout.h") + bytes_of(folder / "k/materials.cl"),
              bytes_of(folder / "k/2/frame_layout.h") + bytes_of(folder / "k/2/materials.cl"));
}

TEST_F(DumpedKernel, IsRefusedWhereItCannotLie) {
    write_bytes(folder / "file", "mine");
    const std::vector<std::string> before = folder.names();
    for (const char* target : {"file", "file/below"}) {
        const Outcome run = run_in(folder, {"shade", "in.exr", "-o", "out.exr", "--dump-kernel", target});
        EXPECT_EQ(run.exit_code, 1) << target << run.err;
        ASSERT_EQ(run.error_lines().size(), 1U) << run.err;
        EXPECT_THAT(run.err, AllOf(HasSubstr("--dump-kernel"), HasSubstr(target)));
        EXPECT_EQ(folder.names(), before);
    }
    EXPECT_EQ(bytes_of(folder / "file"), "mine");
    // Never over the kernels that are being read.
    std::filesystem::create_directory(folder / "kernels");
    write_bytes(folder / "kernels/blinn_phong.cl", "mine");
    const Outcome run =
        run_in(folder, {"shade", "in.exr", "-o", "out.exr", "--kernel-dir", "kernels", "--dump-kernel", "./kernels"});
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr("--dump-kernel"), HasSubstr("--kernel-dir")));
    EXPECT_EQ(bytes_of(folder / "kernels/blinn_phong.cl"), "mine");
}

TEST_F(DumpedKernel, IsNotWrittenByADryRun) {
    const std::vector<std::string> before = folder.names();
    const Outcome run =
        run_in(folder, {"shade", "in.exr", "-o", "out.exr", "--scene", "scene.toml", "-n", "--dump-kernel", "kernel"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("material default: layers2.blinn_phong.lambert.constant.original"));
    EXPECT_EQ(folder.names(), before);
}

TEST(Claims, ByCryptomatteNameTakeItsPixels) {
    const TemporaryFolder folder;
    const auto scene = [](const std::string& claim) {
        return "version = 1\n[material.default]\ndiffuse = { model = \"lambert\", albedo = 0.2 }\n"
               "[material.metal]\npreset = \"gold\"\n" +
               claim;
    };
    const std::string light = "[[light]]\ntype = \"distant\"\ndirection = [0.3, 0.8, -0.5]\nirradiance = 3.0\n";
    write_bytes(folder / "name.toml", scene("names = [\"copper_r005\"]\n") + light);
    write_bytes(folder / "qualified.toml", scene("names = [\"CryptoMaterial/copper_r005\"]\n") + light);
    write_bytes(folder / "nobody.toml", scene("ids = [9999]\n") + light);
    std::vector<std::vector<float>> pictures;
    for (const char* file : {"name.toml", "qualified.toml", "nobody.toml"}) {
        const Outcome run = run_in(folder, {"shade", crypto_crop(), "-o", "out.exr", "-d", "float", "--scene", file});
        ASSERT_EQ(run.exit_code, 0) << file << run.err;
        pictures.push_back(decode(folder / "out.exr").plane("R"));
        const Outcome check = run_in(folder, {"check", crypto_crop(), "--scene", file});
        EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
    }
    EXPECT_EQ(pictures[0], pictures[1]);
    EXPECT_NE(pictures[0], pictures[2]) << "the name claimed no pixel";
}

TEST(Metals, TablesAreSourcesOfThePicture) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", surface_planes());
    const std::string silver = "# silver\n380, 0.20, 1.8\n780, 0.15, 5.2\n";
    write_bytes(folder / "silver.nk", silver);
    write_bytes(folder / "scene.toml",
                "version = 1\n[material.default]\n"
                "specular = { model = \"blinn_phong_spectral\", metal = \"silver.nk\", shininess = 30 }\n"
                "[[light]]\ntype = \"distant\"\ndirection = [0, 0, -1]\nirradiance = 1.0\n");
    const std::vector<std::string> arguments{"shade",      "in.exr", "-o",     "out.exr", "--scene",
                                             "scene.toml", "-u",     "--json", "r.json"};
    ASSERT_EQ(run_in(folder, arguments).exit_code, 0);
    const std::string hash = read_layout(folder / "out.exr").strings.at("clshade/scene_hash");
    ASSERT_EQ(run_in(folder, arguments).exit_code, 0);
    EXPECT_EQ(first_result(folder / "r.json")["status"], "skipped");
    // Another table: -u must not take the old picture for the new one.
    write_bytes(folder / "silver.nk", "380, 0.20, 1.8\n780, 0.15, 4.0\n");
    const auto later = std::filesystem::last_write_time(folder / "out.exr") + std::chrono::seconds(5);
    std::filesystem::last_write_time(folder / "silver.nk", later);
    ASSERT_EQ(run_in(folder, arguments).exit_code, 0);
    EXPECT_EQ(first_result(folder / "r.json")["status"], "ok");
    EXPECT_NE(read_layout(folder / "out.exr").strings.at("clshade/scene_hash"), hash);
}

TEST(ModelFlag, AsksForTheKeysAModelNeeds) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", surface_planes());
    const std::vector<std::string> before = folder.names();
    struct Case {
        const char* model;
        const char* key;
    };
    for (const Case& c : {Case{"blinn_phong_anisotropic", "shininess_u"}, Case{"blinn_phong_spectral", "metal"}}) {
        const Outcome run = run_in(folder, {"shade", "in.exr", "-o", "out.exr", "--model", c.model});
        EXPECT_EQ(run.exit_code, 2) << c.model;
        ASSERT_EQ(run.error_lines().size(), 1U) << run.err;
        EXPECT_THAT(run.err, AllOf(HasSubstr("--model"), HasSubstr(c.model), HasSubstr(c.key)));
        EXPECT_EQ(folder.names(), before);
    }
    const Outcome copper = run_in(folder, {"shade", "in.exr", "-o", "out.exr", "--model", "blinn_phong_spectral",
                                           "--set", "material.default.specular.metal=copper"});
    EXPECT_EQ(copper.exit_code, 0) << copper.err;
    const Outcome skin = run_in(folder, {"shade", "in.exr", "-o", "out.exr", "--set", "material.default.preset=skin"});
    EXPECT_EQ(skin.exit_code, 0) << skin.err;
}

} // namespace
} // namespace clshade::tests
