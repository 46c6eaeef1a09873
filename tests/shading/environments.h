// Shared by the tests of environments: one small studio, filtered once by the device.
#pragma once

#include "host/environment/lat_long.h"
#include "host/gbuffer/random_gbuffer.h"
#include "host/prefilter/prefilter.h"
#include "tests/shading/agreement.h"

#include <memory>

namespace clshade {

struct FilteredStudio {
    std::shared_ptr<const LatLong> image;
    std::shared_ptr<const FilteredSet> maps;
};

inline const FilteredStudio& filtered_studio() {
    static const FilteredStudio studio = [] {
        FilteredStudio made;
        made.image = std::make_shared<const LatLong>(built_in_studio(128));
        Prefilter prefilter(test_device(), kernel_sources(), ProgramCache::disabled(),
                            automatic_lanes(test_device().info()));
        made.maps = std::make_shared<const FilteredSet>(prefilter.filter(*made.image, {}));
        return made;
    }();
    return studio;
}

/// Puts the frame into the studio, turned at random.
inline void surround(Frame& frame, AmbientSource diffuse, std::uint64_t seed) {
    add_random_environment(frame, filtered_studio().image, diffuse, seed);
    frame.environment->maps = filtered_studio().maps;
}

} // namespace clshade
