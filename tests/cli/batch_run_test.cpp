// Runs over sequences as a farm sees them: manifest, interruption, resume.
#include "tests/cli/gbuffers.h"
#include "tests/cli/run_program.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <string>

namespace clshade::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class BatchRun : public ::testing::Test {
  protected:
    void make_inputs(int count) {
        write_gbuffer(folder / "in.0001.exr", surface_planes());
        const std::string bytes = bytes_of(folder / "in.0001.exr");
        for (int frame = 2; frame <= count; ++frame) {
            write_bytes(folder / fmt::format("in.{:04d}.exr", frame), bytes);
        }
    }
    [[nodiscard]] Outcome shade(std::vector<std::string> more, std::function<int(double)> meanwhile = {}) const {
        std::vector<std::string> arguments{"shade", "in.####.exr", "-o", "out.####.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        RunSettings settings;
        settings.folder = folder.path();
        settings.meanwhile = std::move(meanwhile);
        return run_clshade(arguments, settings);
    }
    [[nodiscard]] nlohmann::json report() const { return nlohmann::json::parse(bytes_of(folder / "r.json")); }

    TemporaryFolder folder;
};

TEST_F(BatchRun, TheManifestKnowsEveryFrame) {
    make_inputs(3);
    write_bytes(folder / "in.0002.exr", "no picture");
    const Outcome run = shade({"--json", "r.json", "--skip-bad-frames"});
    EXPECT_EQ(run.exit_code, 4) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr("frame 2: skipped: in.0002.exr"), HasSubstr("1 of 3 frames failed: 2")));
    const nlohmann::json document = report();
    EXPECT_THAT(document.at("scene_hash").get<std::string>(), ::testing::SizeIs(32));
    EXPECT_THAT(document.at("job").get<std::string>(), ::testing::SizeIs(32));
    EXPECT_EQ(document.at("run").at("frames"), 2);
    ASSERT_EQ(document.at("results").size(), 3U);
    const nlohmann::json& first = document.at("results").at(0);
    EXPECT_EQ(first.at("frame"), 1);
    EXPECT_THAT(first.at("input_hash").get<std::string>(), ::testing::SizeIs(32));
    EXPECT_EQ(first.at("input_hash"), document.at("results").at(2).at("input_hash")) << "the same bytes";
    EXPECT_EQ(first.at("output_hash").get<std::string>().size(), 16U);
    EXPECT_EQ(first.at("bytes_written"), std::filesystem::file_size(folder / "out.0001.exr"));
    EXPECT_GT(first.at("bytes_read"), 0);
    for (const char* stage : {"read", "kernel", "write", "total"}) {
        EXPECT_GT(first.at("stage_ms").at(stage), 0.0) << stage;
    }
    EXPECT_EQ(document.at("results").at(1).at("status"), "skipped");
    EXPECT_THAT(document.at("results").at(1).at("reason").get<std::string>(), HasSubstr("in.0002.exr"));
}

// A bad frame is told of while the others still wait for the environment, which is none of its faults.
TEST_F(BatchRun, ABadFrameIsNotTakenForABadEnvironment) {
    make_inputs(3);
    write_bytes(folder / "in.0001.exr", bytes_of(folder / "in.0002.exr").substr(0, 3000));
    std::string rows;
    for (int y = 0; y < 64; ++y) { // a picture nobody has filtered before, so that filtering takes its time
        for (int x = 0; x < 128; ++x) {
            rows += static_cast<char>(40 + (x * 7 + y * 13) % 150);
            rows += static_cast<char>(60);
            rows += static_cast<char>(80);
            rows += static_cast<char>(130);
        }
    }
    write_bytes(folder / "sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 64 +X 128\n" + rows);
    const Outcome run = shade({"--set", "environment.image=sky.hdr"});
    EXPECT_EQ(run.exit_code, 4) << run.err;
    EXPECT_THAT(run.err, HasSubstr("1 of 3 frames failed: 1"));
    EXPECT_TRUE(std::filesystem::exists(folder / "out.0002.exr"));
    EXPECT_TRUE(std::filesystem::exists(folder / "out.0003.exr"));
}

