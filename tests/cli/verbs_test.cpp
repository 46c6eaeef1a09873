// `check`, `inspect`, `demo` and `bench` end to end.
#include "tests/cli/gbuffers.h"
#include "tests/cli/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <set>

namespace clshade::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string crop(const char* name) {
    return (std::filesystem::path(CLSHADE_TEST_DATA) / name).string();
}

nlohmann::json report_of(const std::filesystem::path& file) {
    return nlohmann::json::parse(bytes_of(file));
}

Outcome run_in(const TemporaryFolder& folder, const std::vector<std::string>& arguments, double timeout = 120.0) {
    RunSettings settings;
    settings.folder = folder.path();
    settings.timeout_seconds = timeout;
    return run_clshade(arguments, settings);
}

TEST(Check, EveryModelOnARandomGBuffer) {
    const TemporaryFolder folder;
    const Outcome run = run_in(folder, {"check", "--size", "96x64", "--json", "c.json", "--dump", "d.exr"}, 600.0);
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
    const nlohmann::json report = report_of(folder / "c.json");
    std::set<std::string> models;
    for (const auto& result : report["results"]) {
        models.insert(result["model"].get<std::string>());
        EXPECT_EQ(result["status"], "ok");
        EXPECT_TRUE(result["pass"].get<bool>()) << result["model"];
        EXPECT_GT(result["pixels"].get<int>(), 1000);
        for (const char* key : {"max_rel", "max_abs", "rms_rel", "p99_rel", "max_ulp"}) {
            EXPECT_TRUE(result[key].is_number()) << key;
        }
        EXPECT_TRUE(result["worst"].contains("inputs") && result["worst"].contains("device") &&
                    result["worst"].contains("reference"));
        EXPECT_FALSE(result["worst"]["inputs"].empty());
    }
    // 3 lobes times 8 diffuse models without none.none, 2 x 3 of the other lobes, 4 with exact Fresnel, 15 stacks, 8
    // random ones, 6 presets; each under a name of its own.
    constexpr std::size_t under_lights = 23 + 6 + 4 + 15 + 8 + 6;
    // In an environment: 3 x 4 lobes and one with constants, 7 diffuse models, 3 sources under a lobe, 6 ways of
    // Oren-Nayar of which 2 with every source, 2 x (3 x 2 + 2) stacks and a deep one, 2 backgrounds, 4 random ones, 6
    // presets.
    EXPECT_EQ(models.size(), under_lights + 13 + 7 + 3 + 10 + 17 + 2 + 4 + 6);
    for (const char* model :
         {"none.oren_nayar_full", "blinn_phong_anisotropic.lambert", "blinn_phong_spectral.none",
          "blinn_phong_exact.lambert.exact", "layers2.blinn_phong.lambert.constant.none",
          "layers2.blinn_phong.lambert.exact.original", "layers8.blinn_phong.lambert.exact.original",
          "layers2.blinn_phong.oren_nayar.constant.approximated@skin", "blinn_phong_spectral.none@gold",
          "blinn_phong_anisotropic.none@environment.sh2.alone", "none.oren_nayar@environment.irradiance_map.order1",
          "layers2.blinn_phong.lambert.exact.original@environment.irradiance_map.exponential.none",
          "blinn_phong.lambert@environment.irradiance_map.alone.background.aov"}) {
        EXPECT_TRUE(models.contains(model)) << model;
    }
    const Decoded dump = decode(folder / "d.exr");
    EXPECT_EQ(dump.width, 96);
    EXPECT_EQ(dump.names.size(), 9 * models.size());
    EXPECT_FALSE(dump.plane("random8.error.B").empty());
    const auto& device = dump.plane("blinn_phong.lambert.device.G");
    const auto& reference = dump.plane("blinn_phong.lambert.reference.G");
    const auto& error = dump.plane("blinn_phong.lambert.error.G");
    for (std::size_t i = 0; i < device.size(); ++i) {
        // error is the difference of unrounded values; both have been rounded to float since.
        EXPECT_NEAR(error[i], device[i] - reference[i], 1.2e-7F * std::abs(reference[i]));
    }
}

