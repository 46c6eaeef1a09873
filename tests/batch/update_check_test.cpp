// -u and --no-clobber.
#include "host/batch/update_check.h"
#include "tests/batch/support.h"
#include "tests/cli/gbuffers.h"
#include "tests/device/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

namespace clshade::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace std::chrono_literals;

class UpdateCheck : public ::testing::Test {
  protected:
    void SetUp() override {
        job_ = {1, folder_.path() / "in.exr", folder_.path() / "out.exr", {}};
        write_gbuffer(job_.input, surface_planes());
        scene_.tables = {folder_.path() / "metal.txt"};
        scene_.file = (folder_.path() / "scene.toml").string();
        scene_.environment = {folder_.path() / "studio.hdr"};
        settings_.tools = {folder_.path() / "program"};
        for (const auto& file : {scene_.tables[0], std::filesystem::path(scene_.file), scene_.environment[0],
                                 settings_.tools[0], job_.input}) {
            std::ofstream(file, std::ios::app | std::ios::binary).flush();
            std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now() - 1h);
        }
        settings_.update_only = true;
        TestResources resources;
        TestListener listener;
        run_batch(std::vector{job_}, scene_, settings_, resources, listener);
        ASSERT_THAT(listener.messages, IsEmpty());
    }
    [[nodiscard]] std::string reason() const {
        return reason_to_skip(job_, scene_, settings_, job_identity(scene_, settings_));
    }

    TemporaryFolder folder_;
    FrameJob job_;
    RunScene scene_ = plain_scene();
    BatchSettings settings_;
};

TEST_F(UpdateCheck, SkipsWhatIsCompleteAndNewer) {
    EXPECT_THAT(reason(), HasSubstr("-u"));
    settings_.update_only = false;
    EXPECT_EQ(reason(), "");
}

TEST_F(UpdateCheck, AnyNewerSourceCounts) {
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const auto& file : {job_.input, scene_.tables[0], std::filesystem::path(scene_.file), scene_.environment[0],
                             settings_.tools[0]}) {
        std::filesystem::last_write_time(file, now + 1h);
        EXPECT_EQ(reason(), "") << file;
        std::filesystem::last_write_time(file, now - 1h);
        EXPECT_NE(reason(), "") << file;
    }
    // As old as the output: nobody knows which came first.
    std::filesystem::last_write_time(job_.input, std::filesystem::last_write_time(job_.output));
    EXPECT_EQ(reason(), "");
    std::filesystem::last_write_time(job_.input, now - 1h);
    std::filesystem::remove(scene_.environment[0]); // a source that is gone is no proof
    EXPECT_EQ(reason(), "");
}

TEST_F(UpdateCheck, OtherWorkIsOtherWork) {
    BatchSettings other = settings_;
    const std::string identity = job_identity(scene_, settings_);
    EXPECT_EQ(job_identity(scene_, other), identity);
    other.exr.half = false;
    EXPECT_NE(job_identity(scene_, other), identity);
    other = settings_;
    other.aovs.diffuse = true;
    EXPECT_NE(job_identity(scene_, other), identity);
    other = settings_;
    other.keep = {"Albedo"};
    EXPECT_NE(job_identity(scene_, other), identity);
    other = settings_;
    other.exr.compression = "piz";
    EXPECT_NE(job_identity(scene_, other), identity);
    other = settings_;
    other.threads = 7;
    other.max_memory = 1;
    EXPECT_EQ(job_identity(scene_, other), identity) << "they do not change the picture";
    scene_.hash = "2";
    EXPECT_EQ(reason(), "");
}

TEST_F(UpdateCheck, DamagedOutputsAreMadeAgain) {
    const std::string good = bytes_of(job_.output);
    std::string bad = good;
    bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 1);
    for (const std::string& bytes : {bad, good.substr(0, good.size() - 1), std::string()}) {
        std::ofstream(job_.output, std::ios::binary) << bytes;
        EXPECT_EQ(reason(), "") << bytes.size();
    }
    std::ofstream(job_.output, std::ios::binary) << good;
    EXPECT_NE(reason(), "");
}

TEST_F(UpdateCheck, NoClobberAsksOnlyForTheFile) {
    settings_.update_only = false;
    settings_.no_clobber = true;
    std::ofstream(job_.output, std::ios::binary) << "not an image";
    EXPECT_THAT(reason(), HasSubstr("--no-clobber"));
    std::filesystem::remove(job_.output);
    EXPECT_EQ(reason(), "");
}

} // namespace
} // namespace clshade::tests
