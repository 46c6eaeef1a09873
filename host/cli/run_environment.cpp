#include "host/cli/run_environment.h"

#include "host/base/stopwatch.h"

namespace clshade::cli {

namespace {

constexpr const char* stage = "environment";
// Of a frame's step on the progress bar: between reading the header and reading the planes.
constexpr double filter_begins = 0.05;
constexpr double filter_ends = 0.25;

} // namespace

const EnvironmentInput* RunEnvironment::read(StageTimes& stages) {
    if (scene_->environment && !input_) {
        Stopwatch watch;
        failed_ = true; // unless it goes well
        input_ = read_environment(*scene_, max_memory_);
        failed_ = false;
        stages.add(stage, watch.lap());
    }
    return input();
}

std::string RunEnvironment::prefilter(Shader& shader, Progress& progress, StageTimes& stages) {
    if (!input_ || input_->maps != nullptr) {
        return {};
    }
    Stopwatch watch;
    failed_ = true;
    const PrefilterReport report = prefilter_environment(*input_, shader, progress, filter_begins, filter_ends);
    failed_ = false;
    stages.add(stage, watch.lap());
    return report.from_cache ? "from the cache" : "built";
}

} // namespace clshade::cli
