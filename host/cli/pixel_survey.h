// What `inspect` reads of the pixels: the camera that the positions tell, and the material ids there are.
#pragma once

#include "host/gbuffer/camera.h"
#include "host/gbuffer/image_layout.h"
#include "host/gbuffer/roles.h"
#include "host/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace clshade::cli {

struct CameraSurvey {
    std::string source;  ///< "[camera] of x.toml", "worldToCamera in the header", ...; "none"
    std::string trouble; ///< why there is none, or why it was not checked
    std::optional<View> view;
    double residual_px = -1.0;           ///< median reprojection error; negative: no positions to hold it against
    std::optional<RecoveredView> fitted; ///< if the camera was recovered from the positions
};

struct IdSurvey {
    std::map<std::int64_t, std::uint64_t> pixels; ///< pixels per whole id
    std::uint64_t fractional = 0;                 ///< further than 0.01 from a whole number
    std::uint64_t nonfinite = 0;
};

/// Finds the camera as `shade` would and holds it against the position plane. Throws RuntimeFailure for broken pixels.
[[nodiscard]] CameraSurvey survey_camera(const std::filesystem::path& file, const ImageLayout& layout,
                                         const RoleAssignment& roles, const Scene& scene, int threads);

/// Reads the material_id plane alone. Throws RuntimeFailure for broken pixels.
[[nodiscard]] IdSurvey survey_ids(const std::filesystem::path& file, const ImageLayout& layout,
                                  const RoleAssignment& roles, int threads);

} // namespace clshade::cli
