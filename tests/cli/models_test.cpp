// `models`: the catalogue, its pages, its report, its pictures.
#include "tests/cli/run_program.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clshade::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::vector<std::string> lobes{"blinn_phong", "blinn_phong_exact", "blinn_phong_anisotropic",
                                     "blinn_phong_spectral"};
const std::vector<std::string> diffuses{"lambert",
                                        "oren_nayar",
                                        "oren_nayar_full",
                                        "oren_nayar_qualitative",
                                        "oren_nayar_simplified_1",
                                        "oren_nayar_simplified_2",
                                        "oren_nayar_shininess"};
const std::vector<std::string> stack_keys{"fresnel", "absorption_model", "absorption", "ids", "names", "preset"};
const std::vector<std::string> environment_keys{"image",   "intensity", "up", "rotation_degrees",
                                                "diffuse", "background"};
const std::vector<std::string> presets{"skin", "car_paint", "lacquered_wood", "brushed_metal", "cloth", "gold"};

TEST(Models, ListsLobesDiffuseModelsKeysAndPresets) {
    const Outcome list = run_clshade({"models"});
    EXPECT_EQ(list.exit_code, 0);
    for (const auto& group : {lobes, diffuses, stack_keys, environment_keys, presets}) {
        for (const std::string& name : group) {
            EXPECT_THAT(list.out, HasSubstr("\n  " + name + " ")) << name;
        }
    }
}

TEST(Models, DocumentsEveryParameter) {
    for (const auto& group : {lobes, diffuses, {"layers"}}) {
        for (const std::string& name : group) {
            const Outcome page = run_clshade({"models", name});
            EXPECT_EQ(page.exit_code, 0) << name;
            for (const char* label : {"\n    unit ", "\n    range ", "\n    default ", "\n    source "}) {
                EXPECT_THAT(page.out, HasSubstr(label)) << name;
            }
            EXPECT_THAT(page.out, AllOf(HasSubstr("\nsource "), HasSubstr("models.md section"))) << name;
            EXPECT_THAT(page.out, HasSubstr("\nambient ")) << name << ": how an environment lights it";
        }
    }
    const std::string aniso = run_clshade({"models", "blinn_phong_anisotropic"}).out;
    EXPECT_THAT(aniso, AllOf(HasSubstr("\n  shininess_u\n"), HasSubstr("\n  tangent\n"), HasSubstr("0..65536")));
    const std::string stack = run_clshade({"models", "layers"}).out;
    for (const std::string& key : stack_keys) {
        EXPECT_THAT(stack, HasSubstr("\n  " + key + "\n"));
    }
    const std::string environment = run_clshade({"models", "environment"}).out;
    for (const std::string& key : environment_keys) {
        EXPECT_THAT(environment, HasSubstr("\n  " + key + "\n"));
    }
}

TEST(Models, SuggestsOverAllNames) {
    struct Case {
        const char* word;
        const char* suggestion;
    };
    for (const Case& c : {Case{"lambret", "lambert"}, Case{"car_piant", "car_paint"}, Case{"laiers", "layers"}}) {
        const Outcome run = run_clshade({"models", c.word});
        EXPECT_EQ(run.exit_code, 2);
        ASSERT_EQ(run.error_lines().size(), 1U) << run.err;
        EXPECT_THAT(run.err, HasSubstr("did you mean '" + std::string(c.suggestion) + "'?"));
        EXPECT_EQ(run.out, "");
    }
}

