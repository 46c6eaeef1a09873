// What a user and a farm see of a run while it goes on.
#include "host/cli/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace clshade::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

const std::string wipe = "\r\033[K";

ProgressState halfway() {
    return {185, 500, 37, 8.3, true, "shading x.exr", "write"};
}

TEST(ProgressText, PercentIsRoundedDown) {
    EXPECT_EQ(percent_of(0.0, 500), 0);
    EXPECT_EQ(percent_of(185.0, 500), 37);
    EXPECT_EQ(percent_of(29.0, 100), 29);
    EXPECT_EQ(percent_of(1.0, 3), 33);
    EXPECT_EQ(percent_of(499.999, 500), 99) << "100 is for what is over";
    EXPECT_EQ(percent_of(500.0, 500), 100);
    EXPECT_EQ(percent_of(501.0, 500), 100);
    EXPECT_EQ(percent_of(-1.0, 500), 0);
}

TEST(ProgressText, TimeLeft) {
    EXPECT_EQ(time_left_text(0.2), "0:01 left");
    EXPECT_EQ(time_left_text(37.95), "0:38 left");
    EXPECT_EQ(time_left_text(60.0), "1:00 left");
    EXPECT_EQ(time_left_text(59.5 * 60.0), "59:30 left");
    EXPECT_EQ(time_left_text(3599.5), "1:00:00 left");
    EXPECT_EQ(time_left_text(3723.0), "1:02:03 left");
    EXPECT_EQ(time_left_text(100.0 * 3600.0), "100:00:00 left");
    for (const double none :
         {0.0, -1.0, 1e12, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_EQ(time_left_text(none), "") << none;
    }
}

TEST(ProgressText, Rate) {
    EXPECT_EQ(rate_text(0.0), "");
    EXPECT_EQ(rate_text(0.0123), "0.0123 fps");
    EXPECT_EQ(rate_text(0.25), "0.25 fps");
    EXPECT_EQ(rate_text(8.34), "8.3 fps");
    EXPECT_EQ(rate_text(250.4), "250 fps");
}

TEST(ProgressText, Words) {
    EXPECT_EQ(progress_words(halfway()), "185 of 500 (37 %), 8.3 fps, 0:38 left");
    ProgressState state = halfway();
    state.frames = false;
    EXPECT_EQ(progress_words(state), "185 of 500 (37 %), 0:38 left") << "fps of frames only";
    state.rate = 0.0;
    EXPECT_EQ(progress_words(state), "185 of 500 (37 %)");
    EXPECT_EQ(progress_words({500, 500, 100, 8.3, true, "", ""}), "500 of 500 (100 %), 8.3 fps");
}

TEST(ProgressText, BarOfManyFrames) {
    EXPECT_EQ(bar_line(halfway(), 100),
              "[###########...................]  37 %  185/500  8.3 fps  0:38 left  slowest: write");
    EXPECT_EQ(bar_line(halfway(), 63), "[###.......]  37 %  185/500  8.3 fps  0:38 left  slowest: write")
        << "as wide as it takes";
    EXPECT_EQ(bar_line(halfway(), 64), "[####.......]  37 %  185/500  8.3 fps  0:38 left  slowest: write");
    EXPECT_EQ(bar_line(halfway(), 40), "[#####.........]  37 %  185/500  8.3 fps");
    EXPECT_EQ(bar_line(halfway(), 62), "[#########................]  37 %  185/500  8.3 fps  0:38 left")
        << "no half words";
    EXPECT_EQ(bar_line(halfway(), 10), "[###......");
    EXPECT_EQ(bar_line(halfway(), 0), "");
}

TEST(ProgressText, BarBeforeThereIsARate) {
    ProgressState state = halfway();
    state.rate = 0.0;
    state.slowest = "";
    EXPECT_EQ(bar_line(state, 42), "[###.......]  37 %  185/500  shading x.exr");
}

TEST(ProgressText, BarOfOneFrameAndOfOtherSteps) {
    EXPECT_EQ(bar_line({0, 1, 30, 0.0, true, "shading x.exr", ""}, 80),
              "[#########.....................]  30 %  shading x.exr");
    EXPECT_EQ(bar_line({3, 10, 30, 0.5, false, "comparing ward", "read"}, 80),
              "[#########.....................]  30 %  3/10  0:14 left  comparing ward");
}

TEST(ProgressText, OneLineCountsCharactersAndHasNoControls) {
    EXPECT_EQ(one_line_of("a\nb\033[2Jc", 80), "a?b?[2Jc");
    EXPECT_EQ(one_line_of("Gr\xC3\xBC\xC3\x9F"
                          "e",
                          4),
              "Gr\xC3\xBC\xC3\x9F");
    EXPECT_EQ(bar_line({0, 1, 0, 0.0, true, "\xC3\x9F\xC3\x9F\xC3\x9F", ""}, 22),
              "[..........]   0 %  \xC3\x9F\xC3\x9F");
}

TEST(FrameRate, IsUnknownBeforeTwoFrames) {
    FrameRate rate(0.0);
    EXPECT_EQ(rate.at(1.0), 0.0);
    rate.frame(1.0);
    EXPECT_EQ(rate.at(1.0), 0.0);
    rate.frame(2.0);
    EXPECT_DOUBLE_EQ(rate.at(2.0), 1.0);
}

TEST(FrameRate, ForgetsTheBuildAndFollowsChanges) {
    FrameRate rate(0.0);
    double now = 60.0; // a first build
    const auto run = [&](int frames, double each) {
        for (int i = 0; i < frames; ++i) {
            now += each;
            rate.frame(now);
        }
    };
    run(30, 0.1);
    EXPECT_NEAR(rate.at(now), 10.0, 1e-6) << "after three seconds";
    run(100, 0.1);
    EXPECT_NEAR(rate.at(now), 10.0, 1e-6);
    run(10, 0.5); // half of the last ten seconds is slow
    EXPECT_NEAR(rate.at(now), 6.0, 0.1);
    run(25, 0.5);
    EXPECT_NEAR(rate.at(now), 2.0, 1e-6);
}

TEST(FrameRate, FallsWhileAFrameTakesLonger) {
    FrameRate rate(0.0);
    for (int i = 1; i <= 200; ++i) {
        rate.frame(0.1 * i);
    }
    EXPECT_NEAR(rate.at(20.05), 10.0, 1e-6);
    EXPECT_LT(rate.at(30.0), 5.1);
    EXPECT_GT(rate.at(30.0), 4.9);
}

// Sixteen frames in flight, each of which takes twenty seconds: they end together.
TEST(FrameRate, IsNotFooledByBursts) {
    FrameRate rate(0.0);
    for (int burst = 1; burst <= 5; ++burst) {
        for (int frame = 0; frame < 16; ++frame) {
            rate.frame(20.0 * burst + 0.01 * frame);
            if (burst > 1) {
                EXPECT_LT(rate.at(20.0 * burst), 1.7) << burst << " " << frame;
            }
        }
        EXPECT_NEAR(rate.at(20.0 * burst + 0.15), 0.8, 0.06) << burst;
    }
}

TEST(FrameRate, SlowFramesAndSkippedOnes) {
    FrameRate rate(0.0);
    rate.restart(1000.0); // skipped for so long
    for (int i = 1; i <= 12; ++i) {
        rate.frame(1000.0 + 60.0 * i);
    }
    EXPECT_NEAR(rate.at(1720.0), 1.0 / 60.0, 1e-9);
    rate.restart(1720.0);
    EXPECT_NEAR(rate.at(1720.0), 1.0 / 60.0, 1e-9) << "what was measured stays";
}

struct Printed {
    std::string out;
    std::string err;
};

template <class Job>
Printed printed(ProgressMode mode, int total, Job&& job, Steps steps = Steps::frames) {
    CommonOptions options;
    options.progress = mode;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    {
        Progress progress(options, total, steps);
        job(progress);
    }
    const std::string out = testing::internal::GetCapturedStdout();
    return {out, testing::internal::GetCapturedStderr()};
}

void three_frames(Progress& progress) {
    for (const char* name : {"reading 1", "reading 2", "reading 3"}) {
        progress.update(name);
        progress.step();
    }
}

const std::string fps = R"([0-9.]+ fps)";

TEST(Progress, PlainHasALineForEachFrame) {
    const Printed run = printed(ProgressMode::plain, 3, three_frames);
    EXPECT_THAT(run.out, MatchesRegex("progress: 1 of 3 \\(33 %\\)\n"
                                      "progress: 2 of 3 \\(66 %\\), " +
                                      fps + ", 0:01 left\nprogress: 3 of 3 \\(100 %\\), " + fps + "\n"));
    EXPECT_EQ(run.err, "");
}

TEST(Progress, PlainOfOtherStepsHasNoFrames) {
    EXPECT_EQ(printed(
                  ProgressMode::plain, 2,
                  [](Progress& progress) {
                      progress.step();
                      progress.step();
                  },
                  Steps::other)
                  .out,
              "progress: 1 of 2 (50 %)\nprogress: 2 of 2 (100 %)\n");
}

TEST(Progress, SkippedFramesHaveNoRate) {
    const Printed run = printed(ProgressMode::plain, 4, [](Progress& progress) {
        progress.skip();
        progress.skip();
        progress.skip();
        progress.step();
    });
    EXPECT_EQ(run.out, "progress: 1 of 4 (25 %)\nprogress: 2 of 4 (50 %)\nprogress: 3 of 4 (75 %)\n"
                       "progress: 4 of 4 (100 %)\n");
}

TEST(Progress, OpenJobDescription) {
    const Printed run = printed(ProgressMode::openjd, 3, three_frames);
    EXPECT_THAT(run.out, MatchesRegex("openjd_status: reading 1\nopenjd_progress: 0\n"
                                      "openjd_progress: 33\nopenjd_status: 1 of 3 \\(33 %\\)\n"
                                      "openjd_progress: 66\nopenjd_status: 2 of 3 \\(66 %\\), " +
                                      fps + ", 0:01 left\nopenjd_progress: 100\nopenjd_status: 3 of 3 \\(100 %\\), " +
                                      fps + "\n"));
    EXPECT_EQ(run.err, "");
}

TEST(Progress, OpenJobDescriptionOfOneFrameSaysWhatIsDone) {
    const Printed run = printed(ProgressMode::openjd, 1, [](Progress& progress) {
        progress.update("reading", 0.0);
        progress.update("reading", 0.1);
        progress.update("shading", 0.5);
        progress.step();
    });
    EXPECT_EQ(run.out, "openjd_status: reading\nopenjd_progress: 0\nopenjd_progress: 10\n"
                       "openjd_status: shading\nopenjd_progress: 50\nopenjd_progress: 100\n");
}

TEST(Progress, FailuresAreOneLine) {
    const auto fail = [](Progress& progress) { progress.fail("frame 3: in.exr:\n  cut short"); };
    EXPECT_EQ(printed(ProgressMode::openjd, 3, fail).out, "openjd_fail: frame 3: in.exr:?  cut short\n");
    for (const ProgressMode mode : {ProgressMode::bar, ProgressMode::plain, ProgressMode::alf, ProgressMode::none}) {
        EXPECT_EQ(printed(mode, 3, fail).out, "");
    }
}

TEST(Progress, AlfredHearsOfWholePercentOnly) {
    EXPECT_EQ(printed(ProgressMode::alf, 3, three_frames).out,
              "ALF_PROGRESS 0%\nALF_PROGRESS 33%\nALF_PROGRESS 66%\nALF_PROGRESS 100%\n");
    const Printed many = printed(ProgressMode::alf, 1000, [](Progress& progress) {
        for (int i = 0; i < 1000; ++i) {
            progress.update("frame " + std::to_string(i));
            progress.step();
        }
    });
    EXPECT_EQ(std::count(many.out.begin(), many.out.end(), '\n'), 101);
}

TEST(Progress, NeverGoesBack) {
    const Printed run = printed(ProgressMode::alf, 2, [](Progress& progress) {
        progress.update("shading 1", 0.8);
        progress.update("reading 2", 0.0); // by another thread
        progress.update("shading 1", 0.9);
        progress.step();
        progress.update("shading 2", 0.1);
    });
    EXPECT_EQ(run.out, "ALF_PROGRESS 40%\nALF_PROGRESS 45%\nALF_PROGRESS 50%\nALF_PROGRESS 55%\n");
}

TEST(Progress, NeitherDoesTheBar) {
    const Printed run = printed(ProgressMode::bar, 2, [](Progress& progress) {
        progress.update("shading 1", 0.8);
        progress.update("reading 2", 0.0);
    });
    EXPECT_THAT(run.err, HasSubstr("  40 %  0/2  shading 1" + wipe));
    EXPECT_THAT(run.err, HasSubstr("  40 %  0/2  reading 2" + wipe));
}

TEST(Progress, NoneAndNoTerminalAreSilent) {
    for (const ProgressMode mode : {ProgressMode::none, ProgressMode::automatic}) {
        const Printed run = printed(mode, 3, three_frames);
        EXPECT_EQ(run.out + run.err, "");
    }
}

TEST(Progress, BarIsDrawnAndRemoved) {
    const Printed run = printed(ProgressMode::bar, 1, [](Progress& progress) { progress.update("reading", 0.5); });
    EXPECT_EQ(run.err, wipe + "[###############...............]  50 %  reading" + wipe);
    EXPECT_EQ(run.out, "");
    const Printed many = printed(ProgressMode::bar, 3, [](Progress& progress) {
        progress.set_slowest("write");
        three_frames(progress);
    });
    EXPECT_THAT(many.err, HasSubstr("   0 %  0/3  reading 1" + wipe));
    EXPECT_THAT(many.err, HasSubstr("  66 %  2/3  "));
    EXPECT_THAT(many.err, HasSubstr(" fps  0:01 left  slowest: write" + wipe));
}

// Without a terminal the width is taken as 80, of which one column stays free.
TEST(Progress, BarIsCutToTheWidth) {
    const Printed run =
        printed(ProgressMode::bar, 1, [](Progress& progress) { progress.update("shading " + std::string(200, 'x')); });
    EXPECT_EQ(run.err, wipe + "[..........]   0 %  shading " + std::string(79 - 28, 'x') + wipe);
}

TEST(Progress, BarIsRedrawnSeldom) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    const Printed run = printed(ProgressMode::bar, 100000, [](Progress& progress) {
        progress.step(); // no further phases to tell of
        for (int i = 0; i < 20000; ++i) {
            progress.update("frame " + std::to_string(i));
        }
    });
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const auto draws = static_cast<double>(std::count(run.err.begin(), run.err.end(), '\r') - 1); // the last removes it
    EXPECT_GE(draws, 5.0);
    EXPECT_LE(draws, 5.0 + 20.0 * seconds);
}

