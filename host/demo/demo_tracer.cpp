#include "host/demo/demo_tracer.h"

#include <cmath>
#include <limits>
#include <optional>

namespace clshade::demo {

namespace {

struct Interval {
    float begin = 0.0F;
    float end = -1.0F;
};

/// Where the ray is inside the object's bound; empty (end < begin) if nowhere ahead.
Interval bound_of(const Object& object, glm::vec3 origin, glm::vec3 direction) {
    if (object.shape == Shape::cylinder) { // flat: the slab between its ends is tighter than the sphere
        const float top = (object.centre.z + object.size.z - origin.z) / direction.z;
        const float bottom = (object.centre.z - object.size.z - origin.z) / direction.z;
        return {std::fmax(std::fmin(top, bottom) - 0.01F, 0.0F), std::fmax(top, bottom) + 0.01F};
    }
    const glm::vec3 to_centre = object.centre - origin;
    const float along = glm::dot(to_centre, direction);
    const float half_squared = object.bound * object.bound - glm::dot(to_centre, to_centre) + along * along;
    if (half_squared <= 0.0F) {
        return {};
    }
    const float half = std::sqrt(half_squared);
    return {std::fmax(along - half, 0.0F), along + half};
}

/// Sphere tracing inside the interval.
std::optional<float> meet(const Object& object, glm::vec3 origin, glm::vec3 direction, const Interval& interval) {
    // 2e-5 of scene units of about 10: near the resolution of single precision, far below a pixel (5e-3).
    constexpr float close = 2e-5F;
    constexpr int most_steps = 300; // only rays that graze a surface take more than some tens
    float t = interval.begin;
    for (int step = 0; step < most_steps && t <= interval.end; ++step) {
        const float distance = object.distance(origin + t * direction);
        if (distance < close) {
            return t;
        }
        t += distance;
    }
    return std::nullopt;
}

} // namespace

Hit trace(const Stage& stage, glm::vec3 origin, glm::vec3 direction) {
    Hit hit;
    hit.distance = std::numeric_limits<float>::max();
    for (const Object& object : stage.objects) {
        Interval interval = bound_of(object, origin, direction);
        interval.end = std::fmin(interval.end, hit.distance);
        if (interval.end < interval.begin) {
            continue;
        }
        if (const std::optional<float> t = meet(object, origin, direction, interval)) {
            hit.object = &object;
            hit.distance = *t;
        }
    }
    if (hit.object != nullptr) {
        hit.point = origin + hit.distance * direction;
        hit.normal = hit.object->normal(hit.point);
    }
    return hit;
}

} // namespace clshade::demo
