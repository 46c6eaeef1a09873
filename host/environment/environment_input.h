// An environment as a run carries it: the picture, and the maps once they are made.
#pragma once

#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>
#include <vector>

namespace clshade {

/// A picture, or maps that were pre-filtered before (then `image` is null).
struct EnvironmentInput {
    std::string name; ///< as the scene writes it; "built-in studio"
    std::string hash; ///< of the picture's texels
    std::shared_ptr<const LatLong> image;
    std::shared_ptr<const FilteredSet> maps; ///< null until the picture has been filtered
    std::vector<std::string> warnings;       ///< of what was done to the picture while it was read

    /// "1024x512 pixels, mean radiance (0.5, 0.5, 0.5)".
    [[nodiscard]] std::string description() const;
    /// Of the picture over the sphere, without the scene's intensity.
    [[nodiscard]] glm::dvec3 mean() const;
};

} // namespace clshade