// However fast the phases of one frame follow each other: the last of them may take long.
TEST(Progress, BarShowsEveryPhaseOfOneFrame) {
    const Printed run = printed(ProgressMode::bar, 1, [](Progress& progress) {
        for (int i = 0; i < 100; ++i) {
            progress.update("filtering", 0.001 * i);
        }
        progress.update("building", 0.1);
    });
    EXPECT_THAT(run.err, HasSubstr("building" + wipe));
}

TEST(Progress, OtherOutputIsNotGarbled) {
    const std::string bar = wipe + "[###############...............]  50 %  shading";
    const Printed run = printed(ProgressMode::bar, 1, [](Progress& progress) {
        const auto line = [] { std::fputs("a line\n", stderr); };
        progress.print(line); // nothing to remove yet
        progress.update("shading", 0.5);
        progress.print(line);
        EXPECT_THROW(progress.print([] { throw std::runtime_error("full"); }), std::runtime_error);
        progress.print(line); // the bar was not there, so it does not come back
        progress.clear();
        progress.clear();
    });
    EXPECT_EQ(run.err, "a line\n" + bar + wipe + "a line\n" + bar + wipe + "a line\n");
}

class Logging : public ::testing::Test {
  protected:
    void SetUp() override {
        auto logger = std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::stderr_sink_mt>());
        logger->set_pattern("%l: %v");
        logger->set_level(spdlog::level::warn);
        spdlog::set_default_logger(std::move(logger));
    }
    void TearDown() override { spdlog::set_default_logger(before_); }

  private:
    std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
};

