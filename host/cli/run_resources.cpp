#include "host/cli/run_resources.h"

namespace clshade::cli {

const EnvironmentInput* RunResources::environment(StageTimes& stages) {
    const EnvironmentInput* input = environment_.read(stages);
    if (input != nullptr) {
        const std::string origin = environment_.prefilter(shader(), progress_, stages);
        origin_ = origin.empty() ? origin_ : origin;
    }
    return input;
}

void RunResources::about_to_shade(const Frame& frame) {
    if (dump_ != nullptr) {
        dump_->add(shader(), frame); // before the build, so that one that fails can be read
    }
}

} // namespace clshade::cli
