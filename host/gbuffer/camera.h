// Cameras: from the scene, from header attributes, or recovered from world positions.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/gbuffer/image_layout.h"
#include "host/gbuffer/visit_rows.h"
#include "host/scene/scene.h"

#include <optional>
#include <string>

namespace clshade {

/// View of a scene camera. Field of view and orthographic height span the display window; pixel aspect widens x.
[[nodiscard]] View view_from_camera(const Camera& camera, const Window& data_window, const Window& display_window,
                                    double pixel_aspect);

/// The standard header attribute worldToCamera (row vectors; camera left-handed, +z forward), with the field of view
/// from worldToNDC, worldToScreen or CameraFov where they agree; eye only where they do not. Empty if absent.
/// Throws RuntimeFailure if the matrix is singular or not finite.
[[nodiscard]] std::optional<View> view_from_header(const ImageLayout& layout, const Window& data_window);

struct RecoveredView {
    View view;
    double median_error_px = 0.0; ///< reprojection error of the inliers
    double p99_error_px = 0.0;
    int samples = 0;
    double inlier_fraction = 0.0;
};

/// Direct linear transform from pixel centres and world positions of a few thousand covered pixels, robust to outliers
/// (RANSAC with a fixed seed, then refined), perspective or orthographic, whichever explains the pixels better.
/// Throws UsageError if fewer than 16 usable pixels, or all in one plane without enough spread, or the fit is poor.
[[nodiscard]] RecoveredView recover_view(const Frame& frame);

/// The same for a picture whose planes are not in memory as a whole: `frame` has windows, roles and name, `rows` show
/// position, depth and coverage (camera_frame in frame_builder.h). Bit-identical for any division into bands.
[[nodiscard]] RecoveredView recover_view(const Frame& frame, const VisitRows& rows);

/// Median distance in pixels between where the view sees the Position plane and where it is; negative without one.
[[nodiscard]] double reprojection_error(const Frame& frame);
[[nodiscard]] double reprojection_error(const Frame& frame, const VisitRows& rows);

} // namespace clshade