TEST_F(Logging, GoesRoundTheBar) {
    const std::string bar = wipe + "[###############...............]  50 %  shading";
    const auto sinks = spdlog::default_logger()->sinks();
    const Printed run = printed(ProgressMode::bar, 1, [&](Progress& progress) {
        progress.update("shading", 0.5);
        EXPECT_NE(spdlog::default_logger()->sinks(), sinks);
        spdlog::warn("one");
        spdlog::info("not of this level");
        progress.print([&] {
            spdlog::warn("two"); // takes the lock that print() holds
            progress.update("shading", 0.5);
        });
    });
    EXPECT_EQ(run.err, bar + wipe + "warning: one\n" + bar + wipe + "warning: two\n" + bar + wipe);
    EXPECT_EQ(spdlog::default_logger()->sinks(), sinks);
}

TEST_F(Logging, IsLeftAloneWithoutABar) {
    const auto sinks = spdlog::default_logger()->sinks();
    const Printed run = printed(ProgressMode::alf, 1, [&](Progress& progress) {
        EXPECT_EQ(spdlog::default_logger()->sinks(), sinks);
        spdlog::warn("one");
        progress.step();
    });
    EXPECT_EQ(run.err, "warning: one\n");
    EXPECT_EQ(run.out, "ALF_PROGRESS 100%\n");
}

