#include "host/gbuffer/camera_fit.h"

#include "host/gbuffer/small_linear_algebra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace clshade {

namespace {

/// Unknowns in order: rotation (3, a small turn in camera axes), eye (3), log focal, centre (2), log aspect.
constexpr std::size_t unknowns = 10;
using Gradient = std::array<glm::dvec2, unknowns>;

/// Indices of the unknowns that vary.
std::vector<std::size_t> active_unknowns(bool orthographic, Freedom freedom) {
    std::vector<std::size_t> active{0, 1, 2};
    if (!orthographic) {
        active.insert(active.end(), {3, 4, 5});
    }
    active.push_back(6);
    // Without perspective the eye's place across the axis is told by the centre alone.
    if (orthographic || freedom != Freedom::none) {
        active.insert(active.end(), {7, 8});
    }
    if (freedom == Freedom::centre_and_aspect) {
        active.push_back(9);
    }
    return active;
}

constexpr double nearest_depth = 1e-9;

std::optional<glm::dvec2> seen_at(const FittedCamera& camera, const glm::dvec3& position) {
    const glm::dvec3 c = camera.rotation * (position - camera.eye);
    if (camera.orthographic) {
        return camera.centre + camera.focal * glm::dvec2(camera.aspect * c.x, c.y);
    }
    if (!(c.z > nearest_depth)) {
        return std::nullopt;
    }
    return camera.centre + camera.focal * glm::dvec2(camera.aspect * c.x, c.y) / c.z;
}

/// Derivatives of the pixel by every unknown.
Gradient gradient_of(const FittedCamera& camera, const glm::dvec3& position) {
    const glm::dvec3 c = camera.rotation * (position - camera.eye);
    const double inverse = camera.orthographic ? 1.0 : 1.0 / c.z;
    const glm::dvec2 ray = glm::dvec2(c.x, c.y) * inverse;
    const glm::dvec2 gain = camera.focal * glm::dvec2(camera.aspect, 1.0);
    const auto by_c = [&](const glm::dvec3& dc) { // chain rule through the projection
        const glm::dvec2 across = glm::dvec2(dc.x, dc.y) * inverse;
        return gain * (camera.orthographic ? across : across - ray * (dc.z * inverse));
    };
    return {by_c({0.0, -c.z, c.y}),
            by_c({c.z, 0.0, -c.x}),
            by_c({-c.y, c.x, 0.0}),
            by_c(-camera.rotation[0]),
            by_c(-camera.rotation[1]),
            by_c(-camera.rotation[2]),
            gain * ray,
            glm::dvec2(1.0, 0.0),
            glm::dvec2(0.0, 1.0),
            glm::dvec2(gain.x * ray.x, 0.0)};
}

/// Rotation by the vector `turn` (Rodrigues), applied from the left.
glm::dmat3 turned(const glm::dmat3& rotation, const glm::dvec3& turn) {
    const double angle = glm::length(turn);
    if (angle < 1e-300) {
        return rotation;
    }
    const glm::dvec3 axis = turn / angle;
    glm::dmat3 result;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 v = rotation[i];
        result[i] = v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
                    axis * glm::dot(axis, v) * (1.0 - std::cos(angle));
    }
    return result;
}

FittedCamera stepped(const FittedCamera& camera, const std::array<double, unknowns>& step) {
    FittedCamera next = camera;
    next.rotation = turned(camera.rotation, {step[0], step[1], step[2]});
    next.eye += glm::dvec3(step[3], step[4], step[5]);
    next.focal *= std::exp(std::clamp(step[6], -1.0, 1.0));
    next.centre += glm::dvec2(step[7], step[8]);
    next.aspect *= std::exp(std::clamp(step[9], -1.0, 1.0));
    return next;
}

/// J^T W J and J^T W r over the active unknowns, in their order.
struct NormalEquations {
    SmallMatrix<unknowns> matrix{};
    SmallVector<unknowns> right{};
};

NormalEquations normal_equations(const FittedCamera& camera, std::span<const Sight> sights,
                                 const std::vector<std::size_t>& active, double scale) {
    NormalEquations equations;
    for (const Sight& sight : sights) {
        const auto seen = seen_at(camera, sight.position);
        if (!seen) {
            continue;
        }
        const glm::dvec2 residual = sight.pixel - *seen;
        const double weight = 1.0 / (1.0 + glm::dot(residual, residual) / (scale * scale));
        const Gradient gradient = gradient_of(camera, sight.position);
        for (std::size_t i = 0; i < active.size(); ++i) {
            const glm::dvec2 gi = weight * gradient[active[i]];
            equations.right[i] += glm::dot(gi, residual);
            for (std::size_t j = 0; j <= i; ++j) {
                equations.matrix[i][j] += glm::dot(gi, gradient[active[j]]);
            }
        }
    }
    for (std::size_t i = 0; i < active.size(); ++i) {
        for (std::size_t j = i + 1; j < active.size(); ++j) {
            equations.matrix[i][j] = equations.matrix[j][i];
        }
    }
    return equations;
}

