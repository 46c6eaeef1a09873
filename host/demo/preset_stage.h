// The stage on which the thumbnails of presets are taken: a turned body on a floor, in a studio of many small lights.
// No files, no OpenCL.
#pragma once

#include "host/demo/demo_gbuffer.h"
#include "host/scene/scene.h"

#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// Renders size x size pixels, one sample each: planes Normal.XYZ, Position.XYZ, Albedo.RGB (of the floor) and
/// MaterialID.V: 1 on the body, 0 on the floor. Z is up; the body is turned about it.
[[nodiscard]] DemoFrame render_preset_stage(int size, int threads);

/// Scene text (TOML) without lights: the body is the preset, the floor grey. Throws nothing for unknown presets: who
/// parses it does.
[[nodiscard]] std::string preset_stage_materials(std::string_view preset);

/// Distant lights all round that stand in for a studio: a large key softbox, a strip for the rim, a weak fill, a dim
/// room. Their spacing is below the width of the sharpest preset's highlight, so that no single one shows.
[[nodiscard]] std::vector<Light> preset_stage_lights();

} // namespace clshade
