// Plane memory that goes from frame to frame.
#pragma once

#include "host/base/plane_slab.h"

#include <mutex>
#include <vector>

namespace clshade {

/// Slabs that are not in use. Fresh memory has to be cleared by the system and by us, which takes as long as shading;
/// frames of a sequence are alike, so a finished frame's memory serves the next. Safe for several threads.
class SlabPool {
  public:
    /// A slab of this shape whose content does not matter; empty if there is none.
    [[nodiscard]] PlaneSlab take(int width, int height, int count);
    /// Gives a slab back. Slabs of other shapes are freed: frames have changed.
    void give(PlaneSlab slab);
    /// Frees everything.
    void clear();

  private:
    std::mutex mutex_;
    std::vector<PlaneSlab> slabs_;
};

} // namespace clshade
