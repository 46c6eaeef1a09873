#include "host/cli/options.h"
#include "host/cli/verb.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace clshade::cli {

namespace {

struct PrefilterOptions {
    CommonOptions common;
    std::string input;
    std::string output;
};

} // namespace

// The name is public already; image-based light is of a later release, and a known name must not look like a typing
// error.
Action declare_prefilter(CLI::App& app) {
    auto options = std::make_shared<PrefilterOptions>();
    app.add_option("ENV", options->input, "environment image, lat-long .hdr or .exr");
    app.add_option("-o,--output", options->output, "where the set of maps goes")->type_name("SET");
    add_common_options(app, options->common, CommonGroup::running);
    return [options]() -> ExitCode {
        throw UsageError("prefilter: not built yet; image-based light comes with a later version of clshade");
    };
}

} // namespace clshade::cli
