#include "host/shading/constants.h"

#include "host/base/rounding.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <type_traits>

namespace clshade {

// The layout both compilers must agree on: 4-byte members only, no padding.
static_assert(std::is_trivially_copyable_v<LightConstants> && sizeof(LightConstants) == 80);
static_assert(offsetof(LightConstants, direction) == 16 && offsetof(LightConstants, power) == 64);
static_assert(std::is_trivially_copyable_v<FrameConstants> && sizeof(FrameConstants) == 208);
static_assert(offsetof(FrameConstants, camera_to_world) == 48 && offsetof(FrameConstants, light_count) == 192);

namespace {

/// A smoothstep this steep is a hard edge.
constexpr float hard_edge = 1e30F;

void put(float (&target)[4], const glm::dvec3& value) {
    for (int i = 0; i < 3; ++i) {
        target[i] = static_cast<float>(value[i]);
    }
}

/// value = hi + lo, each a float.
void put_split(float (&hi)[4], float (&lo)[4], const glm::dvec3& value) {
    for (int i = 0; i < 3; ++i) {
        const double high = rounded_to_float(value[i]);
        hi[i] = static_cast<float>(high);
        lo[i] = static_cast<float>(value[i] - high);
    }
}

int kernel_type(LightType type) {
    switch (type) {
    case LightType::distant:
        return LIGHT_DISTANT;
    case LightType::point:
        return LIGHT_POINT;
    case LightType::spot:
        return LIGHT_SPOT;
    }
    return LIGHT_DISTANT;
}

LightConstants constants_of(const Light& light) {
    LightConstants constants{};
    constants.type = kernel_type(light.type);
    if (light.type != LightType::point) {
        const glm::dvec3 travel = glm::normalize(light.direction);
        put(constants.direction, light.type == LightType::distant ? -travel : travel);
    }
    put_split(constants.position_hi, constants.position_lo, light.position);
    put(constants.power, light.power);
    constants.cone_angle = static_cast<float>(light.cone_angle);
    const double width = light.cone_angle * light.cone_softness;
    constants.cone_inverse_width = width > 0.0 ? static_cast<float>(1.0 / width) : hard_edge;
    return constants;
}

} // namespace

FrameConstants frame_constants(const Frame& frame) {
    const View& view = frame.view;
    FrameConstants constants{};
    put_split(constants.eye_hi, constants.eye_lo, view.eye);
    put(constants.view_axis, view.view_axis);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            constants.camera_to_world[4 * row + column] = static_cast<float>(view.camera_to_world[column][row]);
        }
    }
    put(constants.origin, view.origin);
    put(constants.origin_dx, view.origin_dx);
    put(constants.origin_dy, view.origin_dy);
    put(constants.direction, view.direction);
    put(constants.direction_dx, view.direction_dx);
    put(constants.direction_dy, view.direction_dy);
    constants.light_count = static_cast<int>(frame.lights.size());
    constants.pitch = frame.planes.pitch();
    return constants;
}

std::vector<LightConstants> light_constants(const Frame& frame) {
    std::vector<LightConstants> constants;
    for (const Light& light : frame.lights) {
        constants.push_back(constants_of(light));
    }
    if (constants.empty()) {
        constants.emplace_back();
    }
    return constants;
}

} // namespace clshade
