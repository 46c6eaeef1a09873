#include "host/base/error.h"
#include "host/gbuffer/camera.h"
#include "host/gbuffer/camera_geometry.h"
#include "host/gbuffer/camera_samples.h"
#include "host/gbuffer/camera_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

namespace {

constexpr std::size_t fewest_samples = 16;

[[noreturn]] void fail(const Frame& frame, const std::string& reason) {
    throw UsageError(fmt::format("{}: the camera cannot be recovered from Position: {}; write [camera] with "
                                 "matrix_world and fov_y_degrees (or fov_x_degrees, orthographic_height) in the scene "
                                 "file",
                                 frame.file, reason));
}

/// Between world space and the centred, scaled positions that fits work in. Medians: outliers may be anywhere.
struct Normalisation {
    glm::dvec3 centre{0.0};
    double scale = 1.0; ///< world units to one
};

Normalisation normalise(const std::vector<CameraSample>& samples) {
    Normalisation result;
    for (int i = 0; i < 3; ++i) {
        std::vector<double> values;
        values.reserve(samples.size());
        for (const CameraSample& sample : samples) {
            values.push_back(sample.position[i]);
        }
        result.centre[i] = median_of(values);
    }
    std::vector<double> distances;
    distances.reserve(samples.size());
    for (const CameraSample& sample : samples) {
        distances.push_back(glm::length(sample.position - result.centre));
    }
    const double distance = median_of(distances);
    result.scale = distance > 0.0 ? 1.0 / distance : 0.0;
    return result;
}

/// The middle of the display window, from the data window's corner.
glm::dvec2 window_middle(const Frame& frame) {
    return {frame.display_window.x_min + 0.5 * frame.display_window.width() - frame.data_window.x_min,
            frame.display_window.y_min + 0.5 * frame.display_window.height() - frame.data_window.y_min};
}

/// Orthographic pictures do not tell how far away the camera is, nor near from far. Depth does, where there is depth.
void place_orthographic(FittedCamera& camera, const std::vector<CameraSample>& samples,
                        const std::vector<Sight>& sights, double scale, bool has_depth) {
    const auto forward = [&] { return glm::transpose(camera.rotation)[2]; };
    std::vector<double> along;
    std::vector<double> depths;
    for (std::size_t i = 0; i < sights.size(); ++i) {
        along.push_back(glm::dot(forward(), sights[i].position - camera.eye));
        depths.push_back(samples[i].depth * scale);
    }
    if (!has_depth) { // just before the nearest position
        const auto [nearest, farthest] = std::minmax_element(along.begin(), along.end());
        camera.eye += forward() * (*nearest - 0.1 * (*farthest - *nearest));
        return;
    }
    const double middle = median_of(depths);
    double slope = 0.0;
    for (std::size_t i = 0; i < along.size(); ++i) {
        slope += (depths[i] > middle ? 1.0 : -1.0) * along[i];
    }
    if (slope < 0.0) { // a left-handed world
        glm::dmat3 rows = glm::transpose(camera.rotation);
        rows[2] = -rows[2];
        camera.rotation = glm::transpose(rows);
        for (double& value : along) {
            value = -value;
        }
    }
    std::vector<double> offsets;
    for (std::size_t i = 0; i < along.size(); ++i) {
        offsets.push_back(along[i] - depths[i]);
    }
    camera.eye += forward() * median_of(offsets);
}

View view_of(const FittedCamera& camera, const Frame& frame, const Normalisation& norm) {
    const glm::dmat3 rows = glm::transpose(camera.rotation); // right, down, forward
    CameraPose pose;
    pose.axes = glm::dmat3(rows[0], -rows[1], -rows[2]);
    pose.eye = norm.centre + camera.eye / norm.scale;
    const double focal = camera.orthographic ? camera.focal * norm.scale : camera.focal;
    const double half_width = 0.5 * frame.display_window.width() * frame.pixel_aspect;
    const double half_height = 0.5 * frame.display_window.height();
    ScreenMap map;
    map.orthographic = camera.orthographic;
    map.scale = glm::dmat2(focal * camera.aspect / half_width, 0.0, 0.0, focal / half_height);
    map.offset = {camera.centre.x / half_width, -camera.centre.y / half_height};
    return make_view(pose, map, frame.data_window, frame.display_window);
}

/// Refuses cameras that the positions do not determine: a flat patch seen head-on, a few pixels of one object.
void check_certainty(const Frame& frame, const FoundCamera& found, const std::vector<Sight>& sights) {
    // A standard error of half a degree, or of 2 % of the distance, would be seen in highlights. The positions are not
    // trusted beyond a hundredth of a pixel.
    constexpr double worst_rotation = 0.01;
    constexpr double worst_eye = 0.02;
    const double pixel_error = std::max(found.median_error / 1.1774, 0.01);
    const auto doubt = uncertainty_of(found.camera, sights, found.freedom, pixel_error);
    if (!doubt || doubt->rotation > worst_rotation || doubt->eye > worst_eye) {
        fail(frame, "the positions lie in one plane or too close together to tell it");
    }
}

} // namespace

