// Tables and lines of --runstats, from made-up frames.
#include "host/cli/run_stats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace clshade::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::MatchesRegex;
using ::testing::Pair;

clshade::FrameOutcome frame(const std::vector<std::pair<std::string, double>>& stages, double kernel_milliseconds) {
    clshade::FrameOutcome outcome;
    for (const auto& [stage, milliseconds] : stages) {
        outcome.stages.add(stage, milliseconds);
    }
    outcome.kernels.push_back({"shade.ward.lambert.distant1", kernel_milliseconds, 8'000'000});
    outcome.busy_milliseconds = 450.0;
    outcome.bytes_read = 30'000'000;
    outcome.bytes_written = 6'000'000;
    return outcome;
}

clshade::FrameOutcome first_frame() {
    return frame({{"read", 100.0},
                  {"device", 50.0},
                  {"build", 950.0},
                  {"transfer", 1.0},
                  {"kernel", 2.0},
                  {"prepare", 7.0},
                  {"write", 300.0}},
                 2.0);
}

clshade::FrameOutcome later_frame() {
    return frame({{"read", 120.0}, {"transfer", 1.0}, {"kernel", 2.0}, {"prepare", 7.0}, {"write", 260.0}}, 2.0);
}

clshade::FrameOutcome skipped_frame() {
    clshade::FrameOutcome outcome = first_frame();
    outcome.skipped = "the output is up to date (-u)";
    return outcome;
}

RunStats batch() {
    RunStats stats;
    stats.add(first_frame());
    stats.add(later_frame());
    stats.add(skipped_frame());
    stats.finish(500.0, 2);
    return stats;
}

// Without the last line, the memory of this very process.
std::string before_memory(const std::string& text) {
    return text.substr(0, text.find("peak memory: "));
}

TEST(StageTimes, SumsInTheOrderOfMeeting) {
    StageTimes times;
    times.add("write", 2.0);
    times.add("read", 1.0);
    times.add("write", 3.0);
    StageTimes more;
    more.add("kernel", 0.5);
    more.add("read", 0.5);
    times.add(more);
    EXPECT_THAT(times.stages(), ElementsAre(Pair("write", 5.0), Pair("read", 1.5), Pair("kernel", 0.5)));
    EXPECT_EQ(times.of("read"), 1.5);
    EXPECT_EQ(times.of("prepare"), 0.0);
    EXPECT_EQ(times.total(), 7.0);
    EXPECT_EQ(stages_json(times).dump(), R"({"kernel":0.5,"read":1.5,"total":7.0,"write":5.0})");
}

TEST(RunStats, TextOfABatch) {
    EXPECT_EQ(before_memory(batch().text()),
              "stage     total [ms]  per frame [ms]  share [%]\n"
              "device          50.0            once        2.8\n"
              "build          950.0            once       52.8\n"
              "read           220.0           110.0       12.2\n"
              "transfer       2.000           1.000        0.1\n"
              "kernel         4.000           2.000        0.2\n"
              "prepare         14.0           7.000        0.8\n"
              "write          560.0           280.0       31.1\n"
              "total           1800           400.0      100.0\n"
              "\n"
              "kernel                       launches  total [ms]  per launch [ms]  GB/s\n"
              "shade.ward.lambert.distant1         2       4.000            2.000  4.00\n"
              "\n"
              "frames: 2 shaded, 1 skipped\n"
              "wall time: 0.50 s, 4.00 frames per second (stages of frames in flight overlap)\n"
              "read: 60.0 MB, 120.0 MB/s\n"
              "written: 12.0 MB, 24.0 MB/s\n"
              "kernels: 0.8 % of the wall time\n"
              "decode + encode alone keep 2 threads busy for 0.45 s: this run took 1.11 times that\n");
    EXPECT_THAT(batch().text(), MatchesRegex("(.|\n)*\npeak memory: [1-9][0-9]* MiB\n"));
}

TEST(RunStats, TextOfOtherVerbsHasNoRun) {
    RunStats stats;
    StageTimes times;
    times.add("compare", 30.0);
    times.add("read", 10.0);
    stats.add(times);
    EXPECT_EQ(before_memory(stats.text()), "stage    total [ms]  per frame [ms]  share [%]\n"
                                           "read           10.0            10.0       25.0\n"
                                           "compare        30.0            30.0       75.0\n"
                                           "total          40.0            40.0      100.0\n"
                                           "\n");
}

TEST(RunStats, NothingShadedDividesByNothing) {
    RunStats stats;
    stats.add(skipped_frame());
    stats.finish(20.0, 1);
    EXPECT_EQ(before_memory(stats.text()), "stage  total [ms]  per frame [ms]  share [%]\n"
                                           "total       0.000           0.000        0.0\n"
                                           "\n"
                                           "frames: 0 shaded, 1 skipped\n"
                                           "wall time: 0.02 s, 0.00 frames per second\n"
                                           "read: 0.0 MB, 0.0 MB/s\n"
                                           "written: 0.0 MB, 0.0 MB/s\n"
                                           "kernels: 0.0 % of the wall time\n");
    EXPECT_TRUE(stats.json().at("ratio").is_null());
}

TEST(RunStats, OneThreadIsOne) {
    RunStats stats;
    stats.add(later_frame());
    stats.finish(450'000.0, 1);
    EXPECT_THAT(stats.text(),
                ::testing::HasSubstr(
                    "decode + encode alone keep 1 thread busy for 0.45 s: this run took 1000.00 times that\n"));
    EXPECT_THAT(stats.text(), ::testing::HasSubstr("frames: 1 shaded\nwall time: 450 s, 0.00 frames per second\n"));
}

TEST(RunStats, Json) {
    nlohmann::json result = batch().json();
    EXPECT_GT(result.at("peak_memory").get<double>(), 1e6) << "bytes";
    EXPECT_EQ(result.at("peak_memory").type(), nlohmann::json::value_t::number_unsigned);
    result.erase("peak_memory");
    EXPECT_EQ(result, nlohmann::json::parse(R"({
        "frames": 2, "skipped": 1, "bytes_read": 60000000, "bytes_written": 12000000,
        "stage_ms": {"device": 50.0, "build": 950.0, "read": 220.0, "transfer": 2.0, "kernel": 4.0, "prepare": 14.0,
                     "write": 560.0, "total": 1800.0},
        "kernel_ms": {"shade.ward.lambert.distant1": 4.0},
        "wall_ms": 500.0, "threads": 2, "fps": 4.0, "kernel_share": 0.008, "decode_encode_ms": 450.0,
        "ratio": 1.1111111111111112})"));
    RunStats unfinished;
    EXPECT_FALSE(unfinished.json().contains("ratio")) << "of a finished run only";
}

TEST(RunStats, SlowestStage) {
    RunStats stats;
    EXPECT_EQ(stats.slowest_stage(), "");
    stats.add(first_frame()); // its build counts once, so not at all
    EXPECT_EQ(stats.slowest_stage(), "write");
    stats.add(frame({{"read", 300.0}, {"write", 10.0}}, 1.0));
    EXPECT_EQ(stats.slowest_stage(), "read");
    stats.add(frame({{"transfer", 200.0}, {"kernel", 200.0}, {"prepare", 200.0}}, 200.0));
    EXPECT_EQ(stats.slowest_stage(), "shade");
}

} // namespace
} // namespace clshade::cli