/// Cauchy's loss; sights behind the camera cost as much as ones very far off.
double robust_cost(const FittedCamera& camera, std::span<const Sight> sights, double scale) {
    double cost = 0.0;
    for (const Sight& sight : sights) {
        const double error = std::min(sight_error(camera, sight), 1e6);
        cost += std::log1p(error * error / (scale * scale));
    }
    return cost;
}

/// Cauchy weights are 95 % efficient at 2.385 standard deviations; the median of a two-dimensional normal error is
/// 1.1774 of them. The floor keeps perfect data from dividing by zero.
double scale_for(double median) {
    return std::clamp(2.385 / 1.1774 * median, 1e-5, 1e6);
}

} // namespace

double sight_error(const FittedCamera& camera, const Sight& sight) {
    const auto seen = seen_at(camera, sight.position);
    const double error = seen ? glm::length(*seen - sight.pixel) : std::numeric_limits<double>::infinity();
    return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

std::vector<double> sight_errors(const FittedCamera& camera, std::span<const Sight> sights) {
    std::vector<double> errors;
    errors.reserve(sights.size());
    for (const Sight& sight : sights) {
        errors.push_back(sight_error(camera, sight));
    }
    return errors;
}

double median_of(std::vector<double> values) {
    if (values.empty()) {
        return 0.0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double agreement(const FittedCamera& camera, std::span<const Sight> sights, double threshold) {
    double sum = 0.0;
    for (const Sight& sight : sights) {
        const double ratio = sight_error(camera, sight) / threshold;
        sum += std::max(0.0, 1.0 - ratio * ratio);
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, sights.size()));
}

FittedCamera refine(FittedCamera camera, std::span<const Sight> sights, Freedom freedom) {
    const std::vector<std::size_t> active = active_unknowns(camera.orthographic, freedom);
    double damping = 1e-3;
    for (int iteration = 0; iteration < 60; ++iteration) {
        const double scale = scale_for(median_of(sight_errors(camera, sights)));
        const double cost = robust_cost(camera, sights, scale);
        const NormalEquations equations = normal_equations(camera, sights, active, scale);
        bool improved = false;
        double gain = 0.0;
        for (int attempt = 0; attempt < 8 && !improved; ++attempt) {
            SmallMatrix<unknowns> damped = equations.matrix;
            for (std::size_t i = 0; i < active.size(); ++i) {
                damped[i][i] *= 1.0 + damping;
            }
            const auto solution = solve_positive(damped, equations.right, active.size());
            if (solution) {
                std::array<double, unknowns> step{};
                for (std::size_t i = 0; i < active.size(); ++i) {
                    step[active[i]] = (*solution)[i];
                }
                const FittedCamera next = stepped(camera, step);
                const double next_cost = robust_cost(next, sights, scale);
                if (next_cost < cost) {
                    gain = (cost - next_cost) / cost;
                    camera = next;
                    improved = true;
                    damping = std::max(damping * 0.1, 1e-12);
                    break;
                }
            }
            damping *= 10.0;
        }
        if (!improved || gain < 1e-9) {
            break;
        }
    }
    return camera;
}

std::optional<Uncertainty> uncertainty_of(const FittedCamera& camera, std::span<const Sight> sights, Freedom freedom,
                                          double pixel_error) {
    const std::vector<std::size_t> active = active_unknowns(camera.orthographic, freedom);
    const double scale = scale_for(median_of(sight_errors(camera, sights)));
    const NormalEquations equations = normal_equations(camera, sights, active, scale);
    std::array<double, unknowns> variance{};
    for (std::size_t i = 0; i < active.size(); ++i) {
        SmallVector<unknowns> unit{};
        unit[i] = 1.0;
        const auto column = solve_positive(equations.matrix, unit, active.size());
        if (!column || !((*column)[i] >= 0.0)) {
            return std::nullopt;
        }
        variance[active[i]] = (*column)[i] * pixel_error * pixel_error;
    }
    std::vector<double> distances;
    for (const Sight& sight : sights) {
        distances.push_back(glm::length(sight.position - camera.eye));
    }
    Uncertainty result;
    result.rotation = std::sqrt(variance[0] + variance[1] + variance[2]);
    if (!camera.orthographic) {
        result.eye = std::sqrt(variance[3] + variance[4] + variance[5]) / std::max(median_of(distances), 1e-300);
    }
    return result;
}

} // namespace clshade
