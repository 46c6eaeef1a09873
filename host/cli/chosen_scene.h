// Which scene a run takes.
#pragma once

#include "host/batch/run_scene.h"
#include "host/cli/options.h"

namespace clshade::cli {

/// Reads --scene, or takes the default scene; --set and --model applied. Throws like read_scene.
[[nodiscard]] RunScene choose_scene(const SceneOptions& options);

} // namespace clshade::cli
