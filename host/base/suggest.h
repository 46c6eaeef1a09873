// "did you mean": the nearest known word to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace clshade {

/// Returns "; did you mean 'x'?" for the candidate nearest to `word` by edit distance (at most a third of the word's
/// length, at least one), or an empty string when none is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

} // namespace clshade
