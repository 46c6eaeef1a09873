// Private to host/gbuffer: the pixels whose positions tell the camera.
#pragma once

#include "host/gbuffer/visit_rows.h"

#include <glm/glm.hpp>

#include <vector>

namespace clshade {

/// A covered pixel and what its planes say.
struct CameraSample {
    glm::dvec2 pixel{0.0}; ///< centre, from the data window's corner
    glm::dvec3 position{0.0};
    double depth = 0.0; ///< 0 without a depth plane
};

/// Some 4000 samples, spread evenly over the picture, of whole pixels if there are enough of them; from a coarse
/// lattice if that gives enough. `data_window`: of the whole picture. The same for any division into bands. Shows
/// itself the rows one to three times, once as a rule; keeps some 30 MiB at worst, 7 as a rule.
[[nodiscard]] std::vector<CameraSample> collect_samples(const Window& data_window, const VisitRows& rows);

} // namespace clshade
