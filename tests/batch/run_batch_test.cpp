// Runs over sequences: bytes, order, failures, interruption.
#include "host/images/completion.h"
#include "tests/batch/support.h"
#include "tests/cli/gbuffers.h"
#include "tests/device/temporary_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace clshade::tests {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RunBatch : public ::testing::Test {
  protected:
    static constexpr int frames = 6;

    // Frames that differ: the roughness grows.
    void SetUp() override {
        for (int number = 1; number <= frames; ++number) {
            std::vector<TestPlane> planes = surface_planes_without("Roughness");
            planes.push_back({"Roughness.V", [number](int x, int y) {
                                  return 0.1F * static_cast<float>(number) + 0.001F * static_cast<float>(x + y);
                              }});
            write_gbuffer(input(number), planes);
        }
    }

    [[nodiscard]] std::filesystem::path input(int number) const {
        return folder_.path() / fmt::format("in.{:04d}.exr", number);
    }
    [[nodiscard]] std::filesystem::path output(int number) const {
        return folder_.path() / "out" / fmt::format("out.{:04d}.exr", number);
    }
    [[nodiscard]] std::vector<FrameJob> jobs() const {
        std::filesystem::create_directories(folder_.path() / "out");
        std::vector<FrameJob> all;
        for (int number = 1; number <= frames; ++number) {
            all.push_back({number, input(number), output(number), {}});
        }
        return all;
    }
    [[nodiscard]] std::vector<std::string> outputs() const {
        std::vector<std::string> all;
        for (int number = 1; number <= frames; ++number) {
            all.push_back(bytes_of(output(number)));
        }
        return all;
    }
    void clear_outputs() const { std::filesystem::remove_all(folder_.path() / "out"); }

    TemporaryFolder folder_;
    RunScene scene_ = plain_scene();
};

TEST_F(RunBatch, BytesDependOnNeitherThreadsNorMemoryNorOrder) {
    BatchSettings settings;
    settings.aovs.lights = true;
    settings.keep = {"Albedo"};
    TestResources resources(settings.aovs);
    std::vector<std::string> expected;
    for (const int threads : {1, 2, 5}) {
        for (const std::uint64_t memory : {0U, 1U}) { // all there is; nothing, hence bands
            for (const bool backwards : {false, true}) {
                clear_outputs();
                std::vector<FrameJob> order = jobs();
                if (backwards) {
                    std::reverse(order.begin(), order.end());
                }
                settings.threads = threads;
                settings.max_memory = memory;
                TestListener listener;
                run_batch(order, scene_, settings, resources, listener);
                ASSERT_THAT(listener.messages, IsEmpty());
                EXPECT_EQ(listener.outcomes.front().bands > 1, memory == 1U);
                if (expected.empty()) {
                    expected = outputs();
                    EXPECT_NE(expected[0], expected[1]);
                }
                EXPECT_TRUE(outputs() == expected) << threads << " threads, memory " << memory << ", " << backwards;
            }
        }
    }
}

// The camera comes from positions all over the picture: bands must find the same one.
TEST_F(RunBatch, BandsRecoverTheSameCamera) {
    for (int number = 1; number <= frames; ++number) {
        write_gbuffer_without_camera(input(number), surface_planes());
    }
    BatchSettings settings;
    TestResources resources;
    TestListener listener;
    run_batch(jobs(), scene_, settings, resources, listener);
    ASSERT_THAT(listener.messages, IsEmpty());
    EXPECT_EQ(listener.outcomes.front().camera, "recovered from the position plane");
    const std::vector<std::string> whole = outputs();
    settings.max_memory = 1;
    run_batch(jobs(), scene_, settings, resources, listener);
    ASSERT_THAT(listener.messages, IsEmpty());
    EXPECT_GT(listener.outcomes.back().bands, 1);
    EXPECT_TRUE(outputs() == whole);
}

TEST_F(RunBatch, TellsOfFramesInTheirOrder) {
    BatchSettings settings;
    settings.threads = 4;
    TestResources resources;
    TestListener listener;
    run_batch(jobs(), scene_, settings, resources, listener);
    EXPECT_THAT(listener.done, ElementsAre(1, 2, 3, 4, 5, 6));
    for (const FrameOutcome& outcome : listener.outcomes) {
        EXPECT_EQ(outcome.width, test_width);
        EXPECT_GT(outcome.bytes_read, 0U);
        EXPECT_GT(outcome.busy_milliseconds, 0.0);
        EXPECT_THAT(outcome.output_hash, ::testing::SizeIs(16));
    }
    EXPECT_FALSE(listener.outcomes[0].build.empty());
    EXPECT_TRUE(listener.outcomes[1].build.empty()) << "one kernel, built once";
}

