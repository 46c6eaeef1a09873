// `shade` end to end.
#include "host/images/image_reader.h"
#include "tests/cli/gbuffers.h"
#include "tests/cli/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <limits>

namespace clshade::tests {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

std::filesystem::path crop(const char* name) {
    return std::filesystem::path(CLSHADE_TEST_DATA) / name;
}

Outcome shade_in(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "shade");
    RunSettings settings;
    settings.folder = folder.path();
    return run_clshade(arguments, settings);
}

std::size_t lit_pixels(const Decoded& image) {
    std::size_t lit = 0;
    for (const float value : image.plane("G")) {
        EXPECT_TRUE(std::isfinite(value));
        lit += value > 0.01F ? 1 : 0;
    }
    return lit;
}

TEST(Shade, BlenderCropsWithNoSceneAtAll) {
    for (const char* name : {"suzanne_crop.exr", "room_crop.exr", "fileoutput_crop.exr"}) {
        const TemporaryFolder folder;
        const Outcome run = shade_in(folder, {crop(name).string(), "-o", "out.exr"});
        ASSERT_EQ(run.exit_code, 0) << name << run.err;
        const Decoded image = decode(folder / "out.exr");
        EXPECT_GT(lit_pixels(image), image.plane("G").size() / 20) << name;
        for (const float alpha : image.plane("A")) {
            EXPECT_TRUE(alpha >= 0.0F && alpha <= 1.0F);
        }
        const Window in = read_layout(crop(name)).parts[0].data_window;
        EXPECT_EQ(read_layout(folder / "out.exr").parts[0].data_window, in);
        EXPECT_EQ(read_layout(folder / "out.exr").display_window, read_layout(crop(name)).display_window);
        EXPECT_EQ(folder.names(), std::vector<std::string>{"out.exr"});
    }
}

