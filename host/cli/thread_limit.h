// --threads for everything that runs on oneTBB.
#pragma once

#include "host/cli/options.h"

#include <tbb/global_control.h>

#include <cstddef>

namespace clshade::cli {

/// While it lives, no more than --threads threads work. `shade` needs none: run_batch sets its own.
[[nodiscard]] inline tbb::global_control thread_limit(const CommonOptions& options) {
    return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.host_threads())};
}

} // namespace clshade::cli
