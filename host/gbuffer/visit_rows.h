// A picture shown in bands of rows.
#pragma once

#include "host/gbuffer/frame.h"

#include <functional>

namespace clshade {

/// Shows its argument the picture from the top down, each row once, in frames that hold some rows each
/// (Frame::first_row) of the planes. May be called several times and shows the same each time. What looks at rows takes
/// the planes from the roles of the frame it is shown.
using VisitRows = std::function<void(const std::function<void(const Frame&)>& visit)>;

/// Shows the frame as a whole; it must outlive the function.
[[nodiscard]] inline VisitRows whole_picture(const Frame& frame) {
    return [&frame](const std::function<void(const Frame&)>& visit) { visit(frame); };
}

} // namespace clshade
