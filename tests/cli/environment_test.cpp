// Environments end to end: pictures, sets, the built-in studio; what is refused, counted, cached and shown.
#include "host/images/image_reader.h"
#include "tests/cli/gbuffers.h"
#include "tests/cli/run_program.h"

#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdlib>
#include <limits>
#include <vector>

namespace clshade::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr float grey = 0.5F;

/// Of a test picture's plane.
constexpr std::size_t pixel_index(int x, int y) {
    return static_cast<std::size_t>(y) * test_width + static_cast<std::size_t>(x);
}

/// A Radiance picture without run lengths: grey 0.5, the left half brighter by `stops` stops.
void write_hdr(const std::filesystem::path& file, int width, int height, int stops = 0) {
    std::string bytes =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            bytes += std::string(3, static_cast<char>(128));
            bytes += static_cast<char>(128 + (x < width / 2 ? stops : 0));
        }
    }
    write_bytes(file, bytes);
}

/// An OpenEXR picture of one value, marked as a cube map if wanted.
void write_grey_exr(const std::filesystem::path& file, int width, int height, float value, bool cube = false) {
    Imf::Header header(width, height);
    if (cube) {
        Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
    }
    const std::vector<Imf::Rgba> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                                        Imf::Rgba(value, value, value));
    Imf::RgbaOutputFile output(file.c_str(), header, Imf::WRITE_RGB);
    output.setFrameBuffer(pixels.data(), 1, static_cast<std::size_t>(width));
    output.writePixels(height);
}

/// A surface with a hole: no surface in the upper left quarter.
std::vector<TestPlane> planes_with_a_hole() {
    std::vector<TestPlane> planes = surface_planes();
    for (TestPlane& plane : planes) {
        plane.value = [name = plane.name, value = plane.value](int x, int y) {
            const bool hole = x < test_width / 2 && y < test_height / 2;
            return hole ? (name == "Depth.Z" ? 1e10F : 0.0F) : value(x, y);
        };
    }
    return planes;
}

class EnvironmentRun : public ::testing::Test {
  protected:
    void SetUp() override { write_gbuffer(folder / "in.exr", surface_planes()); }

