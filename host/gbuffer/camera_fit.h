// Private to host/gbuffer: fitting a camera to pixels and the world positions seen there.
#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <span>
#include <vector>

namespace clshade {

/// A pixel centre and the position seen there. Pixels are "square": x times the pixel aspect, y down, counted from the
/// middle of the display window, in pixel heights. Positions are centred and scaled to about one.
struct Sight {
    glm::dvec2 pixel{0.0};
    glm::dvec3 position{0.0};
};

/// A camera without skew: c = rotation (position - eye), with x right, y down, z forward;
///   perspective: pixel = centre + focal (aspect c.x, c.y) / c.z;   orthographic: the same without the division.
/// In a left-handed world the rotation has determinant -1.
struct FittedCamera {
    bool orthographic = false;
    glm::dmat3 rotation{1.0};
    glm::dvec3 eye{0.0};
    double focal = 1.0;
    glm::dvec2 centre{0.0};
    double aspect = 1.0;
};

/// What may vary in a fit beyond rotation, eye and focal length.
enum class Freedom {
    none,              ///< the axis meets the middle of the display window
    centre,            ///< shifted lens or cropped picture
    centre_and_aspect, ///< and pixels whose aspect the header does not tell
};

/// Distance in pixels between where the camera sees the position and where it is; infinite behind the camera.
[[nodiscard]] double sight_error(const FittedCamera& camera, const Sight& sight);
[[nodiscard]] std::vector<double> sight_errors(const FittedCamera& camera, std::span<const Sight> sights);
[[nodiscard]] double median_of(std::vector<double> values);

/// Share of the sights seen within `threshold` pixels, counted smoothly: mean of max(0, 1 - (error / threshold)^2).
[[nodiscard]] double agreement(const FittedCamera& camera, std::span<const Sight> sights, double threshold);

/// Levenberg-Marquardt with Cauchy weights, whose scale follows the median error, so that outliers do not pull.
[[nodiscard]] FittedCamera refine(FittedCamera camera, std::span<const Sight> sights, Freedom freedom);

/// How well the sights determine the camera, as standard deviations for a given error per coordinate.
struct Uncertainty {
    double rotation = 0.0; ///< radians
    double eye = 0.0;      ///< relative to the median distance; 0 for orthographic cameras
};

/// Empty if the sights do not determine the camera at all.
[[nodiscard]] std::optional<Uncertainty> uncertainty_of(const FittedCamera& camera, std::span<const Sight> sights,
                                                        Freedom freedom, double pixel_error);

/// First guesses. `dlt_camera`: the direct linear transform (Hartley and Zisserman, Multiple View Geometry, section
/// 7.1), 6 sights at least; `affine_camera`: its orthographic twin, 4 at least; `plane_camera`: from the homography of
/// sights in one plane, the axis in the middle. Empty for degenerate sights.
[[nodiscard]] std::optional<FittedCamera> dlt_camera(std::span<const Sight> sights);
[[nodiscard]] std::optional<FittedCamera> affine_camera(std::span<const Sight> sights);
[[nodiscard]] std::optional<FittedCamera> plane_camera(std::span<const Sight> sights);

} // namespace clshade
