// The table of verbs: it feeds both the dispatch and `help`.
#pragma once

#include "host/base/error.h"

#include <functional>
#include <span>
#include <string_view>

namespace CLI { // NOLINT(readability-identifier-naming): the name is CLI11's
class App;
}

namespace clshade::cli {

/// What a verb does once its flags are parsed.
using Action = std::function<ExitCode()>;

struct Verb {
    std::string_view name;
    std::string_view synopsis; ///< after the name, in `help`
    std::string_view summary;  ///< one line
    std::string_view details;  ///< paragraphs and examples below the flags; empty lines part paragraphs
    /// Declares the flags and returns what is to be done; the flags' values live in the returned action.
    Action (*declare)(CLI::App& app);
};

[[nodiscard]] std::span<const Verb> verbs();
/// Throws UsageError with a suggestion for a name that is no verb.
[[nodiscard]] const Verb& find_verb(std::string_view name);

Action declare_shade(CLI::App& app);
Action declare_check(CLI::App& app);
Action declare_bench(CLI::App& app);
Action declare_inspect(CLI::App& app);
Action declare_prefilter(CLI::App& app);
Action declare_demo(CLI::App& app);
Action declare_devices(CLI::App& app);
Action declare_models(CLI::App& app);

} // namespace clshade::cli