TEST(Shade, AlbedoDecidesTheBrightness) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", surface_planes());
    // Diffuse light only: the picture is in proportion to albedo, which is 1 on the left and 0.2 on the right.
    const Outcome run = shade_in(folder, {"in.exr", "-o", "out.exr", "-d", "float", "--set",
                                          "material.default.specular={model=\"none\"}", "--set",
                                          "material.default.diffuse={model=\"lambert\",albedo=\"albedo\"}"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    write_gbuffer(folder / "white.exr", [] {
        std::vector<TestPlane> planes = surface_planes_without("Albedo");
        for (const char* name : {"Albedo.R", "Albedo.G", "Albedo.B"}) {
            planes.push_back({name, [](int, int) { return 1.0F; }});
        }
        return planes;
    }());
    ASSERT_EQ(shade_in(folder, {"white.exr", "-o", "white_out.exr", "-d", "float", "--set",
                                "material.default.specular={model=\"none\"}", "--set",
                                "material.default.diffuse={model=\"lambert\",albedo=\"albedo\"}"})
                  .exit_code,
              0);
    const Decoded image = decode(folder / "out.exr");
    const Decoded white = decode(folder / "white_out.exr");
    for (std::size_t i = 0; i < image.plane("R").size(); ++i) {
        const bool left = static_cast<int>(i) % test_width < test_width / 2;
        // One rounding of the albedo 0.2 and one of each product: 4 roundings of 6e-8.
        const float expected = white.plane("R")[i] * (left ? 1.0F : 0.2F);
        EXPECT_NEAR(image.plane("R")[i], expected, 2.4e-7F * expected) << i;
    }
}

TEST(Shade, SameBytesFromRunToRunAndForAnyThreadsAndMemory) {
    const TemporaryFolder folder;
    const std::string input = crop("suzanne_crop.exr").string();
    const std::vector<std::vector<std::string>> ways{
        {}, {}, {"--threads", "1"}, {"--threads", "2"}, {"--max-mem", "1"}};
    std::string first;
    for (const auto& way : ways) {
        std::vector<std::string> arguments{input, "-o", "out.exr", "--aov", "diffuse,specular,lights,environment"};
        arguments.insert(arguments.end(), way.begin(), way.end());
        ASSERT_EQ(shade_in(folder, arguments).exit_code, 0);
        const std::string bytes = bytes_of(folder / "out.exr");
        first = first.empty() ? bytes : first;
        EXPECT_EQ(bytes, first) << ::testing::PrintToString(way);
    }
}

TEST(Shade, AovsAddUpAndKeptLayersAreExact) {
    const TemporaryFolder folder;
    const TestPlane id{"MaterialID.V", [](int x, int y) { return static_cast<float>(3000 + x + y); }};
    write_gbuffer(folder / "in.exr", surface_planes_and(id));
    const Outcome run = shade_in(folder, {"in.exr", "-o", "out.exr", "-d", "float", "--aov", "diffuse,specular,lights",
                                          "--keep", "MaterialID,Position"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Decoded image = decode(folder / "out.exr");
    const Decoded input = decode(folder / "in.exr");
    EXPECT_THAT(image.names, IsSupersetOf({"R", "G", "B", "A", "diffuse.R", "specular.B", "light.key.G"}));
    for (const char* kept : {"MaterialID.V", "Position.X", "Position.Y", "Position.Z"}) {
        EXPECT_EQ(image.plane(kept), input.plane(kept)) << kept;
    }
    for (std::size_t i = 0; i < image.plane("R").size(); ++i) {
        const float sum = image.plane("diffuse.R")[i] + image.plane("specular.R")[i];
        EXPECT_NEAR(image.plane("R")[i], sum, 1e-6F * (1.0F + sum)) << i; // a few roundings of sums near 1
    }
}

TEST(Shade, OutputTellsHowItWasMade) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", surface_planes());
    ASSERT_EQ(shade_in(folder, {"in.exr", "-o", "out.exr"}).exit_code, 0);
    const ImageLayout layout = read_layout(folder / "out.exr");
    for (const char* name : {"clshade/version", "clshade/device", "clshade/driver", "clshade/scene",
                             "clshade/scene_hash", "clshade/kernel", "clshade/camera"}) {
        ASSERT_TRUE(layout.strings.contains(name)) << name;
        EXPECT_FALSE(layout.strings.at(name).empty()) << name;
    }
    EXPECT_EQ(layout.strings.at("clshade/scene"), "default");
    EXPECT_TRUE(layout.matrices.contains("worldToCamera"));
    ASSERT_EQ(
        shade_in(folder, {"in.exr", "-o", "other.exr", "--set", "material.default.specular.shininess=7"}).exit_code, 0);
    EXPECT_NE(read_layout(folder / "other.exr").strings.at("clshade/scene_hash"),
              layout.strings.at("clshade/scene_hash"));
}

// The matrix written for a recovered camera must lead back to the same camera: shading the output's own kept planes
// with it gives the same picture.
TEST(Shade, WritesTheCameraItRecovered) {
    const TemporaryFolder folder;
    ASSERT_EQ(shade_in(folder, {crop("suzanne_crop.exr").string(), "-o", "out.exr"}).exit_code, 0);
    RunSettings settings;
    settings.folder = folder.path();
    const auto eye_of = [&](const std::string& file) {
        const Outcome run = run_clshade({"inspect", file, "-q", "--json", "i.json"}, settings);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        const auto camera = nlohmann::json::parse(bytes_of(folder / "i.json"))["results"][0]["camera"];
        return std::pair(camera["eye"].get<std::vector<double>>(), camera["view_axis"].get<std::vector<double>>());
    };
    const auto recovered = eye_of(crop("suzanne_crop.exr").string());
    const auto written = eye_of("out.exr");
    for (std::size_t i = 0; i < 3; ++i) {
        // The header stores floats: 6e-8 relative, of coordinates around 10, through a matrix and its inverse.
        EXPECT_NEAR(written.first[i], recovered.first[i], 1e-5);
        EXPECT_NEAR(written.second[i], recovered.second[i], 1e-6);
    }
}

TEST(Shade, WritesAPreview) {
    const TemporaryFolder folder;
    const Outcome run = shade_in(folder, {crop("suzanne_crop.exr").string(), "-o", "out.png"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(bytes_of(folder / "out.png").substr(1, 3), "PNG");
    const Outcome aov = shade_in(folder, {crop("suzanne_crop.exr").string(), "-o", "b.png", "--aov", "diffuse"});
    EXPECT_EQ(aov.exit_code, 2);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"out.png"});
}

TEST(Shade, CountsBadPixelsAndSaysSo) {
    const TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const TestPlane rough{"Roughness.V", [nan](int x, int y) { return x == 3 && y < 5 ? nan : 0.4F; }};
    write_gbuffer(folder / "in.exr", surface_planes_and(rough));
    const Outcome run = shade_in(folder, {"in.exr", "-o", "out.exr", "--json", "r.json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("5 pixels with NaN or Inf"));
    const auto result = nlohmann::json::parse(bytes_of(folder / "r.json"))["results"][0];
    EXPECT_EQ(result["nonfinite"], 5);
    EXPECT_EQ(result["pixels"], test_width * test_height);
    EXPECT_EQ(result["status"], "ok");
    EXPECT_TRUE(result["stage_ms"].contains("read") && result["stage_ms"].contains("total"));
    EXPECT_FALSE(result["kernel_ms"].empty());
    const Decoded image = decode(folder / "out.exr");
    for (const char* channel : {"R", "G", "B", "A"}) {
        EXPECT_EQ(image.plane(channel)[3], 0.0F);
        EXPECT_GT(image.plane(channel)[4], 0.0F);
    }
    const Outcome quiet = shade_in(folder, {"in.exr", "-o", "out.exr", "-q"});
    EXPECT_EQ(quiet.err + quiet.out, "");
}

TEST(Shade, DryRunWritesNothing) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", surface_planes());
    const Outcome run = shade_in(folder, {"in.exr", "-o", "out.exr", "-n"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("would shade in.exr -> out.exr"));
    EXPECT_THAT(run.out, HasSubstr("Normal.X Normal.Y Normal.Z"));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"in.exr"});
}

TEST(Shade, RunStatsNameStagesAndKernels) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", surface_planes());
    const Outcome run = shade_in(folder, {"in.exr", "-o", "out.exr", "--runstats"});
    EXPECT_EQ(run.exit_code, 0);
    for (const char* word : {"read", "build", "kernel", "write", "total", "GB/s", "peak memory", "shade."}) {
        EXPECT_THAT(run.out, HasSubstr(word));
    }
}

class Sequence : public ::testing::Test {
  protected:
    void SetUp() override {
        for (const int frame : {1, 2, 3, 4}) {
            write_gbuffer(folder / ("in.000" + std::to_string(frame) + ".exr"), surface_planes());
        }
    }
    [[nodiscard]] std::vector<std::string> outputs() const {
        std::vector<std::string> names = folder.names();
        std::erase_if(names, [](const std::string& name) { return !name.starts_with("out."); });
        return names;
    }
    TemporaryFolder folder;
};

TEST_F(Sequence, ShadesWhatIsOnDisk) {
    const Outcome run = shade_in(folder, {"in.####.exr", "-o", "out.%04d.exr"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(outputs(), ElementsAre("out.0001.exr", "out.0002.exr", "out.0003.exr", "out.0004.exr"));
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 4) << "one line a frame";
}

TEST_F(Sequence, TakesRangesAndChunks) {
    EXPECT_EQ(shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--frames", "1-4x3"}).exit_code, 0);
    EXPECT_THAT(outputs(), ElementsAre("out.0001.exr", "out.0004.exr"));
    EXPECT_EQ(shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--chunk", "2/4"}).exit_code, 0);
    EXPECT_THAT(outputs(), ElementsAre("out.0001.exr", "out.0002.exr", "out.0004.exr"));
    EXPECT_EQ(shade_in(folder, {"in.#.exr", "-o", "out.exr", "--frames", "1-2"}).exit_code, 2);
}

TEST_F(Sequence, OneBadFrameDoesNotStopTheRest) {
    write_bytes(folder / "in.0002.exr", "not an image");
    for (const char* flag : {"-v", "--skip-bad-frames"}) {
        const Outcome run = shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--json", "r.json", flag});
        EXPECT_EQ(run.exit_code, 4) << run.err;
        EXPECT_THAT(run.err, HasSubstr("frame 2"));
        EXPECT_THAT(run.err, HasSubstr("in.0002.exr"));
        EXPECT_THAT(outputs(), ElementsAre("out.0001.exr", "out.0003.exr", "out.0004.exr"));
        const auto results = nlohmann::json::parse(bytes_of(folder / "r.json"))["results"];
        ASSERT_EQ(results.size(), 4U);
        EXPECT_EQ(results[1]["frame"], 2);
        EXPECT_EQ(results[1]["status"], std::string(flag) == "-v" ? "error" : "skipped");
        EXPECT_THAT(results[1]["reason"].get<std::string>(), HasSubstr("in.0002.exr"));
        EXPECT_EQ(results[2]["status"], "ok");
    }
}

TEST_F(Sequence, AMissingFrameIsOneOfThem) {
    const Outcome run = shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--frames", "3-6"});
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_THAT(outputs(), ElementsAre("out.0003.exr", "out.0004.exr"));
    const Outcome none = shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--frames", "7-8"});
    EXPECT_EQ(none.exit_code, 1) << "nothing was written: the frames' own code";
}

TEST_F(Sequence, UpdateSkipsWhatIsNewerAndComplete) {
    const auto shade_again = [&] {
        return shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "-u", "--json", "r.json"});
    };
    const auto statuses = [&] {
        const nlohmann::json report = nlohmann::json::parse(bytes_of(folder / "r.json"));
        std::vector<std::string> all;
        for (const auto& result : report["results"]) {
            all.push_back(result["status"]);
        }
        return all;
    };
    ASSERT_EQ(shade_again().exit_code, 0);
    EXPECT_THAT(statuses(), ElementsAre("ok", "ok", "ok", "ok"));
    const std::string whole = bytes_of(folder / "out.0002.exr");
    write_bytes(folder / "out.0002.exr", whole.substr(0, whole.size() / 2)); // newer, but not complete
    const auto later = std::filesystem::last_write_time(folder / "out.0003.exr") + std::chrono::seconds(5);
    std::filesystem::last_write_time(folder / "in.0003.exr", later); // complete, but older
    EXPECT_EQ(shade_again().exit_code, 0);
    EXPECT_THAT(statuses(), ElementsAre("skipped", "ok", "ok", "skipped"));
    EXPECT_EQ(bytes_of(folder / "out.0002.exr"), whole);
}

TEST_F(Sequence, NoClobberLeavesWhatIsThere) {
    write_bytes(folder / "out.0001.exr", "mine");
    EXPECT_EQ(shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--no-clobber"}).exit_code, 0);
    EXPECT_EQ(bytes_of(folder / "out.0001.exr"), "mine");
    EXPECT_EQ(outputs().size(), 4U);
}

TEST_F(Sequence, ProgressForFarms) {
    const Outcome openjd = shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--progress", "openjd"});
    EXPECT_THAT(openjd.out, HasSubstr("openjd_progress: 50\n"));
    EXPECT_THAT(openjd.out, HasSubstr("openjd_progress: 100\n"));
    EXPECT_THAT(openjd.out, HasSubstr("openjd_status: "));
    const Outcome alf = shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--progress", "alf"});
    EXPECT_THAT(alf.out, HasSubstr("ALF_PROGRESS 100%\n"));
    const Outcome plain = shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--progress", "plain"});
    EXPECT_THAT(plain.out, HasSubstr("\nprogress: 2 of 4 (50 %), "));
    write_bytes(folder / "in.0001.exr", "bad");
    const Outcome failing = shade_in(folder, {"in.#.exr", "-o", "out.#.exr", "--progress", "openjd"});
    EXPECT_THAT(failing.out, HasSubstr("openjd_fail: frame 1: "));
    EXPECT_THAT(plain.err + alf.err, Not(HasSubstr("\r"))) << "no bar without a terminal";
}

// Interrupted in the middle of a long sequence, while a file is being written: the code says so, every output that is
// there is whole, and there is no temporary.
TEST_F(Sequence, InterruptionLeavesNothingHalfWritten) {
    constexpr int many = 300;
    for (int frame = 5; frame <= many; ++frame) {
        std::string name = std::to_string(frame);
        name.insert(0, 4 - name.size(), '0');
        std::filesystem::create_hard_link(folder / "in.0001.exr", folder / ("in." + name + ".exr"));
    }
    const auto writing = [&] {
        const std::vector<std::string> names = folder.names();
        return std::any_of(names.begin(), names.end(), [](const std::string& name) {
            return !name.starts_with("in.") && !(name.starts_with("out.") && name.ends_with(".exr"));
        });
    };
    int caught_writing = 0;
    for (int round = 0; round < 10; ++round) {
        const int signal = round % 2 == 0 ? SIGINT : SIGTERM;
        RunSettings settings;
        settings.folder = folder.path();
        bool sent = false;
        settings.meanwhile = [&](double) {
            const bool now = !sent && std::filesystem::exists(folder / "out.0003.exr") && writing();
            sent = sent || now;
            return now ? signal : 0;
        };
        const Outcome run = run_clshade({"shade", "in.####.exr", "-o", "out.####.exr", "-q"}, settings);
        caught_writing += sent ? 1 : 0;
        EXPECT_EQ(run.exit_code, !sent ? 0 : (signal == SIGINT ? 130 : 143));
        EXPECT_FALSE(writing()) << "a temporary was left";
        for (const std::string& name : outputs()) {
            EXPECT_EQ(decode(folder / name).width, test_width) << name;
            std::filesystem::remove(folder / name);
        }
    }
    EXPECT_GT(caught_writing, 0) << "no write was ever seen: the test proves nothing";
}

} // namespace
} // namespace clshade::tests
