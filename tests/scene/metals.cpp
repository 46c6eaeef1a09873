// Metals: built-in data and table files.
#include "host/scene/metal_table.h"
#include "tests/scene/support.h"

#include <filesystem>
#include <fstream>

namespace clshade {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::string_view good_table = "wavelength_nm,n,k\n400,1.5,2.0\n700,0.2,4.0\n";

std::string error_of_table(std::string_view text) {
    try {
        (void)parse_metal_table(text, "x", "x.csv");
    } catch (const UsageError& error) {
        return error.what();
    }
    return {};
}

TEST(Metals, BuiltInDataIsThatOfTheSpecification) {
    for (const std::string_view name : built_in_metal_names()) {
        const std::optional<Metal> metal = built_in_metal(name);
        ASSERT_TRUE(metal.has_value()) << name;
        EXPECT_EQ(metal->name, name);
        ASSERT_EQ(metal->samples.size(), 19U);
        for (std::size_t i = 0; i < 19; ++i) {
            const ComplexIndex& sample = metal->samples[i];
            EXPECT_TRUE(sample.n > 0.0 && sample.n < 2.0 && sample.k > 1.0 && sample.k < 6.0) << name << i;
            EXPECT_TRUE(i == 0 || metal->samples[i - 1].wavelength < sample.wavelength) << name << i;
        }
    }
    // models.md section 4, one row of each from the middle.
    const ComplexIndex gold = built_in_metal("gold")->samples.at(12);
    EXPECT_EQ(gold.wavelength, 604.80);
    EXPECT_EQ(gold.n, 0.2124);
    EXPECT_EQ(gold.k, 3.0150);
    const ComplexIndex copper = built_in_metal("copper")->samples.at(3);
    EXPECT_EQ(copper.wavelength, 450.85);
    EXPECT_EQ(copper.n, 1.1653);
    EXPECT_EQ(copper.k, 2.3976);
    EXPECT_FALSE(built_in_metal("silver").has_value());
}

TEST(Metals, TablesMayBeWrittenInManyWays) {
    for (const std::string_view text :
         {good_table, std::string_view("400,1.5,2.0\r\n700,0.2,4.0\r\n"), std::string_view("400;1.5;2\n700;0.2;4"),
          std::string_view("# source\n\n400 1.5 2e0 # note\n  700\t+0.2   4\n\n"),
          std::string_view("\xef\xbb\xbf"
                           "wl n k\n400 , 1.5 , 2\n700,0.2,4\n"),
          std::string_view("nanometres,index,extinction\n400,1.5,2\n700,.2,4\n")}) {
        const Metal metal = parse_metal_table(text, "alloy.csv", "alloy.csv");
        EXPECT_EQ(metal.name, "alloy.csv");
        ASSERT_EQ(metal.samples.size(), 2U) << text;
        EXPECT_EQ(metal.samples[0].wavelength, 400.0) << text;
        EXPECT_EQ(metal.samples[0].n, 1.5) << text;
        EXPECT_EQ(metal.samples[0].k, 2.0) << text;
        EXPECT_EQ(metal.samples[1].wavelength, 700.0) << text;
        EXPECT_EQ(metal.samples[1].n, 0.2) << text;
        EXPECT_EQ(metal.samples[1].k, 4.0) << text;
    }
}

TEST(Metals, EndsOfRangesAreAllowed) {
    EXPECT_EQ(error_of_table("100,1e-9,0\n380,1,0\n"), "");
    EXPECT_EQ(error_of_table("780,10000,10000\n20000,1,0\n"), "");
    EXPECT_EQ(error_of_table("400,1,1\n400.0001,1,1\n"), "");
}

struct BadTable {
    std::string name;
    std::string text;
    std::string place; ///< "LINE:COL"
    std::string words;
};

class BadTables : public testing::TestWithParam<BadTable> {};

TEST_P(BadTables, AreRefusedWithTheLine) {
    const std::string message = error_of_table(GetParam().text);
    EXPECT_THAT(message, StartsWith("x.csv:" + GetParam().place + ": "));
    EXPECT_THAT(message, HasSubstr(GetParam().words));
    EXPECT_THAT(message, HasSubstr("; ")) << "what to do";
}

INSTANTIATE_TEST_SUITE_P(
    Metals, BadTables,
    testing::Values(
        BadTable{"nothing", "", "1:1", "the table has 0 rows"},
        BadTable{"heading_only", "wavelength_nm,n,k\n", "1:1", "the table has 0 rows"},
        BadTable{"one_row", "# gold\n500,1,1\n", "2:1", "the table has 1 row; write two or more"},
        BadTable{"falling", "wl,n,k\n600,1,1\n500,1,1\n", "3:1", "the wavelength 500 follows 600; sort the rows"},
        BadTable{"repeated", "600,1,1\n\n  600,1,1\n", "3:3", "the wavelength 600 follows 600"},
        BadTable{"nan", "500,nan,1\n600,1,1\n", "1:5", "n is nan; write a finite number"},
        BadTable{"nan_wavelength", "nan,1,1\n600,1,1\n", "1:1", "the wavelength is nan"},
        BadTable{"inf", "500,1,1\n600,1,inf\n", "2:7", "k is inf"},
        BadTable{"overflow", "500,1,1\n600,1e999,1\n", "2:5", "n is 1e999; write a finite number"},
        BadTable{"zero_n", "500,0,1\n600,1,1\n", "1:5", "n is 0; it must be more than 0"},
        BadTable{"negative_n", "500,1,1\n600,-1,1\n", "2:5", "n is -1"},
        BadTable{"huge_n", "500,1,1\n600,10001,1\n", "2:5", "at most 10000"},
        BadTable{"negative_k", "500,1,-0.1\n600,1,1\n", "1:7", "k is -0.1; it must be between 0 and 10000"},
        BadTable{"micrometres", "0.5,1,1\n0.6,1,1\n", "1:1", "not within 100 and 20000; write nanometres"},
        BadTable{"far_infrared", "500,1,1\n20001,1,1\n", "2:1", "write nanometres"},
        BadTable{"invisible", "1000,1,1\n2000,1,1\n", "2:1", "covers 1000 to 2000 nm and nothing that can be seen"},
        BadTable{"ultraviolet", "200,1,1\n379,1,1\n", "2:1", "add rows between 380 and 780 nm"},
        BadTable{"two_values", "500,1\n600,1,1\n", "1:1", "the line has 2 values; write wavelength_nm,n,k"},
        BadTable{"four_values", "500,1,1,1\n", "1:1", "the line has 4 values"},
        BadTable{"decimal_commas", "500;1,5;2,5\n", "1:1", "the line has 5 values"},
        BadTable{"gap", "500,,1\n600,1,1\n", "1:5", "n is '', which is not a number"},
        BadTable{"comma_at_the_end", "500,1,1,\n", "1:1", "the line has 4 values"},
        BadTable{"letters", "5OO,1,1\n600,1,1\n", "1:1", "the wavelength is '5OO', which is not a number"},
        BadTable{"unit", "500,1,1\n600nm,1,1\n", "2:1", "'600nm', which is not a number"},
        BadTable{"two_headings", "wl,n,k\nnm,1,1\n", "2:1", "the wavelength is 'nm'"},
        BadTable{"heading_below", "500,1,1\nwl,n,k\n", "2:1", "the wavelength is 'wl'"},
        BadTable{"binary", std::string("PK\x03\x04\x00\x01\n\x02", 8), "2:1", "the line has 1 value"}),
    [](const testing::TestParamInfo<BadTable>& table) { return table.param.name; });

/// A folder of its own with a scene and whatever files a test adds.
class MetalFiles : public testing::Test {
  protected:
    void SetUp() override { std::filesystem::create_directories(folder_ / "metals"); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void add(const std::string& name, std::string_view text) { std::ofstream(folder_ / name) << text; }

    [[nodiscard]] Scene scene_with(const std::string& metal, const std::vector<std::string>& overrides = {}) {
        add("scene.toml",
            head + "[material.default]\nspecular = { model = 'blinn_phong_spectral', metal = '" + metal + "' }\n");
        return read_scene(folder_ / "scene.toml", overrides, {});
    }

    [[nodiscard]] std::string error_with(const std::string& metal) {
        try {
            (void)scene_with(metal);
        } catch (const UsageError& error) {
            return error.what();
        }
        return {};
    }

    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "clshade_test_metals";
};

TEST_F(MetalFiles, AreFoundFromTheFolderOfTheScene) {
    add("metals/alloy.csv", good_table);
    add("gold", "400,1,1\n500,1,1\n");
    const Metal alloy = scene_with("metals/alloy.csv").materials[0].base().metal;
    EXPECT_EQ(alloy.name, "metals/alloy.csv");
    ASSERT_EQ(alloy.samples.size(), 2U);
    EXPECT_EQ(alloy.samples[1].k, 4.0);
    EXPECT_EQ(scene_with((folder_ / "metals/alloy.csv").string()).materials[0].base().metal.samples.size(), 2U);
    EXPECT_EQ(scene_with("gold").materials[0].base().metal.samples.size(), 19U); // built in comes first
    EXPECT_EQ(scene_with("./gold").materials[0].base().metal.samples.size(), 2U);
    EXPECT_EQ(scene_with("gold", {"material.default.specular.metal=metals/alloy.csv"})
                  .materials[0]
                  .base()
                  .metal.samples.size(),
              2U);
}

TEST_F(MetalFiles, ThatCannotBeReadAreNamedAtTheirPlaceInTheScene) {
    const std::string place = (folder_ / "scene.toml").string() + ":5:54: ";
    EXPECT_THAT(error_with("silver"), StartsWith(place + "metal 'silver' is neither built in nor a file ("));
    EXPECT_THAT(error_with("silver"), HasSubstr("; write one of 'gold', 'copper', or the path of a table"));
    EXPECT_THAT(error_with("cooper"), HasSubstr("did you mean 'copper'?"));
    EXPECT_THAT(error_with("metals"), StartsWith(place + "the metal table '"));
    EXPECT_THAT(error_with("metals"), HasSubstr("is a folder; name a text file"));
    EXPECT_THAT(error_with("/dev/zero"), HasSubstr("is larger than 1 MiB"));
}

TEST_F(MetalFiles, MistakesAreNamedAtTheirLineOfTheTable) {
    add("bad.csv", "# alloy\n400,1,1\n390,1,1\n");
    EXPECT_THAT(error_with("bad.csv"), StartsWith((folder_ / "bad.csv").string() + ":3:1: the wavelength 390"));
}

} // namespace
} // namespace clshade
