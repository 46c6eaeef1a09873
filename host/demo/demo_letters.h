// The word on the stage.
#pragma once

#include "host/demo/demo_shapes.h"

#include <vector>

namespace clshade::demo {

/// Radius of the pen that draws the strokes, in units of the x-height.
inline constexpr float pen = 0.125F;

struct Letter {
    std::vector<Stroke> strokes; ///< centre lines, from x = 0, on the base line y = 0
    float width = 1.0F;
};

/// The letters of "clshade" in order.
[[nodiscard]] std::vector<Letter> word();

} // namespace clshade::demo