TEST(Check, ABlenderCrop) {
    const TemporaryFolder folder;
    for (const char* name : {"suzanne_crop.exr", "room_crop.exr"}) {
        // The promise for n up to 2048: 99.99 % of the pixels within 1e-5 relative + 1e-7 absolute.
        const Outcome run = run_in(folder, {"check", crop(name), "--rel", "1e-5", "--abs", "1e-7", "--percentile",
                                            "99.99", "--set", "material.default.specular.shininess=2048"});
        EXPECT_EQ(run.exit_code, 0) << name << "\n" << run.out << run.err;
        EXPECT_THAT(run.out, AllOf(HasSubstr("blinn_phong.lambert"), HasSubstr("pass")));
        // Pixels without a surface have their own row: they must stay 0.
        const bool has_background = std::string(name) == "suzanne_crop.exr";
        EXPECT_EQ(run.out.find("no_surface") != std::string::npos, has_background);
        const Outcome defaults = run_in(folder, {"check", crop(name)});
        EXPECT_EQ(defaults.exit_code, 0) << name << "\n" << defaults.out << defaults.err;
    }
}

TEST(Check, CanFail) {
    const TemporaryFolder folder;
    const Outcome run =
        run_in(folder, {"check", crop("suzanne_crop.exr"), "--rel", "0", "--abs", "0", "--json", "c.json"});
    EXPECT_EQ(run.exit_code, 3) << run.out;
    EXPECT_THAT(run.out, AllOf(HasSubstr("FAIL"), HasSubstr("worst pixel"), HasSubstr("inputs")));
    const nlohmann::json result = report_of(folder / "c.json")["results"][0];
    EXPECT_FALSE(result["pass"].get<bool>());
    EXPECT_GT(result["outside"].get<int>(), 0);
}

// A kernel that computes something else must not get through.
TEST(Check, FindsAWrongKernel) {
    const TemporaryFolder folder;
    const std::filesystem::path kernels = std::filesystem::path(CLSHADE_SOURCE_DIR) / "kernels";
    std::filesystem::create_directory(folder / "kernels");
    for (const auto& entry : std::filesystem::directory_iterator(kernels)) {
        std::filesystem::copy(entry.path(), folder / "kernels");
    }
    const Outcome good = run_in(folder, {"check", crop("suzanne_crop.exr"), "--kernel-dir", "kernels"});
    EXPECT_EQ(good.exit_code, 0) << good.out << good.err;
    std::string text = bytes_of(folder / "kernels/blinn_phong.cl");
    // The linear normaliser's constants, wherever they stand, made 1 % larger.
    const std::size_t at = text.find("0.0397436");
    ASSERT_NE(at, std::string::npos) << "the normaliser's constant has moved; change this test with it";
    text.replace(at, 9, "0.0401410");
    write_bytes(folder / "kernels/blinn_phong.cl", text);
    const Outcome bad = run_in(folder, {"check", crop("suzanne_crop.exr"), "--kernel-dir", "kernels"});
    EXPECT_EQ(bad.exit_code, 3) << bad.out << bad.err;
}

TEST(Check, EveryLaneWidthPasses) {
    const TemporaryFolder folder;
    for (const char* lanes : {"1", "4", "8", "16"}) {
        const Outcome run = run_in(folder, {"check", crop("room_crop.exr"), "--lanes", lanes});
        EXPECT_EQ(run.exit_code, 0) << lanes << "\n" << run.out << run.err;
        EXPECT_THAT(run.out, HasSubstr(std::string(lanes) + " lanes"));
    }
}

