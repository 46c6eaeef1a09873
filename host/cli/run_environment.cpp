#include "host/cli/run_environment.h"

#include "host/base/stopwatch.h"

namespace clshade::cli {

namespace {

constexpr const char* stage = "environment";
// Of a frame's step on the progress bar: between reading the header and reading the planes.
constexpr double filter_begins = 0.05;
constexpr double filter_ends = 0.25;

} // namespace

// Frames that fail for reasons of their own are told of while others wait for the environment: has_failed() must not be
// true before it is.
template <class Action>
auto RunEnvironment::noting_failure(const Action& action) {
    try {
        return action();
    } catch (...) {
        failed_ = true;
        throw;
    }
}

const EnvironmentInput* RunEnvironment::read(StageTimes& stages) {
    if (scene_->environment && !input_) {
        const Stopwatch watch;
        input_ = noting_failure([&] { return read_environment(*scene_, max_memory_); });
        stages.add(stage, watch.milliseconds());
    }
    return input();
}

std::string RunEnvironment::prefilter(Shader& shader, Progress& progress, StageTimes& stages) {
    if (!input_ || input_->maps != nullptr) {
        return {};
    }
    const Stopwatch watch;
    const PrefilterReport report =
        noting_failure([&] { return prefilter_environment(*input_, shader, progress, filter_begins, filter_ends); });
    stages.add(stage, watch.milliseconds());
    return report.from_cache ? "from the cache" : "built";
}

} // namespace clshade::cli
