// A picture cut into bands, as it is read when it does not fit in memory.
#pragma once

#include "host/gbuffer/frame_builder.h"
#include "host/gbuffer/visit_rows.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace clshade::testing {

/// Shows `whole` in bands of random heights, each in a frame of its own that holds `planes` of it, in that order, for
/// these roles. Other cuts at every visit; `visits` counts them.
inline VisitRows random_bands(const Frame& whole, const RolePlanes& roles, const std::vector<int>& planes,
                              unsigned seed, int& visits) {
    auto random = std::make_shared<std::mt19937>(seed);
    return [&whole, &visits, roles, planes, random](const std::function<void(const Frame&)>& visit) {
        ++visits;
        const int height = whole.planes.height();
        for (int row = 0; row < height;) {
            const int largest = std::uniform_int_distribution(1, height)(*random);
            const int rows = std::min(std::uniform_int_distribution(1, largest)(*random), height - row);
            Frame band;
            band.roles = roles;
            band.first_row = row;
            band.planes = PlaneSlab(whole.planes.width(), rows, static_cast<int>(planes.size()));
            for (std::size_t i = 0; i < planes.size(); ++i) {
                for (int y = 0; y < rows; ++y) {
                    const auto source = whole.planes.row(planes[i], row + y);
                    std::copy(source.begin(), source.end(), band.planes.row(static_cast<int>(i), y).begin());
                }
            }
            visit(band);
            row += rows;
        }
    };
}

/// The same for a plan: what a band reader shows. The planes are those of `plan.frame`.
inline VisitRows random_bands(const FramePlan& plan, unsigned seed, int& visits) {
    return random_bands(plan.frame, camera_frame(plan).roles, camera_planes(plan), seed, visits);
}

} // namespace clshade::testing
