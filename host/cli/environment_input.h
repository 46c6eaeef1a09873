// A scene's environment, from its file to what frames share: read once, pre-filtered once.
#pragma once

#include "host/cli/progress.h"
#include "host/environment/environment_input.h"
#include "host/gbuffer/frame.h"
#include "host/scene/scene.h"
#include "host/shading/shader.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace clshade::cli {

/// Reads what the scene names: a picture, a set of maps, or nothing for the built-in studio. A picture that takes more
/// than `max_memory` bytes (0: no limit) is halved, and refused where the scene shows it as background. The scene must
/// have an environment. Throws RuntimeFailure. In builds without image files: throws UsageError unless it is the
/// studio.
[[nodiscard]] EnvironmentInput read_environment(const Scene& scene, std::uint64_t max_memory);

/// Fills `maps` from the picture where there are none: filters on the shader's device or takes what an earlier run has
/// kept. Tells `progress` of it from `from` to `to` of the current step.
[[nodiscard]] PrefilterReport prefilter_environment(EnvironmentInput& input, Shader& shader, Progress& progress,
                                                    double from, double to);

/// Files whose time and content decide what the environment is: the picture, or those of a set. Empty for the studio.
[[nodiscard]] std::vector<std::filesystem::path> environment_files(const Scene& scene);

/// Throws UsageError with what to do about it if the AOV of the environment is asked for and the scene has none.
void require_environment(const Scene& scene, const AovSelection& aovs);

} // namespace clshade::cli
