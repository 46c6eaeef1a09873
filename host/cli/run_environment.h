// The environment of a run over many frames.
#pragma once

#include "host/cli/environment_input.h"
#include "host/cli/run_stats.h"

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace clshade::cli {

/// Reads and pre-filters when the first frame needs it, and no second time. Does nothing for a scene without
/// environment. Refers to the scene.
class RunEnvironment {
  public:
    RunEnvironment(const Scene& scene, std::uint64_t max_memory) : scene_(&scene), max_memory_(max_memory) {}

    /// Null without an environment. Throws as read_environment does.
    const EnvironmentInput* read(StageTimes& stages);
    /// After this frames can be attached. Where the maps come from, "built" or "from the cache"; empty if they were
    /// there. Throws as prefilter_environment does.
    std::string prefilter(Shader& shader, Progress& progress, StageTimes& stages);

    /// Reading or filtering has thrown: no other frame could do better.
    /// Any thread may ask.
    [[nodiscard]] bool has_failed() const { return failed_; }
    /// What was read; null before, and without an environment.
    [[nodiscard]] const EnvironmentInput* input() const { return input_ ? &*input_ : nullptr; }

  private:
    template <class Action>
    auto noting_failure(const Action& action);

    const Scene* scene_;
    std::uint64_t max_memory_;
    std::optional<EnvironmentInput> input_;
    std::atomic<bool> failed_{false};
};

} // namespace clshade::cli
