// What the program says of itself, and how it takes flags.
#include "tests/cli/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <map>
#include <ostream>

namespace clshade::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::vector<std::string> verb_names{"shade",     "check", "bench",   "inspect",
                                          "prefilter", "demo",  "devices", "models"};

TEST(Help, AloneAndOnRequest) {
    const Outcome alone = run_clshade({});
    EXPECT_EQ(alone.exit_code, 0);
    for (const std::string& verb : verb_names) {
        EXPECT_THAT(alone.out, HasSubstr("\n  " + verb + " ")) << verb;
    }
    EXPECT_EQ(run_clshade({"--help"}).out, alone.out);
    EXPECT_EQ(run_clshade({"help"}).out, alone.out);
    EXPECT_EQ(alone.err, "");
}

TEST(Help, EveryVerbHasAPage) {
    for (const std::string& verb : verb_names) {
        const Outcome page = run_clshade({"help", verb});
        EXPECT_EQ(page.exit_code, 0) << verb;
        EXPECT_THAT(page.out, StartsWith("Usage: clshade " + verb)) << verb;
        EXPECT_EQ(run_clshade({verb, "--help"}).out, page.out) << verb;
        EXPECT_THAT(page.out, HasSubstr("Exit codes: 0 done; 1 run-time failure; 2 bad usage")) << verb;
        for (const char* flag : {"--json FILE", "--verbose", "--quiet"}) {
            EXPECT_THAT(page.out, HasSubstr(flag)) << verb;
        }
    }
}

// The public interface's flags, verb by verb.
TEST(Help, NamesEveryFlag) {
    const std::vector<std::string> common{"--device",   "--threads",  "--max-mem", "-v,",     "-q,",         "--json",
                                          "--runstats", "--progress", "--seed",    "--lanes", "--kernel-dir"};
    const std::map<std::string, std::vector<std::string>> own{
        {"shade",
         {"-o,", "--scene", "--frames", "-d ", "--compression", "--aov", "--keep", "--model", "--set", "-u,",
          "--no-clobber", "--skip-bad-frames", "--chunk", "-n,", "--view", "--dump-kernel"}},
        {"check", {"--scene", "--rel", "--abs", "--percentile", "--dump", "--ground-truth", "--model", "--set"}},
        {"bench", {"--filter", "--size", "--compare", "--regress", "--tune"}},
        {"demo", {"--size", "--frames"}},
        {"models", {"--thumbnails"}},
    };
    for (const auto& [verb, flags] : own) {
        const std::string page = run_clshade({"help", verb}).out;
        for (const auto& list : {common, flags}) {
            for (const std::string& flag : list) {
                EXPECT_THAT(page, HasSubstr("\n  " + flag)) << verb;
            }
        }
    }
    const std::string shade = run_clshade({"help", "shade"}).out;
    for (const char* word : {"auto | bar | plain | openjd | alf | none", "auto | 1 | 4 | 8 | 16", "cpu | gpu",
                             "diffuse,specular,lights,environment", "half | float", "####", "%04d", "1-100x2", "MiB"}) {
        EXPECT_THAT(shade, HasSubstr(word));
    }
}