TEST_F(RunBatch, AFailureIsItsOwnFrames) {
    std::filesystem::remove(input(2));
    std::ofstream(input(4), std::ios::binary) << bytes_of(input(4)).substr(0, 2000);
    BatchSettings settings;
    settings.threads = 3;
    TestResources resources;
    TestListener listener;
    run_batch(jobs(), scene_, settings, resources, listener);
    EXPECT_THAT(listener.done, ElementsAre(1, 3, 5, 6));
    EXPECT_THAT(listener.bad, ElementsAre(2, 4));
    EXPECT_THAT(listener.messages[0], HasSubstr("in.0002.exr"));
    EXPECT_THAT(listener.messages[1], HasSubstr("in.0004.exr"));
    EXPECT_THAT(names_in(folder_.path() / "out"),
                ::testing::UnorderedElementsAre("out.0001.exr", "out.0003.exr", "out.0005.exr", "out.0006.exr"));
}

TEST_F(RunBatch, EndsWithAFailureThatIsNotSurvived) {
    std::filesystem::remove(input(3));
    BatchSettings settings;
    TestResources resources;
    TestListener listener;
    listener.go_on = false;
    EXPECT_THROW(run_batch(jobs(), scene_, settings, resources, listener), std::exception);
    EXPECT_THAT(listener.bad, ElementsAre(3));
    EXPECT_FALSE(std::filesystem::exists(output(6)));
}

TEST_F(RunBatch, AnInterruptionLeavesWholeFramesOnly) {
    BatchSettings settings;
    settings.threads = 2;
    TestResources resources;
    TestListener listener;
    listener.stop_after = 2;
    run_batch(jobs(), scene_, settings, resources, listener);
    EXPECT_GE(listener.done.size(), 2U);
    EXPECT_LT(listener.done.size(), static_cast<std::size_t>(frames));
    for (const std::string& name : names_in(folder_.path() / "out")) {
        EXPECT_TRUE(read_completion_stamp(folder_.path() / "out" / name).has_value()) << name;
    }
}

// Written anew in mid-frame: no picture of the old one may pass for one of the new one.
TEST_F(RunBatch, RefusesInputsThatChangeInHand) {
    class Changer final : public BatchResources {
      public:
        Changer(TestResources& real, std::filesystem::path file) : real_(real), file_(std::move(file)) {}
        Shader& shader() override { return real_.shader(); }
        const DeviceInfo& device() override { return real_.device(); }
        const EnvironmentInput* environment(StageTimes& /*stages*/) override { return nullptr; }
        void about_to_shade(const Frame& frame) override {
            if (frame.file == file_.string()) {
                std::filesystem::last_write_time(file_, std::filesystem::file_time_type::clock::now());
            }
        }

      private:
        TestResources& real_;
        std::filesystem::path file_;
    };
    TestResources real;
    Changer resources(real, input(3));
    TestListener listener;
    run_batch(jobs(), scene_, {}, resources, listener);
    EXPECT_THAT(listener.bad, ElementsAre(3));
    EXPECT_THAT(listener.messages[0], AllOf(HasSubstr("in.0003.exr"), HasSubstr("written anew")));
    EXPECT_FALSE(std::filesystem::exists(output(3)));
}

// What killed processes left behind goes away; what living ones write stays.
TEST_F(RunBatch, ClearsAwayWhatKilledRunsLeft) {
    const std::vector<FrameJob> all = jobs();
    const std::filesystem::path out = folder_.path() / "out";
    const std::filesystem::path stale = out / ".out.0003.exr.4242-7.tmp";
    const std::filesystem::path living = out / ".out.0004.exr.4242-8.tmp";
    const std::filesystem::path foreign = out / ".other.0003.exr.4242-7.tmp";
    for (const std::filesystem::path& file : {stale, living, foreign}) {
        std::ofstream(file) << "half a picture";
    }
    const int descriptor = ::open(living.c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(::flock(descriptor, LOCK_EX | LOCK_NB), 0);
    BatchSettings settings;
    TestResources resources;
    TestListener listener;
    run_batch(all, scene_, settings, resources, listener);
    EXPECT_FALSE(std::filesystem::exists(stale));
    EXPECT_TRUE(std::filesystem::exists(living));
    EXPECT_TRUE(std::filesystem::exists(foreign)) << "not of this run's files";
    ::close(descriptor);
}

// Frames of other sizes in one sequence: memory is planned anew, nothing of the last frame shows.
TEST_F(RunBatch, SizesMayChangeOnTheWay) {
    BatchSettings settings;
    settings.threads = 2;
    TestResources resources;
    TestListener listener;
    run_batch(jobs(), scene_, settings, resources, listener);
    const std::vector<std::string> expected = outputs();
    clear_outputs();
    std::vector<FrameJob> mixed = jobs();
    const std::filesystem::path crop = std::filesystem::path(CLSHADE_TEST_DATA) / "suzanne_crop.exr";
    mixed.insert(mixed.begin() + 3, {99, crop, folder_.path() / "out/crop.exr", {}});
    mixed.insert(mixed.begin() + 1, {98, crop, folder_.path() / "out/again.exr", {}});
    TestListener second;
    run_batch(mixed, scene_, settings, resources, second);
    EXPECT_THAT(second.messages, IsEmpty());
    EXPECT_TRUE(outputs() == expected);
    EXPECT_EQ(bytes_of(folder_.path() / "out/crop.exr"), bytes_of(folder_.path() / "out/again.exr"));
}

} // namespace
} // namespace clshade::tests
