// Helpers for scene tests: parse text and look at the one-line error.
#pragma once

#include "host/base/error.h"
#include "host/scene/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace clshade {

inline Scene parse(std::string_view text, const std::vector<std::string>& overrides = {}, std::string_view model = {}) {
    return parse_scene(text, "scene.toml", overrides, model);
}

/// The message of the UsageError that parsing throws, or "" if it throws none.
inline std::string error_of(std::string_view text, const std::vector<std::string>& overrides = {},
                            std::string_view model = {}) {
    try {
        (void)parse(text, overrides, model);
    } catch (const UsageError& error) {
        return error.what();
    }
    return {};
}

/// Three lines; what a test appends starts in line 4.
inline const std::string head = "version = 1\n"
                                "light = [{ name = 'key', type = 'distant', direction = [0, 0, -1], irradiance = 3 }]\n"
                                "\n";

/// Text appended to `head` (its first line is line 4), the place of the mistake, and words of the message.
struct Mistake {
    std::string name;
    std::string text;
    std::string place; ///< "LINE:COL"
    std::string words;
};

inline std::string name_of_mistake(const testing::TestParamInfo<Mistake>& mistake) {
    return mistake.param.name;
}

/// The message names file, line and column, is one line and says what to do.
inline void expect_mistake(const std::string& message, const Mistake& mistake) {
    EXPECT_THAT(message, testing::StartsWith("scene.toml:" + mistake.place + ": "));
    EXPECT_THAT(message, testing::HasSubstr(mistake.words));
    EXPECT_THAT(message, testing::Not(testing::HasSubstr("\n"))) << "one line";
    EXPECT_THAT(message, testing::HasSubstr("; ")) << "what to do";
}

} // namespace clshade
