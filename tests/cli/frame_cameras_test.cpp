// Cameras by frame, end to end.
#include "tests/cli/gbuffers.h"
#include "tests/cli/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>

namespace clshade::tests {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Two frames without a camera of their own, and positions that could tell one: what [camera] says must count.
class FrameCameras : public ::testing::Test {
  protected:
    FrameCameras() {
        for (const char* name : {"in.0001.exr", "in.0002.exr"}) {
            write_gbuffer_without_camera(folder / name, surface_planes_without("Position"));
        }
    }

    void write_scene(const std::string& camera) const {
        write_bytes(folder / "s.toml", "version = 1\n[camera]\nfov_y_degrees = 40\n" + camera +
                                           "[[light]]\nname = 'key'\ntype = 'point'\nposition = [3, 2, 9]\n"
                                           "intensity = 90\n");
    }

    /// A camera at (x, 0, 5).
    static std::string matrix(const char* x) {
        return std::string("[[1,0,0,") + x + "],[0,1,0,0],[0,0,1,5],[0,0,0,1]]";
    }

    [[nodiscard]] Outcome shade(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"shade", "in.#.exr", "-o", "out.#.exr", "--scene", "s.toml"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        RunSettings settings;
        settings.folder = folder.path();
        return run_clshade(arguments, settings);
    }

    [[nodiscard]] std::vector<float> green(const char* name) const { return decode(folder / name).plane("G"); }

    TemporaryFolder folder;
};

TEST_F(FrameCameras, EveryFrameIsSeenByItsOwn) {
    write_scene("[camera.frames.1]\nmatrix_world = " + matrix("0") +
                "\n[camera.frames.2]\nmatrix_world = " + matrix("2") + "\n");
    const Outcome listed = shade();
    ASSERT_EQ(listed.exit_code, 0) << listed.err;
    const std::vector<float> first = green("out.0001.exr");
    const std::vector<float> second = green("out.0002.exr");
    EXPECT_NE(first, second) << "the same planes, seen from elsewhere";
    // The same cameras from side files.
    write_scene("file = 'c.%d.json'\n");
    write_bytes(folder / "c.1.json", R"({"matrix_world": )" + matrix("0") + "}");
    write_bytes(folder / "c.2.json", R"({"camera": {"name": "Cam", "matrix_world": )" + matrix("2") + "}}");
    const Outcome beside = shade();
    ASSERT_EQ(beside.exit_code, 0) << beside.err;
    EXPECT_EQ(green("out.0001.exr"), first);
    EXPECT_EQ(green("out.0002.exr"), second);
}

TEST_F(FrameCameras, ANewSideFileIsASource) {
    write_scene("file = 'c.%d.json'\n");
    for (const char* name : {"c.1.json", "c.2.json"}) {
        write_bytes(folder / name, R"({"matrix_world": )" + matrix("0") + "}");
    }
    ASSERT_EQ(shade().exit_code, 0);
    const auto status = [&] {
        const Outcome run = shade({"-u", "--json", "r.json"});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        std::vector<std::string> all;
        const nlohmann::json report = nlohmann::json::parse(bytes_of(folder / "r.json"));
        for (const auto& result : report.at("results")) {
            all.push_back(result.at("status"));
        }
        return all;
    };
    EXPECT_THAT(status(), ElementsAre("skipped", "skipped"));
    std::filesystem::last_write_time(folder / "c.2.json",
                                     std::filesystem::file_time_type::clock::now() + std::chrono::seconds(5));
    EXPECT_THAT(status(), ElementsAre("skipped", "ok"));
}

TEST_F(FrameCameras, WhatIsMissingIsNamed) {
    write_scene("file = 'c.%d.json'\n");
    write_bytes(folder / "c.1.json", R"({"matrix_world": )" + matrix("0") + "}");
    const Outcome missing = shade({"--skip-bad-frames"});
    EXPECT_EQ(missing.exit_code, 4);
    EXPECT_THAT(missing.err, AllOf(HasSubstr("c.2.json: cannot open"), HasSubstr("frame 2")));
    EXPECT_TRUE(std::filesystem::exists(folder / "out.0001.exr"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.0002.exr"));
    // A single file does not tell which frame it is.
    RunSettings settings;
    settings.folder = folder.path();
    const Outcome single = run_clshade({"shade", "in.0001.exr", "-o", "single.exr", "--scene", "s.toml"}, settings);
    EXPECT_EQ(single.exit_code, 2);
    EXPECT_THAT(single.err, AllOf(HasSubstr("s.toml: "), HasSubstr("--frames N")));
    // No interpolation.
    write_scene("[camera.frames.1]\nmatrix_world = " + matrix("0") + "\n");
    const Outcome gap = shade();
    EXPECT_NE(gap.exit_code, 0);
    EXPECT_THAT(gap.err, HasSubstr("no camera for frame 2"));
}

} // namespace
} // namespace clshade::tests
