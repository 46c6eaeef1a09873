// --filter, as a regular expression.
#pragma once

#include <regex>
#include <string>

namespace clshade {

/// Throws UsageError for what is none.
[[nodiscard]] std::regex compiled_filter(const std::string& filter);

} // namespace clshade
