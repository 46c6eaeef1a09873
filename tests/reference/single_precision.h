// The models in plain single precision, written down directly: what rounding alone does, with no kernel at hand.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/reference/reference.h"

namespace clshade::reference {

/// How N.H^n is computed.
enum class LobeForm {
    accurate, ///< log1p(-|N x H|^2) near the highlight, log(N.H) elsewhere
    power,    ///< exp(n log N.H) everywhere: loses n roundings near the highlight
    log1p,    ///< log1p(-|N x H|^2) everywhere: cancels near N.H = 0
};

/// Radiance of a random_frame in single precision. Frames of random_frame only:
/// one material, perspective, positions, coverage; Lambert or improved Oren-Nayar under either Blinn-Phong.
[[nodiscard]] PlaneSlab shade_in_single_precision(const Frame& frame, LobeForm form);

} // namespace clshade::reference
