// A scene bound to planes that lie in memory: no file is read.
#pragma once

#include "host/base/plane_slab.h"
#include "host/gbuffer/frame.h"
#include "host/scene/scene.h"

#include <span>
#include <string>

namespace clshade::cli {

/// The frame that a file with these planes would give: plane i of `planes` is the channel names[i], all in one part
/// whose windows are the whole picture. `name` stands for the file in messages. Throws like plan_frame.
[[nodiscard]] Frame frame_from_planes(const PlaneSlab& planes, std::span<const std::string> names, const Scene& scene,
                                      const std::string& name);

} // namespace clshade::cli
