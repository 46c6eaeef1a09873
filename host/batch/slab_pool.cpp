#include "host/batch/slab_pool.h"

#include <algorithm>
#include <utility>

namespace clshade {

PlaneSlab SlabPool::take(int width, int height, int count) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(slabs_.begin(), slabs_.end(), [&](const PlaneSlab& slab) {
        return slab.width() == width && slab.height() == height && slab.count() == count;
    });
    if (found == slabs_.end()) {
        return {};
    }
    PlaneSlab slab = std::move(*found);
    slabs_.erase(found);
    return slab;
}

void SlabPool::give(PlaneSlab slab) {
    if (slab.count() == 0) {
        return;
    }
    const std::lock_guard lock(mutex_);
    std::erase_if(slabs_, [&](const PlaneSlab& other) {
        return other.width() != slab.width() || other.height() != slab.height();
    });
    slabs_.push_back(std::move(slab));
}

void SlabPool::clear() {
    const std::lock_guard lock(mutex_);
    slabs_.clear();
}

} // namespace clshade
