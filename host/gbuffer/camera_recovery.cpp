#include "host/base/error.h"
#include "host/gbuffer/camera.h"
#include "host/gbuffer/camera_geometry.h"
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

constexpr std::size_t sample_target = 4000;
constexpr std::size_t fewest_samples = 16;
constexpr float depth_sentinel = 6e4F; // beyond: background

/// A covered pixel and what its planes say.
struct Sample {
    glm::dvec2 pixel{0.0}; ///< centre, from the data window's corner
    glm::dvec3 position{0.0};
    double depth = 0.0; ///< 0 without a depth plane
};

[[noreturn]] void fail(const Frame& frame, const std::string& reason) {
    throw UsageError(fmt::format("{}: the camera cannot be recovered from Position: {}; write [camera] with "
                                 "matrix_world and fov_y_degrees (or fov_x_degrees, orthographic_height) in the scene "
                                 "file",
                                 frame.file, reason));
}

/// Is the position at this pixel that of a surface? `least_coverage` leaves out edges.
std::optional<Sample> sample_at(const Frame& frame, int x, int y, float least_coverage) {
    const RolePlanes& roles = frame.roles;
    Sample sample;
    if (roles.coverage != no_plane && !(frame.planes.at(roles.coverage, x, y) > least_coverage)) {
        return std::nullopt;
    }
    if (roles.depth != no_plane) {
        const float depth = frame.planes.at(roles.depth, x, y);
        if (!(depth > 0.0F) || !(depth < depth_sentinel)) {
            return std::nullopt;
        }
        sample.depth = static_cast<double>(depth);
    }
    for (int i = 0; i < 3; ++i) {
        sample.position[i] = static_cast<double>(frame.planes.at(roles.position[static_cast<std::size_t>(i)], x, y));
    }
    const double size = glm::length(sample.position);
    if (!std::isfinite(size) || (roles.depth == no_plane && size == 0.0)) {
        return std::nullopt;
    }
    sample.pixel = {x + 0.5, y + 0.5};
    return sample;
}

/// Up to `sample_target` samples spread evenly over those found on every `step`-th pixel of every `step`-th row.
std::vector<Sample> samples_on_lattice(const Frame& frame, int step, float least_coverage) {
    std::vector<Sample> all;
    for (int y = step / 2; y < frame.planes.height(); y += step) {
        for (int x = step / 2; x < frame.planes.width(); x += step) {
            if (const auto sample = sample_at(frame, x, y, least_coverage)) {
                all.push_back(*sample);
            }
        }
    }
    if (all.size() <= sample_target) {
        return all;
    }
    std::vector<Sample> some;
    for (std::size_t i = 0; i < sample_target; ++i) {
        some.push_back(all[i * all.size() / sample_target]);
    }
    return some;
}

/// Samples of whole pixels if there are enough of them, from a coarse lattice if that gives enough.
std::vector<Sample> collect_samples(const Frame& frame) {
    const double pixels = static_cast<double>(frame.planes.width()) * frame.planes.height();
    const int coarse = std::max(1, static_cast<int>(std::sqrt(pixels / 65536.0)));
    std::vector<Sample> best;
    for (const float least_coverage : {0.999F, 0.0F}) {
        for (const int step : {coarse, 1}) {
            std::vector<Sample> samples = samples_on_lattice(frame, step, least_coverage);
            if (samples.size() >= sample_target / 4) {
                return samples;
            }
            if (samples.size() > best.size()) {
                best = std::move(samples);
            }
        }
        if (best.size() >= 200) { // enough; edges would add more doubt than knowledge
            break;
        }
    }
    return best;
}

/// Between world space and the centred, scaled positions that fits work in. Medians: outliers may be anywhere.
struct Normalisation {
    glm::dvec3 centre{0.0};
    double scale = 1.0; ///< world units to one
};

Normalisation normalise(const std::vector<Sample>& samples) {
    Normalisation result;
    for (int i = 0; i < 3; ++i) {
        std::vector<double> values;
        values.reserve(samples.size());
        for (const Sample& sample : samples) {
            values.push_back(sample.position[i]);
        }
        result.centre[i] = median_of(values);
    }
    std::vector<double> distances;
    distances.reserve(samples.size());
    for (const Sample& sample : samples) {
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
void place_orthographic(FittedCamera& camera, const std::vector<Sample>& samples, const std::vector<Sight>& sights,
                        double scale, bool has_depth) {
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
    if (frame.roles.position[0] == no_plane) {
        fail(frame, "there is no such plane");
    }
    const std::vector<Sample> samples = collect_samples(frame);
    if (samples.size() < fewest_samples) {
        fail(frame, fmt::format("only {} pixels hold one, {} are needed", samples.size(), fewest_samples));
    }
    const Normalisation norm = normalise(samples);
    if (norm.scale == 0.0) {
        fail(frame, "all pixels hold the same one");
    }
    const glm::dvec2 middle = window_middle(frame);
    std::vector<Sight> sights;
    for (const Sample& sample : samples) {
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
    if (frame.roles.position[0] == no_plane || !frame.view.has_rays) {
        return -1.0;
    }
    constexpr double behind = 1e9; // pixels, for positions behind the camera
    std::vector<double> errors;
    for (const Sample& sample : collect_samples(frame)) {
        const auto seen = project(frame.view, sample.position);
        errors.push_back(seen ? glm::length(*seen - sample.pixel) : behind);
    }
    return errors.empty() ? -1.0 : median_of(errors);
}

} // namespace clshade