TEST(Inspect, TellsRolesCameraAndIds) {
    const TemporaryFolder folder;
    const Outcome run = run_in(folder, {"inspect", crop("suzanne_crop.exr"), "--json", "i.json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out,
                AllOf(HasSubstr("data window"), HasSubstr("Normal.X"), HasSubstr("recovered from the position"),
                      HasSubstr("residual"), HasSubstr("material id")));
    const nlohmann::json result = report_of(folder / "i.json")["results"][0];
    EXPECT_EQ(result["roles"]["normal"]["channels"].size(), 3U);
    EXPECT_FALSE(result["roles"]["normal"]["rule"].get<std::string>().empty());
    EXPECT_LT(result["camera"]["residual_px"].get<double>(), 0.01);
    EXPECT_FALSE(result["material_ids"]["pixels"].empty());
}

TEST(Inspect, WorksWithoutANormal) {
    const TemporaryFolder folder;
    write_gbuffer_without_camera(folder / "in.exr", {{"Y", [](int x, int) { return static_cast<float>(x); }}});
    const Outcome run = run_in(folder, {"inspect", "in.exr"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, AllOf(HasSubstr("normal"), HasSubstr("camera: none")));
}

TEST(Inspect, CountsFilteredIds) {
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr",
                  surface_planes_and({"MaterialID.V", [](int x, int) { return x < 10 ? 0.5F : 7.0F; }}));
    const Outcome run = run_in(folder, {"inspect", "in.exr", "--json", "i.json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json ids = report_of(folder / "i.json")["results"][0]["material_ids"];
    EXPECT_EQ(ids["fractional"], 10 * test_height);
    EXPECT_EQ(ids["pixels"]["7"], (test_width - 10) * test_height);
}

TEST(Inspect, ReadsTheConformanceFiles) {
    const std::filesystem::path suite = std::filesystem::path(CLSHADE_SHARED_DATA) / "conformance";
    if (!std::filesystem::exists(suite)) {
        GTEST_SKIP() << "the conformance files are not part of the repository";
    }
    for (const char* folder : {"layers", "window", "values", "tiled"}) {
        for (const auto& entry : std::filesystem::directory_iterator(suite / folder)) {
            const Outcome run = run_clshade({"inspect", entry.path().string()});
            EXPECT_EQ(run.exit_code, 0) << entry.path() << run.err;
            EXPECT_THAT(run.out, HasSubstr("data window"));
        }
    }
}

TEST(Demo, MakesAndShadesItsOwnScene) {
    const TemporaryFolder folder;
    const Outcome run = run_in(folder, {"demo", "d", "--size", "96x54", "--frames", "2", "--json", "r.json"}, 300.0);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    for (const char* name : {"gbuffer.0001.exr", "gbuffer.0002.exr", "scene.toml", "studio.exr", "shaded.0001.exr",
                             "shaded.0002.exr", "shaded.0001.png", "shaded.0002.png"}) {
        EXPECT_TRUE(std::filesystem::exists(folder / "d" / name)) << name;
    }
    EXPECT_THAT(run.out, AllOf(HasSubstr("kernel"), HasSubstr("GB/s"), HasSubstr("d/shaded.0001.exr")));
    const Decoded picture = decode(folder / "d/shaded.0001.exr");
    std::size_t lit = 0;
    for (const float value : picture.plane("G")) {
        EXPECT_TRUE(std::isfinite(value));
        lit += value > 0.01F ? 1 : 0;
    }
    EXPECT_GT(lit, picture.plane("G").size() / 3);
    // The camera in the header is the one its Position plane tells.
    EXPECT_EQ(run_in(folder, {"inspect", "d/gbuffer.0002.exr", "-q", "--json", "i.json"}).exit_code, 0);
    const nlohmann::json camera = report_of(folder / "i.json")["results"][0]["camera"];
    EXPECT_THAT(camera["source"].get<std::string>(), HasSubstr("header"));
    EXPECT_TRUE(camera["has_rays"].get<bool>()) << "worldToNDC was not understood";
    EXPECT_LT(camera["residual_px"].get<double>(), 0.01);
    // And the reference agrees with what the demo shows.
    const Outcome check = run_in(folder, {"check", "d/gbuffer.0001.exr", "--scene", "d/scene.toml"});
    EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
}

class Bench : public ::testing::Test {
  protected:
    // Two rows at a small size: enough to see the report, not to measure anything.
    [[nodiscard]] std::vector<std::string> arguments(std::vector<std::string> more) const {
        more.insert(more.begin(), {"bench", "--quick", "--filter", "blinn_phong\\.lambert\\.distant1"});
        return more;
    }
    TemporaryFolder folder;
};

TEST_F(Bench, ReportsEveryKey) {
    const Outcome run = run_in(folder, arguments({"--json", "b.json"}), 300.0);
    ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
    const nlohmann::json report = report_of(folder / "b.json");
    EXPECT_EQ(report["command"], "bench");
    EXPECT_TRUE(report["device"].is_string() && report["driver"].is_string());
    ASSERT_FALSE(report["results"].empty());
    const nlohmann::json& row = report["results"][0];
    for (const char* key :
         {"kernel", "width", "height", "lights", "environments", "layers", "lanes", "median_ms", "min_ms", "spread",
          "bytes_per_pixel", "mpix_per_s", "gb_per_s", "build_cold_ms", "build_cached_ms", "against", "status"}) {
        EXPECT_TRUE(row.contains(key)) << key;
    }
    EXPECT_GT(row["median_ms"].get<double>(), 0.0);
    ASSERT_FALSE(row["against"].empty());
    for (const auto& [name, rival] : row["against"].items()) {
        EXPECT_TRUE(rival["status"] != "ok" || (rival["median_ms"].is_number() && rival["ratio"].is_number())) << name;
        EXPECT_TRUE(rival["status"] == "ok" || rival["reason"].is_string()) << name;
    }
    EXPECT_THAT(run.out, HasSubstr(row["kernel"].get<std::string>()));
}

TEST_F(Bench, ComparesWithABaseline) {
    ASSERT_EQ(run_in(folder, arguments({"--json", "b.json"}), 300.0).exit_code, 0);
    nlohmann::json baseline = report_of(folder / "b.json");
    // A machine cannot be a thousand times slower than a moment ago, nor a millionth of its own time.
    const Outcome same = run_in(folder, arguments({"--compare", "b.json", "--regress", "100000"}), 300.0);
    EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
    for (auto& row : baseline["results"]) {
        row["median_ms"] = row["median_ms"].get<double>() * 1e-6;
    }
    write_bytes(folder / "fast.json", baseline.dump());
    const Outcome slower = run_in(folder, arguments({"--compare", "fast.json", "--regress", "10"}), 300.0);
    EXPECT_EQ(slower.exit_code, 3) << slower.out << slower.err;
    EXPECT_THAT(slower.out, HasSubstr("SLOWER"));
}

TEST_F(Bench, RefusesWhatIsNoBaseline) {
    write_bytes(folder / "text.json", "hello");
    write_bytes(folder / "other.json", R"({"version": 1, "command": "check", "results": []})");
    for (const char* file : {"text.json", "other.json", "missing.json"}) {
        const Outcome run = run_in(folder, arguments({"--compare", file}));
        EXPECT_EQ(run.exit_code, 1) << file;
        ASSERT_EQ(run.error_lines().size(), 1U) << run.err;
        EXPECT_THAT(run.err, HasSubstr(file));
    }
    EXPECT_EQ(run_in(folder, arguments({"--compare", "x.json", "--regress", "-5"})).exit_code, 2);
}

TEST_F(Bench, ListsItsKeys) {
    const Outcome run = run_in(folder, {"bench", "--list"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.out, HasSubstr("shade.blinn_phong.lambert.distant1.3840x2160\n"));
    EXPECT_THAT(run.out, Not(HasSubstr("ms")));
}

TEST_F(Bench, TuningIsRememberedForLanesAuto) {
    const Outcome run = run_in(folder, {"bench", "--tune", "--quick", "--size", "128x64", "--json", "t.json"}, 300.0);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const int best = report_of(folder / "t.json")["best_lanes"];
    const Outcome check = run_in(folder, {"check", crop("room_crop.exr")});
    EXPECT_THAT(check.out, HasSubstr(std::to_string(best) + " lanes"));
    const Outcome forced = run_in(folder, {"check", crop("room_crop.exr"), "--lanes", best == 4 ? "8" : "4"});
    EXPECT_THAT(forced.out, HasSubstr(best == 4 ? "8 lanes" : "4 lanes"));
}

} // namespace
} // namespace clshade::tests
