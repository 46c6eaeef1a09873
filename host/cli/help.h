// Help texts: the overview, and one page per verb made of the flags it declares.
#pragma once

#include "host/cli/verb.h"

#include <string>

namespace clshade::cli {

/// What `clshade` and `clshade --help` print.
[[nodiscard]] std::string overview();
/// What `clshade help VERB` and `clshade VERB --help` print.
[[nodiscard]] std::string help_page(const Verb& verb, const CLI::App& app);

} // namespace clshade::cli