TEST(Models, KnowsWhereAParameterBelongs) {
    const Outcome run = run_clshade({"models", "absorption_model"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("`clshade models layers`"));
    EXPECT_THAT(run_clshade({"models", "rotation_degrees"}).err, HasSubstr("`clshade models environment`"));
}

TEST(Models, ReportsAsJson) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_clshade({"models", "-q", "--json", (folder / "m.json").string()}).exit_code, 0);
    const auto results = nlohmann::json::parse(bytes_of(folder / "m.json"))["results"];
    EXPECT_EQ(results.size(), lobes.size() + diffuses.size() + 2 + presets.size()); // and `layers`, `environment`
    std::size_t pictures = 0;
    for (const auto& result : results) {
        EXPECT_EQ(result["status"], "ok");
        EXPECT_FALSE(result["source"].get<std::string>().empty());
        if (result["kind"] == "preset") {
            ++pictures;
            EXPECT_EQ(result["picture"], "docs/presets/" + result["model"].get<std::string>() + ".png");
            continue;
        }
        ASSERT_FALSE(result["parameters"].empty());
        for (const auto& parameter : result["parameters"]) {
            for (const char* key : {"name", "unit", "range", "default", "source"}) {
                EXPECT_FALSE(parameter[key].get<std::string>().empty()) << result["model"] << key;
            }
        }
    }
    EXPECT_EQ(pictures, presets.size());
}

// What the page of a preset prints is a scene as it stands, and stands for the same material.
TEST(Presets, PrintTomlThatAUserCouldWrite) {
    const std::string crop = (std::filesystem::path(CLSHADE_TEST_DATA) / "room_crop.exr").string();
    for (const std::string& preset : presets) {
        const TemporaryFolder folder;
        const std::string page = run_clshade({"models", preset}).out;
        EXPECT_THAT(page, AllOf(HasSubstr("docs/presets/" + preset + ".png"), HasSubstr("preset = \"" + preset)));
        const std::string heading = "\n  [material." + preset + "]\n";
        const std::size_t at = page.find(heading);
        ASSERT_NE(at, std::string::npos) << page;
        const std::size_t rest = at + heading.size();
        constexpr std::string_view start =
            "version = 1\n[[light]]\ntype = \"distant\"\ndirection = [0, 0, -1]\nirradiance = 1.0\n";
        constexpr std::string_view claim = "ids = [1, 2, 3, 4, 5]\n";
        write_bytes(folder / "full.toml",
                    fmt::format("{}{}{}{}", start, page.substr(at, heading.size()), claim, page.substr(rest)));
        write_bytes(folder / "short.toml", fmt::format("{}[material.mine]\npreset = \"{}\"\n{}", start, preset, claim));
        std::vector<std::string> keys;
        for (const char* scene : {"full.toml", "short.toml"}) {
            const Outcome plan = run_clshade(
                {"shade", crop, "-o", (folder / "out.exr").string(), "-n", "--scene", (folder / scene).string()});
            ASSERT_EQ(plan.exit_code, 0) << plan.err;
            const std::size_t key = plan.out.rfind("  material "); // "  material NAME: KEY"
            const std::size_t colon = plan.out.find(": ", key);
            keys.push_back(plan.out.substr(colon, plan.out.find('\n', colon) - colon));
        }
        EXPECT_EQ(keys[0], keys[1]);
    }
}

TEST(Presets, HaveTheirPicturesInTheDocs) {
    for (const std::string& preset : presets) {
        const std::filesystem::path file =
            std::filesystem::path(CLSHADE_SOURCE_DIR) / "docs/presets" / (preset + ".png");
        ASSERT_TRUE(std::filesystem::exists(file)) << file;
        EXPECT_EQ(bytes_of(file).substr(1, 3), "PNG");
        EXPECT_LT(std::filesystem::file_size(file), 60000U) << file;
    }
}

TEST(Presets, ShadeTheirOwnThumbnails) {
    const TemporaryFolder folder;
    RunSettings settings;
    settings.timeout_seconds = 300.0;
    const Outcome run = run_clshade({"models", "--thumbnails", (folder / "a/b").string()}, settings);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    for (const std::string& preset : presets) {
        EXPECT_EQ(bytes_of(folder / ("a/b/" + preset + ".png")).substr(1, 3), "PNG");
        EXPECT_THAT(run.out, HasSubstr(preset + " -> "));
    }
    EXPECT_EQ(run_clshade({"models", "gold", "--thumbnails", "x"}).exit_code, 2);
    write_bytes(folder / "file", "");
    const Outcome bad = run_clshade({"models", "--thumbnails", (folder / "file").string()});
    EXPECT_EQ(bad.exit_code, 1);
    EXPECT_THAT(bad.err, HasSubstr("file"));
}

} // namespace
} // namespace clshade::tests
