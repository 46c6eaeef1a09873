// The result of pre-filtering one environment (filter_layout.h), as values: what the disk cache keeps, what `prefilter`
// writes and what kernels read.
#pragma once

#include "host/environment/filter_layout.h"
#include "host/scene/scene.h"

#include <glm/glm.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace clshade {

/// Unrotated and unscaled, in the image frame; RGB interleaved, vertices in the order of filter_layout.h.
struct FilteredSet {
    std::string name; ///< of the environment
    std::string hash; ///< content_hash of its picture; of a set read back: what its files say
    std::array<std::vector<float>, radiance_levels> radiance;
    std::vector<float> irradiance;  ///< E/pi
    std::array<glm::dvec3, 9> sh{}; ///< radiance
    glm::dvec3 mean{0.0};           ///< of the picture's radiance over the sphere
    std::optional<UpAxis> up;       ///< the picture's: LatLong::up
};

/// scale and bias interleaved, in the order of filter_layout.h. Independent of the environment.
struct AmbientTables {
    std::vector<float> exact;
    std::vector<float> linear;
};

/// Throws std::invalid_argument unless every array has the size that filter_layout.h says.
void check_sizes(const FilteredSet& set);

} // namespace clshade