// Eight threads at once: every line is whole and the percent only grow.
TEST_F(Logging, AndProgressComeFromManyThreads) {
    constexpr int threads = 8;
    constexpr int frames = 50;
    const auto shade = [](Progress& progress) {
        std::vector<std::jthread> workers;
        workers.reserve(threads);
        for (int worker = 0; worker < threads; ++worker) {
            workers.emplace_back([&progress, worker] {
                for (int frame = 0; frame < frames; ++frame) {
                    progress.update("reading " + std::to_string(worker), 0.3);
                    progress.set_slowest("read");
                    if (frame % 10 == 0) {
                        spdlog::warn("thread {}", worker);
                    }
                    progress.update("shading", 0.6);
                    frame % 2 == 0 ? progress.step() : progress.skip();
                }
            });
        }
    };
    std::istringstream farm(printed(ProgressMode::alf, threads * frames, shade).out);
    int last = -1;
    for (std::string line; std::getline(farm, line);) {
        std::smatch match;
        ASSERT_TRUE(std::regex_match(line, match, std::regex("ALF_PROGRESS ([0-9]+)%"))) << line;
        EXPECT_GT(std::stoi(match[1]), last);
        last = std::stoi(match[1]);
    }
    EXPECT_EQ(last, 100);

    std::istringstream lines(printed(ProgressMode::bar, threads * frames, shade).err);
    int warnings = 0;
    for (std::string line; std::getline(lines, line); ++warnings) {
        const std::size_t shown = line.rfind(wipe); // what stands on the line after the last removal
        line.erase(0, shown == std::string::npos ? 0 : shown + wipe.size());
        if (line.find("warning") == std::string::npos) {
            break; // the bar's own last removal
        }
        EXPECT_THAT(line, MatchesRegex("warning: thread [0-7]"));
    }
    EXPECT_EQ(warnings, threads * frames / 10);
}

} // namespace
} // namespace clshade::cli
