#include "host/base/stage_times.h"

#include <algorithm>

namespace clshade {

void StageTimes::add(const std::string& stage, double milliseconds) {
    const auto found =
        std::find_if(stages_.begin(), stages_.end(), [&](const auto& entry) { return entry.first == stage; });
    if (found == stages_.end()) {
        stages_.emplace_back(stage, milliseconds);
    } else {
        found->second += milliseconds;
    }
}

void StageTimes::add(const StageTimes& other) {
    for (const auto& [stage, milliseconds] : other.stages_) {
        add(stage, milliseconds);
    }
}

double StageTimes::total() const {
    double sum = 0.0;
    for (const auto& entry : stages_) {
        sum += entry.second;
    }
    return sum;
}

double StageTimes::of(const std::string& stage) const {
    const auto found =
        std::find_if(stages_.begin(), stages_.end(), [&](const auto& entry) { return entry.first == stage; });
    return found == stages_.end() ? 0.0 : found->second;
}

} // namespace clshade
