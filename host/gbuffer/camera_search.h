// Private to host/gbuffer: the camera that explains the most sights, whatever the outliers.
#pragma once

#include "host/gbuffer/camera_fit.h"

#include <optional>
#include <span>

namespace clshade {

struct FoundCamera {
    FittedCamera camera;
    Freedom freedom = Freedom::none;
    double median_error = 0.0; ///< over all sights, pixels
};

/// Linear solutions from all sights; if those do not explain nearly all of them, from random few (RANSAC, Fischler and
/// Bolles 1981, with a fixed seed), each refined, perspective and orthographic. The simplest camera that explains the
/// sights as well as any other is returned; empty if there is none at all.
[[nodiscard]] std::optional<FoundCamera> search_camera(std::span<const Sight> sights);

} // namespace clshade
