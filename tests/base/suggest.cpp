#include "host/base/suggest.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace clshade {
namespace {

constexpr std::array<std::string_view, 4> words{"albedo", "shininess", "specular", "f0"};

TEST(Suggest, FindsTheNearestWord) {
    EXPECT_EQ(did_you_mean("specualr", words), "; did you mean 'specular'?");
    EXPECT_EQ(did_you_mean("shinyness", words), "; did you mean 'shininess'?");
    EXPECT_EQ(did_you_mean("albdo", words), "; did you mean 'albedo'?");
}

TEST(Suggest, SaysNothingWhenNothingIsNear) {
    EXPECT_EQ(did_you_mean("environment", words), "");
    EXPECT_EQ(did_you_mean("", std::span<const std::string_view>()), "");
}

TEST(Suggest, AllowsOneEditInShortWords) {
    EXPECT_EQ(did_you_mean("fo", words), "; did you mean 'f0'?");
    EXPECT_EQ(did_you_mean("xy", words), "");
}

TEST(Suggest, AllowsAThirdOfTheLength) {
    // Nine letters: three edits are near, four are not.
    EXPECT_EQ(did_you_mean("shinXYZss", words), "; did you mean 'shininess'?");
    EXPECT_EQ(did_you_mean("shWXYZess", words), "");
}

TEST(Suggest, TakesStrings) {
    const std::vector<std::string> names{"key", "rim"};
    EXPECT_EQ(did_you_mean("kay", std::span<const std::string>(names)), "; did you mean 'key'?");
}

TEST(Suggest, TwoSwappedLettersAreOneMistake) {
    const std::array<std::string_view, 2> keys{"light", "layer"};
    EXPECT_EQ(did_you_mean("lihgt", keys), "; did you mean 'light'?");
    EXPECT_EQ(did_you_mean("lihtg", keys), ""); // two mistakes in five letters
}

} // namespace
} // namespace clshade
