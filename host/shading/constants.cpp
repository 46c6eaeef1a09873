#include "host/shading/constants.h"

#include "host/base/rounding.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <type_traits>

namespace clshade {

// The layout both compilers must agree on: 4-byte members only, no padding.
static_assert(std::is_trivially_copyable_v<LightConstants> && sizeof(LightConstants) == 80);
static_assert(offsetof(LightConstants, direction) == 16 && offsetof(LightConstants, power) == 64);
static_assert(std::is_trivially_copyable_v<FrameConstants> && sizeof(FrameConstants) == 208);
static_assert(offsetof(FrameConstants, camera_to_world) == 48 && offsetof(FrameConstants, light_count) == 192);
static_assert(std::is_trivially_copyable_v<EnvironmentConstants> && sizeof(EnvironmentConstants) == 240);
static_assert(offsetof(EnvironmentConstants, band1) == 64 && offsetof(EnvironmentConstants, intensity) == 208);

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

EnvironmentConstants environment_constants(const BoundEnvironment& environment) {
    // models.md section 6: E/pi = sum_l c_l sum_m L_lm Y_lm, c = 1, 2/3, 1/4.
    constexpr double y0 = 0.28209479177387814;
    constexpr double y1 = 2.0 / 3.0 * 0.4886025119029199;
    constexpr double y2_product = 0.25 * 1.0925484305920792;
    constexpr double y2_square = 0.25 * 0.31539156525252005;
    constexpr double y2_difference = 0.25 * 0.5462742152960396;
    const std::array<glm::dvec3, 9>& sh = environment.maps->sh;
    const glm::dmat3 turn = glm::transpose(environment.world_to_image);

    EnvironmentConstants constants{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            constants.world_to_image[4 * row + column] = static_cast<float>(environment.world_to_image[column][row]);
        }
    }
    put(constants.intensity, environment.intensity);
    put(constants.band0, environment.intensity * sh[0] * y0);
    for (int c = 0; c < 3; ++c) {
        const double intensity = environment.intensity[c];
        const glm::dvec3 linear = turn * (y1 * intensity * glm::dvec3(sh[3][c], sh[1][c], sh[2][c]));
        for (int axis = 0; axis < 3; ++axis) {
            constants.band1[axis][c] = static_cast<float>(linear[axis]);
        }
        // The quadratic form as a symmetric matrix; 3 z^2 - 1 = 2 z^2 - x^2 - y^2 for unit vectors.
        const double xy = 0.5 * y2_product * sh[4][c];
        const double yz = 0.5 * y2_product * sh[5][c];
        const double zx = 0.5 * y2_product * sh[7][c];
        const double zz = y2_square * sh[6][c];
        const double difference = y2_difference * sh[8][c];
        const glm::dmat3 form(difference - zz, xy, zx, xy, -difference - zz, yz, zx, yz, 2.0 * zz);
        const glm::dmat3 world = intensity * (turn * form * environment.world_to_image);
        const std::array<double, 6> terms = {world[0][0],       world[1][1],       world[2][2],
                                             2.0 * world[0][1], 2.0 * world[1][2], 2.0 * world[2][0]};
        for (std::size_t k = 0; k < terms.size(); ++k) {
            constants.band2[k][c] = static_cast<float>(terms[k]);
        }
    }
    if (environment.image) {
        constants.picture_width = environment.image->width;
        constants.picture_height = environment.image->height;
    }
    return constants;
}

} // namespace clshade
