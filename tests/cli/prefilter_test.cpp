// `prefilter` end to end: what it writes, says and refuses.
#include "tests/cli/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <string>

namespace clshade::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A Radiance picture without run lengths: grey 0.5, one texel 2^sun_exponent times as much.
void write_hdr(const std::filesystem::path& file, int width, int height, int sun_exponent = 0) {
    std::string bytes =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
    for (int i = 0; i < width * height; ++i) {
        const int exponent = 128 + (i == width * height / 3 ? sun_exponent : 0);
        bytes += std::string(3, static_cast<char>(128)) + static_cast<char>(exponent);
    }
    write_bytes(file, bytes);
}

class PrefilterVerb : public ::testing::Test {
  protected:
    Outcome run(const std::vector<std::string>& arguments) {
        RunSettings settings;
        settings.folder = folder.path();
        return run_clshade(arguments, settings);
    }
    [[nodiscard]] nlohmann::json report() const { return nlohmann::json::parse(bytes_of(folder / "r.json")); }

    TemporaryFolder folder;
};

TEST_F(PrefilterVerb, WritesASetAndKeepsASunsEnergy) {
    write_hdr(folder / "env.hdr", 64, 32, 18); // 0.5 and 131072
    const Outcome made = run({"prefilter", "env.hdr", "-o", "set", "--json", "r.json", "--runstats"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, AllOf(HasSubstr("radiance n=8192"), HasSubstr("irradiance"), HasSubstr("64x32 texels"),
                                HasSubstr("peak memory")));
    const nlohmann::json result = report()["results"][0];
    EXPECT_EQ(result["status"], "ok");
    EXPECT_EQ(result["width"], 64);
    EXPECT_EQ(result["hash"].get<std::string>().size(), 32U);
    ASSERT_EQ(result["maps"].size(), 15U);
    const double whole = result["mean"][0];
    EXPECT_GT(whole, 10.0);
    for (const auto& map : result["maps"]) {
        EXPECT_NEAR(map["mean"][0].get<double>() / whole, 1.0, 0.005) << map["map"]; // the bound
    }
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / "set" / "radiance_n8192.exr"));

    // The same again: from the cache, over the set that stands there.
    const Outcome again = run({"prefilter", "env.hdr", "-o", "set", "--json", "r.json"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(report()["results"][0]["from_cache"].get<bool>());
    EXPECT_THAT(again.out, HasSubstr("taken from the cache"));
}

TEST_F(PrefilterVerb, QuietSaysNothing) {
    write_hdr(folder / "env.hdr", 16, 8);
    const Outcome made = run({"prefilter", "env.hdr", "-o", "set", "-q"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(made.out, "");
}

TEST_F(PrefilterVerb, TellsAFarmHowFarItIs) {
    write_hdr(folder / "env.hdr", 64, 32, 3);
    const Outcome made = run({"prefilter", "env.hdr", "-o", "set", "--progress", "openjd"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, AllOf(HasSubstr("openjd_status: filtering"), HasSubstr("openjd_progress: 100")));
}

TEST_F(PrefilterVerb, RefusesAFolderThatIsNoSet) {
    write_hdr(folder / "env.hdr", 16, 8);
    std::filesystem::create_directory(folder / "photos");
    write_bytes(folder / "photos" / "holiday.jpg", "x");
    const Outcome refused = run({"prefilter", "env.hdr", "-o", "photos"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("photos"), HasSubstr("no pre-filtered set")));
    EXPECT_EQ(bytes_of(folder / "photos" / "holiday.jpg"), "x");
    write_bytes(folder / "file", "y");
    EXPECT_EQ(run({"prefilter", "env.hdr", "-o", "file"}).exit_code, 1);
    EXPECT_EQ(bytes_of(folder / "file"), "y");
}

TEST_F(PrefilterVerb, RefusesWhatIsNoEnvironment) {
    EXPECT_EQ(run({"prefilter"}).exit_code, 2);
    EXPECT_EQ(run({"prefilter", "env.hdr"}).exit_code, 2);
    const Outcome absent = run({"prefilter", "absent.hdr", "-o", "set"});
    EXPECT_EQ(absent.exit_code, 1);
    EXPECT_THAT(absent.err, HasSubstr("absent.hdr"));
    write_hdr(folder / "square.hdr", 16, 16);
    const Outcome square = run({"prefilter", "square.hdr", "-o", "set"});
    EXPECT_EQ(square.exit_code, 1);
    EXPECT_THAT(square.err, HasSubstr("square.hdr"));
    write_hdr(folder / "env.hdr", 16, 8);
    ASSERT_EQ(run({"prefilter", "env.hdr", "-o", "set", "-q"}).exit_code, 0);
    const Outcome twice = run({"prefilter", "set", "-o", "other"});
    EXPECT_EQ(twice.exit_code, 2);
    EXPECT_THAT(twice.err, HasSubstr("pre-filtered set already"));
    EXPECT_THAT(folder.names(), Not(::testing::Contains("other")));
}

} // namespace
} // namespace clshade::tests
