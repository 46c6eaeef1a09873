// `check --ground-truth`: how far the approximation of an environment's light is from brute force.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/reference/ground_truth.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace clshade::cli {

struct TruthOptions {
    int samples = 0; ///< pixels of each frame
    std::uint64_t seed = 1;
    int threads = 1;
};

/// A material of one shininess on the body of the presets' stage, in the built-in studio.
struct TruthCase {
    std::string name; ///< what the material's rows are called
    Frame frame;
};

/// What is integrated without INPUT: lobes, diffuse models and ways to take the environment, each with shininess from
/// 5 to 5000 where it has one.
[[nodiscard]] std::vector<TruthCase> truth_cases(int threads);

/// Integrates pixels of `frame` and appends what was found. `name`: what they are called, empty: by their model_key.
/// Throws UsageError if the frame has no environment, or only a pre-filtered one.
void append_samples(std::vector<reference::GroundTruthSample>& all, const Frame& frame, const TruthOptions& options,
                    const std::string& name);

/// One row per model and decade of shininess.
[[nodiscard]] std::string truth_text(const std::vector<reference::GroundTruthSummary>& rows);
[[nodiscard]] nlohmann::json truth_json(const std::vector<reference::GroundTruthSummary>& rows);

} // namespace clshade::cli
