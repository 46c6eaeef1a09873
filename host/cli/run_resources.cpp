#include "host/cli/run_resources.h"

#include <spdlog/spdlog.h>

namespace clshade::cli {

const EnvironmentInput* RunResources::environment(StageTimes& stages) {
    const EnvironmentInput* input = environment_.read(stages);
    if (input != nullptr) {
        const std::string origin = environment_.prefilter(shader(), progress_, stages);
        if (!origin.empty()) {
            spdlog::info("environment {}: pre-filtered maps {}", input->name, origin);
        }
    }
    return input;
}

void RunResources::about_to_shade(const Frame& frame) {
    if (dump_ != nullptr) {
        dump_->add(shader(), frame); // before the build, so that one that fails can be read
    }
}

} // namespace clshade::cli