// Stopped in mid-run: within a second, with a report of what is done, and -u goes on from there.
TEST_F(BatchRun, AnInterruptedRunReportsAndGoesOn) {
    constexpr int frames = 150;
    make_inputs(frames);
    const auto third = folder / "out.0003.exr";
    double sent = 0.0;
    const Outcome run = shade({"--json", "r.json", "-q"}, [&](double seconds) {
        if (sent == 0.0 && std::filesystem::exists(third)) {
            sent = seconds;
            return SIGINT;
        }
        return 0;
    });
    ASSERT_GT(sent, 0.0) << run.err;
    EXPECT_EQ(run.exit_code, 130) << run.err;
    EXPECT_LT(run.seconds - sent, 1.0);
    EXPECT_THAT(run.err, HasSubstr("interrupted"));
    const nlohmann::json document = report();
    EXPECT_EQ(document.at("interrupted"), true);
    EXPECT_LT(document.at("results").size(), static_cast<std::size_t>(frames));
    std::size_t written = 0;
    for (const std::string& name : folder.names()) {
        EXPECT_THAT(name, Not(HasSubstr(".tmp")));
        written += name.starts_with("out.") ? 1 : 0;
    }
    EXPECT_EQ(written, document.at("results").size()) << "what is there is in the report";
    const Outcome again = shade({"--json", "r.json", "-u"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    std::size_t skipped = 0;
    const nlohmann::json second = report();
    for (const nlohmann::json& result : second.at("results")) {
        skipped += result.at("status") == "skipped" ? 1 : 0;
    }
    EXPECT_EQ(skipped, written);
    EXPECT_TRUE(bytes_of(folder / fmt::format("out.{:04d}.exr", frames)) == bytes_of(third));
}

// Another flag is another job: -u does not take the old picture for the new one.
TEST_F(BatchRun, UpdatesFollowTheFlags) {
    make_inputs(1);
    ASSERT_EQ(shade({}).exit_code, 0);
    EXPECT_THAT(shade({"-u"}).out, HasSubstr("skipped"));
    const std::string before = bytes_of(folder / "out.0001.exr");
    const Outcome other = shade({"-u", "--set", "material.default.specular.shininess=5"});
    EXPECT_THAT(other.out, Not(HasSubstr("skipped")));
    EXPECT_NE(bytes_of(folder / "out.0001.exr"), before);
}

// The lines of README's section on batches, run by a shell as they stand.
TEST(Readme, BatchLinesRunAsWritten) {
    const std::string readme = bytes_of(std::filesystem::path(CLSHADE_SOURCE_DIR) / "README.md");
    const std::string fence = "```sh\n";
    const std::size_t section = readme.find("\n## Batches\n");
    ASSERT_NE(section, std::string::npos);
    const std::size_t begin = readme.find(fence, section) + fence.size();
    const std::string lines = readme.substr(begin, readme.find("```", begin) - begin);
    ASSERT_EQ(std::count(lines.begin(), lines.end(), '\n'), 5) << lines;

    const TemporaryFolder folder;
    for (const char* frame : {"1", "2", "3"}) {
        write_gbuffer_without_camera(folder / fmt::format("anim.000{}.exr", frame), surface_planes());
        write_bytes(folder / fmt::format("anim.000{}.json", frame),
                    R"({"camera": {"matrix_world": [[1,0,0,0],[0,1,0,0],[0,0,1,5],[0,0,0,1]], "fov_y_deg": 40.0}})");
    }
    const std::filesystem::path program = CLSHADE_PROGRAM;
    const std::string command = fmt::format("cd '{}' && PATH='{}':\"$PATH\" && set -e\n{}", folder.path().string(),
                                            program.parent_path().string(), lines);
    EXPECT_EQ(std::system(command.c_str()), 0);
    for (const char* name : {"lit.0003.exr", "part.0001.exr", "seen.0002.png", "manifest.json"}) {
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "part.0003.exr")) << "of the other chunk";
    for (const char* frame : {"1", "2", "3"}) {
        EXPECT_TRUE(bytes_of(folder / fmt::format("tight.000{}.exr", frame)) ==
                    bytes_of(folder / fmt::format("lit.000{}.exr", frame)))
            << frame;
    }
}

} // namespace
} // namespace clshade::tests