RecoveredView recover_view(const Frame& frame) {
    return recover_view(frame, whole_picture(frame));
}

RecoveredView recover_view(const Frame& frame, const VisitRows& rows) {
    if (frame.roles.position[0] == no_plane) {
        fail(frame, "there is no such plane");
    }
    const std::vector<CameraSample> samples = collect_samples(frame.data_window, rows);
    if (samples.size() < fewest_samples) {
        fail(frame, fmt::format("only {} pixels hold one, {} are needed", samples.size(), fewest_samples));
    }
    const Normalisation norm = normalise(samples);
    if (norm.scale == 0.0) {
        fail(frame, "all pixels hold the same one");
    }
    const glm::dvec2 middle = window_middle(frame);
    std::vector<Sight> sights;
    for (const CameraSample& sample : samples) {
        const glm::dvec2 offset = sample.pixel - middle;
        sights.push_back({{offset.x * frame.pixel_aspect, offset.y}, (sample.position - norm.centre) * norm.scale});
    }
    auto found = search_camera(sights);
    if (!found) {
        fail(frame, "the positions lie in one plane or too close together to tell it");
    }
    // Four standard deviations of an error of two coordinates; single precision costs about a hundredth of a pixel.
    const double threshold = std::max(4.0 / 1.1774 * found->median_error, 0.05);
    std::vector<double> inliers;
    for (const double error : sight_errors(found->camera, sights)) {
        if (error < threshold) {
            inliers.push_back(error);
        }
    }
    std::sort(inliers.begin(), inliers.end());
    RecoveredView result;
    result.samples = static_cast<int>(sights.size());
    result.inlier_fraction = static_cast<double>(inliers.size()) / static_cast<double>(sights.size());
    if (found->median_error > 2.0 || inliers.empty()) {
        fail(frame, fmt::format("the best fit is off by {:.1f} px in the median", found->median_error));
    }
    check_certainty(frame, *found, sights);
    result.median_error_px = inliers[inliers.size() / 2];
    result.p99_error_px = inliers[inliers.size() * 99 / 100];
    if (found->camera.orthographic) {
        place_orthographic(found->camera, samples, sights, norm.scale, frame.roles.depth != no_plane);
    }
    result.view = view_of(found->camera, frame, norm);
    return result;
}

double reprojection_error(const Frame& frame) {
    return reprojection_error(frame, whole_picture(frame));
}

double reprojection_error(const Frame& frame, const VisitRows& rows) {
    if (frame.roles.position[0] == no_plane || !frame.view.has_rays) {
        return -1.0;
    }
    constexpr double behind = 1e9; // pixels, for positions behind the camera
    std::vector<double> errors;
    for (const CameraSample& sample : collect_samples(frame.data_window, rows)) {
        const auto seen = project(frame.view, sample.position);
        errors.push_back(seen ? glm::length(*seen - sample.pixel) : behind);
    }
    return errors.empty() ? -1.0 : median_of(errors);
}

} // namespace clshade