TEST(Help, Version) {
    const Outcome run = run_clshade({"--version"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.out, ::testing::MatchesRegex("clshade [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

struct WrongFlags {
    const char* name;
    std::vector<std::string> arguments;
    std::vector<std::string> words;
};

// How GoogleTest shows the case.
[[maybe_unused]] std::ostream& operator<<(std::ostream& stream, const WrongFlags& test) {
    return stream << test.name;
}

class Usage : public ::testing::TestWithParam<WrongFlags> {};

TEST_P(Usage, IsOneLineAndCode2) {
    const Outcome run = run_clshade(GetParam().arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    ASSERT_EQ(run.error_lines().size(), 1U) << run.err;
    EXPECT_THAT(run.err, StartsWith("clshade: "));
    for (const std::string& word : GetParam().words) {
        EXPECT_THAT(run.err, HasSubstr(word));
    }
    EXPECT_EQ(run.out, "");
}

INSTANTIATE_TEST_SUITE_P(
    Flags, Usage,
    ::testing::Values(
        WrongFlags{"unknown_verb", {"shad"}, {"'shad'", "did you mean 'shade'?"}},
        WrongFlags{"unknown_flag", {"shade", "x.exr", "--devcie", "0"}, {"'--devcie'", "did you mean '--device'?"}},
        WrongFlags{"unknown_flag_with_value", {"bench", "--fliter=x"}, {"'--fliter'", "did you mean '--filter'?"}},
        WrongFlags{"unknown_flag_before_missing_output", {"shade", "x.exr", "--outptu", "y.exr"}, {"'--output'?"}},
        WrongFlags{"flag_before_verb", {"-v", "shade"}, {"'-v'", "VERB"}},
        WrongFlags{"no_value", {"shade", "--threads"}, {"--threads"}},
        WrongFlags{"threads_zero", {"check", "--threads", "0"}, {"--threads", "'0'"}},
        WrongFlags{"threads_word", {"check", "--threads", "many"}, {"--threads", "'many'"}},
        WrongFlags{"memory_negative", {"check", "--max-mem", "-5"}, {"--max-mem", "'-5'"}},
        WrongFlags{"lanes", {"check", "--lanes", "3"}, {"--lanes", "auto, 1, 4, 8, 16"}},
        WrongFlags{"seed", {"check", "--seed", "1.5"}, {"--seed"}},
        WrongFlags{"progress", {"shade", "--progress", "opendj"}, {"did you mean 'openjd'?"}},
        WrongFlags{"too_many", {"inspect", "a.exr", "b.exr"}, {"'b.exr'", "too many"}},
        WrongFlags{"no_input", {"shade"}, {"INPUT"}}, WrongFlags{"no_output", {"shade", "a.exr"}, {"-o OUTPUT"}},
        WrongFlags{"inspect_nothing", {"inspect"}, {"INPUT"}},
        WrongFlags{"tolerance", {"check", "--rel", "nan"}, {"--rel", "'nan'"}},
        WrongFlags{"negative_tolerance", {"check", "--abs", "-1"}, {"--abs", "'-1'"}},
        WrongFlags{"percentile", {"check", "--percentile", "101"}, {"--percentile"}},
        WrongFlags{"size", {"bench", "--size", "1280"}, {"--size", "WIDTHxHEIGHT"}},
        WrongFlags{"filter", {"bench", "--filter", "("}, {"--filter"}},
        WrongFlags{"filter_nothing", {"bench", "--filter", "no_such_kernel", "--list"}, {"no_such_kernel"}},
        WrongFlags{"model", {"models", "lambret"}, {"did you mean 'lambert'?"}},
        WrongFlags{"prefilter", {"prefilter", "env.hdr"}, {"-o SET"}},
        WrongFlags{"kernel_dir", {"check", "--kernel-dir", "/no/such/folder"}, {"/no/such/folder"}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Devices, ListsAndReports) {
    const TemporaryFolder folder;
    const Outcome run = run_clshade({"devices", "--json", (folder / "d.json").string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto report = nlohmann::json::parse(bytes_of(folder / "d.json"));
    EXPECT_EQ(report["version"], 1);
    EXPECT_EQ(report["command"], "devices");
    EXPECT_FALSE(report["clshade"].get<std::string>().empty());
    ASSERT_FALSE(report["results"].empty());
    const auto& first = report["results"][0];
    EXPECT_EQ(first["status"], "ok");
    EXPECT_THAT(run.out, HasSubstr(first["name"].get<std::string>()));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"d.json"});
}

TEST(Devices, AWrongSelectorIsCode5) {
    for (const char* verb : {"devices", "check", "bench"}) {
        const Outcome run = run_clshade({verb, "--device", "no-such-device"});
        EXPECT_EQ(run.exit_code, 5) << verb;
        ASSERT_EQ(run.error_lines().size(), 1U) << run.err;
        EXPECT_THAT(run.err, AllOf(StartsWith("clshade: "), HasSubstr("no-such-device"), HasSubstr("0: ")));
    }
}

TEST(Reports, CannotBeLostSilently) {
    const Outcome full = run_clshade({"models", "--json", "/dev/full"});
    EXPECT_EQ(full.exit_code, 1);
    ASSERT_EQ(full.error_lines().size(), 1U) << full.err;
    EXPECT_THAT(full.err, HasSubstr("/dev/full"));
    const Outcome missing = run_clshade({"models", "--json", "/no/such/folder/r.json"});
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_THAT(missing.err, HasSubstr("/no/such/folder/r.json"));
}

TEST(Reports, TellErrorsToo) {
    const TemporaryFolder folder;
    const Outcome run = run_clshade({"inspect", "missing.exr", "--json", (folder / "r.json").string()});
    EXPECT_EQ(run.exit_code, 1);
    const auto report = nlohmann::json::parse(bytes_of(folder / "r.json"));
    ASSERT_EQ(report["results"].size(), 1U);
    EXPECT_EQ(report["results"][0]["status"], "error");
    EXPECT_THAT(report["results"][0]["reason"].get<std::string>(), HasSubstr("missing.exr"));
}

} // namespace
} // namespace clshade::tests
