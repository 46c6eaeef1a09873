// How much the log says: -q errors only, default warnings, -v and -vv more.
#pragma once

#include "host/cli/options.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace clshade::cli {

inline void set_log_level(const CommonOptions& options) {
    constexpr int most = 2;
    const int level = options.quiet ? static_cast<int>(spdlog::level::err)
                                    : static_cast<int>(spdlog::level::warn) - std::min(options.verbosity, most);
    spdlog::set_level(static_cast<spdlog::level::level_enum>(level));
}

} // namespace clshade::cli
