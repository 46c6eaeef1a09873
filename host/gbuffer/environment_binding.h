// A scene's environment joined to a frame.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/scene/scene.h"

#include <memory>

namespace clshade {

/// Sets frame.environment from the scene's (nothing without one). `image` and `maps` as in BoundEnvironment; the
/// picture's `up` (the set's without one) holds where the scene names none. Call after finish_frame, since the default
/// scene's studio turns with the camera. Throws UsageError where a background is asked for and the view has no rays or
/// there is only a set.
void attach_environment(Frame& frame, const Scene& scene, std::shared_ptr<const LatLong> image,
                        std::shared_ptr<const FilteredSet> maps);

} // namespace clshade