    Outcome run(const std::vector<std::string>& arguments) {
        RunSettings settings;
        settings.folder = folder.path();
        return run_clshade(arguments, settings);
    }
    Outcome shade(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"shade", "in.exr", "-o", "out.exr", "-d", "float"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    /// A scene lit by nothing else, looked at in its own diffuse reflection.
    void write_scene(const std::string& environment, const std::string& more = "") {
        write_bytes(folder / "scene.toml",
                    "version = 1\n[environment]\n" + environment +
                        "\n[material.default]\nspecular = { model = \"none\" }\ndiffuse = { albedo = 1.0 }\n" + more);
    }
    [[nodiscard]] nlohmann::json result() const {
        return nlohmann::json::parse(bytes_of(folder / "r.json"))["results"][0];
    }
    [[nodiscard]] std::string scene_hash() const {
        return read_layout(folder / "out.exr").strings.at("clshade/scene_hash");
    }

    TemporaryFolder folder;
};

TEST_F(EnvironmentRun, LightsAndEnvironmentAddUpToThePicture) {
    const Outcome made = shade({"--aov", "lights,environment", "--runstats", "-v"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, AllOf(HasSubstr("\nenvironment "), HasSubstr("; environment ")));
    const Decoded image = decode(folder / "out.exr");
    double share = 0.0;
    for (std::size_t i = 0; i < image.plane("G").size(); ++i) {
        const float light = image.plane("light.key.G")[i];
        const float around = image.plane("environment.G")[i];
        EXPECT_NEAR(image.plane("G")[i], light + around, 1e-6F * (1.0F + light + around)) << i; // roundings near 1
        share += static_cast<double>(around);
    }
    EXPECT_GT(share, 0.0) << "the default scene has an environment";
    EXPECT_EQ(read_layout(folder / "out.exr").strings.at("clshade/environment"), "built-in studio");
}

TEST_F(EnvironmentRun, AConstantOneGivesTheAlbedo) {
    write_hdr(folder / "grey.hdr", 64, 32);
    for (const char* source : {"sh2", "sh3", "irradiance_map"}) {
        write_scene("image = \"grey.hdr\"\nintensity = 1.5\ndiffuse = \"" + std::string(source) + "\"");
        ASSERT_EQ(shade({"--scene", "scene.toml"}).exit_code, 0);
        const Decoded image = decode(folder / "out.exr");
        // Band 2 of a constant is what the sum over texel centres leaves, most at the poles: 5/96 (pi/32)^2 of it for
        // 32 rows. Else roundings of sums in single precision.
        const float left = std::string(source) == "sh3" ? 5.04e-4F : 0.0F;
        const float tolerance = 1.5F * grey * (left + 2e-6F);
        for (const float value : image.plane("R")) {
            EXPECT_NEAR(value, 1.5F * grey, tolerance) << source;
        }
    }
}

TEST_F(EnvironmentRun, TheAovNeedsOne) {
    write_bytes(folder / "scene.toml", "version = 1\n[[light]]\ntype = \"distant\"\ndirection = [0, 0, -1]\n"
                                       "irradiance = 1.0\n");
    const Outcome none = shade({"--scene", "scene.toml", "--aov", "environment"});
    EXPECT_EQ(none.exit_code, 2);
    ASSERT_EQ(none.error_lines().size(), 1U) << none.err;
    EXPECT_THAT(none.err, AllOf(HasSubstr("--aov environment"), HasSubstr("scene.toml"), HasSubstr("[environment]")));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

TEST_F(EnvironmentRun, IsToldByDryRunsAndInspect) {
    write_hdr(folder / "half.hdr", 64, 32, 2);
    write_scene("image = \"half.hdr\"", "[output]\nbackground = true\n");
    const Outcome dry = shade({"--scene", "scene.toml", "-n"});
    EXPECT_EQ(dry.exit_code, 0) << dry.err;
    EXPECT_THAT(dry.out, AllOf(HasSubstr("environment: half.hdr, 64x32 pixels"), HasSubstr("shown as background")));
    const Outcome told = run({"inspect", "in.exr", "--scene", "scene.toml", "--json", "r.json"});
    EXPECT_EQ(told.exit_code, 0) << told.err;
    EXPECT_THAT(told.out, HasSubstr("environment: half.hdr, 64x32 pixels, mean radiance (1.25, 1.25, 1.25)"));
    EXPECT_EQ(result()["environment"]["width"], 64);
    EXPECT_NEAR(result()["environment"]["mean"][1].get<double>(), 1.25, 1e-6); // 0.5 and 2: floats
    EXPECT_THAT(run({"inspect", "in.exr"}).out, HasSubstr("environment: built-in studio"));
}

TEST_F(EnvironmentRun, ASetGivesThePictureItWasMadeFrom) {
    write_hdr(folder / "half.hdr", 64, 32, 3);
    ASSERT_EQ(run({"prefilter", "half.hdr", "-o", "maps"}).exit_code, 0);
    const std::vector<std::string> flags{"--scene", "scene.toml"};
    const auto picture = [&](const std::string& image) {
        write_bytes(folder / "scene.toml", "version = 1\n[environment]\nrotation_degrees = 30.0\nimage = \"" + image +
                                               "\"\n[material.default]\ndiffuse = { albedo = \"albedo\" }\n");
        const Outcome made = shade(flags);
        EXPECT_EQ(made.exit_code, 0) << made.err;
        return decode(folder / "out.exr");
    };
    const Decoded from_picture = picture("half.hdr");
    const Decoded from_set = picture("maps");
    for (const char* channel : {"R", "G", "B", "A"}) {
        EXPECT_EQ(from_set.plane(channel), from_picture.plane(channel)) << channel;
    }
    // Nor has the reference anything against it, though it can tell nothing of the truth.
    EXPECT_EQ(run({"check", "in.exr", "--scene", "scene.toml"}).exit_code, 0);
    const Outcome truth = run({"check", "in.exr", "--scene", "scene.toml", "--ground-truth", "2"});
    EXPECT_EQ(truth.exit_code, 2);
    EXPECT_EQ(truth.error_lines().size(), 1U) << truth.err;
}

TEST_F(EnvironmentRun, ItsPictureIsASourceOfTheOutput) {
    write_hdr(folder / "env.hdr", 64, 32, 1);
    write_scene("image = \"env.hdr\"");
    const std::vector<std::string> flags{"--scene", "scene.toml", "-u", "--json", "r.json"};
    ASSERT_EQ(shade(flags).exit_code, 0);
    const std::string hash = scene_hash();
    ASSERT_EQ(shade(flags).exit_code, 0);
    EXPECT_EQ(result()["status"], "skipped");
    write_hdr(folder / "env.hdr", 64, 32, 2);
    std::filesystem::last_write_time(folder / "env.hdr",
                                     std::filesystem::last_write_time(folder / "out.exr") + std::chrono::seconds(5));
    ASSERT_EQ(shade(flags).exit_code, 0);
    EXPECT_EQ(result()["status"], "ok");
    EXPECT_NE(scene_hash(), hash) << "the scene's text is the same, the picture is not";
    const Outcome over = run({"shade", "in.exr", "-o", "env.exr", "--set", "environment.image=env.exr"});
    EXPECT_EQ(over.exit_code, 1) << "no such picture";
    std::filesystem::copy_file(folder / "in.exr", folder / "env.exr");
    EXPECT_EQ(run({"shade", "in.exr", "-o", "env.exr", "--set", "environment.image=env.exr"}).exit_code, 2)
        << "the output would overwrite the environment";
}

TEST_F(EnvironmentRun, StandsBehindTheObjects) {
    write_gbuffer(folder / "in.exr", planes_with_a_hole());
    write_hdr(folder / "grey.hdr", 64, 32);
    write_scene("image = \"grey.hdr\"\nintensity = 3.0", "[camera]\nmatrix_world = [[1,0,0,0],[0,1,0,0],[0,0,1,5],"
                                                         "[0,0,0,1]]\nfov_y_degrees = 40\n"
                                                         "[output]\nbackground = true\n");
    ASSERT_EQ(shade({"--scene", "scene.toml", "--aov", "environment"}).exit_code, 0);
    const Decoded image = decode(folder / "out.exr");
    for (int y = 0; y < test_height; ++y) {
        for (int x = 0; x < test_width; ++x) {
            const auto i = pixel_index(x, y);
            EXPECT_EQ(image.plane("A")[i], 1.0F);
            if (x < test_width / 2 && y < test_height / 2) {
                EXPECT_NEAR(image.plane("B")[i], 3.0F * grey, 1e-6F); // bilinear weights in single precision
                EXPECT_EQ(image.plane("environment.B")[i], 0.0F) << "AOVs have no background";
            }
        }
    }
    ASSERT_EQ(run({"shade", "in.exr", "-o", "with.png", "--scene", "scene.toml"}).exit_code, 0);
    ASSERT_EQ(run({"shade", "in.exr", "-o", "without.png", "--scene", "scene.toml", "--set", "output.background=false"})
                  .exit_code,
              0);
    EXPECT_NE(bytes_of(folder / "with.png"), bytes_of(folder / "without.png"));
    const Outcome check = run({"check", "in.exr", "--scene", "scene.toml"});
    EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
    // Directions of pixels are needed; a header with worldToCamera alone does not give them.
    write_gbuffer(folder / "in.exr", surface_planes_without("Position")); // from which it could be recovered
    write_scene("image = \"grey.hdr\"", "[output]\nbackground = true\n");
    const Outcome blind = shade({"--scene", "scene.toml"});
    EXPECT_EQ(blind.exit_code, 2) << blind.out;
    ASSERT_EQ(blind.error_lines().size(), 1U) << blind.err;
    EXPECT_THAT(blind.err, HasSubstr("fov_y_degrees"));
}

TEST_F(EnvironmentRun, CountsWhatItCleans) {
    write_grey_exr(folder / "negative.exr", 64, 32, -1.0F);
    const Outcome made = shade({"--set", "environment.image=negative.exr"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    ASSERT_EQ(made.error_lines().size(), 1U) << made.err;
    EXPECT_THAT(made.err, HasSubstr("negative.exr: 2048 texels were negative, 0 not finite: set to 0"));
    EXPECT_EQ(shade({"--set", "environment.image=negative.exr", "-q"}).err, "");
}

TEST_F(EnvironmentRun, IsHalvedToFitTheMemory) {
    write_hdr(folder / "large.hdr", 4096, 2048);
    const Outcome made = shade({"--set", "environment.image=large.hdr", "--max-mem", "40", "-n"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.err, HasSubstr("large.hdr: halved once to 2048x1024"));
    EXPECT_THAT(made.out, HasSubstr("large.hdr, 2048x1024 pixels"));
    write_scene("image = \"large.hdr\"", "[output]\nbackground = true\n");
    const Outcome shown = shade({"--scene", "scene.toml", "--max-mem", "40", "-n"});
    EXPECT_EQ(shown.exit_code, 1) << "a background is not halved in silence";
    EXPECT_EQ(shown.error_lines().size(), 1U) << shown.err;
}

struct BadEnvironment {
    const char* file;
    std::function<void(const std::filesystem::path&)> make;
    const char* word;
};

TEST_F(EnvironmentRun, RefusesWhatIsNoEnvironmentInOneLine) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<BadEnvironment> all{
        {"absent.hdr", [](const auto&) {}, "absent.hdr"},
        {"one.hdr", [](const auto& file) { write_hdr(file, 1, 1); }, "1x1"},
        {"square.hdr", [](const auto& file) { write_hdr(file, 32, 32); }, "32x32"},
        {"cube.exr", [](const auto& file) { write_grey_exr(file, 16, 96, 1.0F, true); }, "cube"},
        {"nan.exr", [nan](const auto& file) { write_grey_exr(file, 64, 32, nan); }, "nan.exr"},
        {"text.hdr", [](const auto& file) { write_bytes(file, "Lorem ipsum"); }, "text.hdr"},
        {"cut.hdr",
         [](const auto& file) {
             write_hdr(file, 64, 32);
             write_bytes(file, bytes_of(file).substr(0, 3000));
         },
         "cut.hdr"},
        {"folder", [](const auto& file) { std::filesystem::create_directory(file); }, "folder"},
    };
    for (const int frame : {1, 2}) { // told once, however many frames there are
        write_gbuffer(folder / ("in.000" + std::to_string(frame) + ".exr"), surface_planes());
    }
    for (const BadEnvironment& bad : all) {
        SCOPED_TRACE(bad.file);
        bad.make(folder / bad.file);
        const std::string flag = "environment.image=" + std::string(bad.file);
        const std::vector<std::string> before = folder.names();
        for (const auto& arguments :
             {std::vector<std::string>{"shade", "in.####.exr", "-o", "out.####.exr", "--set", flag},
              std::vector<std::string>{"check", "in.exr", "-q", "--set", flag}}) {
            const Outcome refused = run(arguments);
            EXPECT_EQ(refused.exit_code, 1) << refused.err;
            ASSERT_EQ(refused.error_lines().size(), 1U) << refused.err;
            EXPECT_THAT(refused.err, AllOf(StartsWith("clshade: "), HasSubstr(bad.file), HasSubstr(bad.word)));
            EXPECT_EQ(refused.out, "");
            EXPECT_EQ(folder.names(), before);
        }
    }
}

/// Sets a variable of the environment for one test.
class Variable {
  public:
    Variable(const char* name, const std::string& value) : name_(name), before_(std::getenv(name)) {
        ::setenv(name, value.c_str(), 1);
    }
    ~Variable() { ::setenv(name_, before_.c_str(), 1); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    Variable(Variable&&) = delete;
    Variable& operator=(Variable&&) = delete;

  private:
    const char* name_;
    std::string before_;
};

TEST_F(EnvironmentRun, ACacheCutShortDoesNotChangeThePicture) {
    write_hdr(folder / "env.hdr", 64, 32, 4);
    const Variable own_cache("XDG_CACHE_HOME", (folder / "cache").string());
    const std::vector<std::string> flags{"--set", "environment.image=env.hdr", "-v"};
    const Outcome first = shade(flags);
    ASSERT_EQ(first.exit_code, 0) << first.err;
    EXPECT_THAT(first.out, HasSubstr("environment built"));
    const std::string picture = bytes_of(folder / "out.exr");
    const Outcome second = shade(flags);
    EXPECT_THAT(second.out, HasSubstr("environment from the cache"));
    EXPECT_EQ(bytes_of(folder / "out.exr"), picture);
    std::size_t cut = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "cache")) {
        if (entry.is_regular_file() && entry.file_size() > 1) {
            std::filesystem::resize_file(entry.path(), entry.file_size() / 2);
            ++cut;
        }
    }
    ASSERT_GT(cut, 1U);
    const Outcome third = shade(flags);
    EXPECT_EQ(third.exit_code, 0) << third.err;
    EXPECT_THAT(third.out, HasSubstr("environment built"));
    EXPECT_EQ(bytes_of(folder / "out.exr"), picture);
}

TEST_F(EnvironmentRun, TellsHowFarItIsFromTheTruth) {
    const Outcome made = run({"check", "in.exr", "--ground-truth", "5", "--json", "r.json"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, AllOf(HasSubstr("blinn_phong.lambert"), HasSubstr("10..100"), HasSubstr("brute-force")));
    const auto rows = nlohmann::json::parse(bytes_of(folder / "r.json"))["ground_truth"];
    ASSERT_EQ(rows.size(), 1U); // roughness 0.4 everywhere: n = 76
    EXPECT_EQ(rows[0]["samples"], 5);
    EXPECT_EQ(rows[0]["decade"], 1);
    for (const char* part : {"specular", "diffuse", "total"}) {
        EXPECT_GT(rows[0][part]["mean"].get<double>(), 0.0) << part << ": an approximation is never exact";
        EXPECT_LT(rows[0][part]["p50"].get<double>(), 0.5) << part << ": nor quite wrong";
        EXPECT_GE(rows[0][part]["p99"].get<double>(), rows[0][part]["p50"].get<double>());
    }
    const Outcome built_in = run({"check", "--ground-truth", "1", "-q", "--json", "r.json"});
    EXPECT_EQ(built_in.exit_code, 0) << built_in.err;
    EXPECT_GT(nlohmann::json::parse(bytes_of(folder / "r.json"))["ground_truth"].size(), 20U);
    EXPECT_EQ(run({"check", "--ground-truth", "0"}).exit_code, 2);
    EXPECT_EQ(run({"check", "--ground-truth", "1", "--dump", "d.exr"}).exit_code, 2);
}

} // namespace
} // namespace clshade::tests
