#include "host/scene/scene_camera.h"

#include "host/scene/toml_reader.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 4> camera_keys{"matrix_world", "fov_x_degrees", "fov_y_degrees",
                                                      "orthographic_height"};
constexpr Range fov_range{"more than 0 and less than 180 degrees", 0.0, 180.0, true, true};

constexpr std::array<std::string_view, 12> role_names{"normal",  "position",    "depth",    "albedo",
                                                      "f0",      "roughness",   "metallic", "shininess",
                                                      "tangent", "material_id", "coverage", "emission"};
constexpr std::array<std::string_view, 15> gbuffer_keys{
    "normal",  "position",    "depth",    "albedo",   "f0",           "roughness",       "metallic",  "shininess",
    "tangent", "material_id", "coverage", "emission", "normal_space", "normal_encoding", "depth_kind"};
constexpr std::array<std::string_view, 2> normal_spaces{"world", "camera"};    // order of NormalSpace
constexpr std::array<std::string_view, 2> normal_encodings{"signed", "unorm"}; // order of NormalEncoding
constexpr std::array<std::string_view, 2> depth_kinds{"planar", "ray"};        // order of DepthKind

/// Rows in the file, columns in GLM.
glm::dmat4 read_matrix(const TomlValue& value) {
    const TomlArray* rows = value.array();
    if (rows == nullptr) {
        fail_type(value, "matrix_world", "four rows of four numbers");
    }
    if (rows->size() != 4) {
        fail(value.where, fmt::format("'matrix_world' has {} rows; write four rows of four numbers", rows->size()));
    }
    glm::dmat4 matrix(0.0);
    for (int r = 0; r < 4; ++r) {
        const TomlValue& row = (*rows)[static_cast<std::size_t>(r)];
        const TomlArray* numbers = row.array();
        if (numbers == nullptr) {
            fail_type(row, fmt::format("row {} of matrix_world", r + 1), "four numbers");
        }
        if (numbers->size() != 4) {
            fail(row.where, fmt::format("row {} of 'matrix_world' has {} numbers; write four", r + 1, numbers->size()));
        }
        for (int c = 0; c < 4; ++c) {
            matrix[c][r] = as_number((*numbers)[static_cast<std::size_t>(c)], "matrix_world", any_number);
        }
    }
    return matrix;
}

/// Cameras are rigid: shading needs only directions and an eye, and a scale would be a mistake in the file.
/// 1e-4 accepts numbers written with five digits.
void check_rigid(const glm::dmat4& matrix, const SourceLocation& where) {
    constexpr double tolerance = 1e-4;
    const glm::dvec4 last(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    if (glm::length(last - glm::dvec4(0.0, 0.0, 0.0, 1.0)) > tolerance) {
        fail(where,
             fmt::format("'matrix_world' is not affine: its last row is [{:g}, {:g}, {:g}, {:g}]; write rows for "
                         "column vectors, with the position in the last column and [0, 0, 0, 1] as last row",
                         last.x, last.y, last.z, last.w));
    }
    const glm::dmat3 axes(matrix);
    const double determinant = glm::determinant(axes);
    if (std::abs(determinant) < 1e-12) {
        fail(where, "'matrix_world' is singular: its axes do not span space; write a rotation and a position");
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(axes[axis]);
        if (std::abs(length - 1.0) > tolerance) {
            fail(where, fmt::format("'matrix_world' scales: its column {} has length {:g}; remove the scale so that "
                                    "every axis has length 1",
                                    axis + 1, length));
        }
    }
    const double skew = std::max({std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[1], axes[2])),
                                  std::abs(glm::dot(axes[2], axes[0]))});
    if (skew > tolerance) {
        fail(where,
             fmt::format("'matrix_world' shears: two of its axes have the dot product {:g}; write a rotation and "
                         "a position",
                         skew));
    }
    if (determinant < 0.0) {
        fail(where, "'matrix_world' mirrors: its determinant is negative; write a right-handed camera that looks along "
                    "-Z with +Y up");
    }
}

void read_lens(const TableReader& table, Camera& camera) {
    for (const std::string_view key : {"fov_x_degrees", "fov_y_degrees", "orthographic_height"}) {
        const TomlEntry* entry = table.find(key);
        if (entry == nullptr) {
            continue;
        }
        if (camera.lens != Lens::unknown) {
            fail(entry->where, "[camera] has more than one of 'fov_x_degrees', 'fov_y_degrees' and "
                               "'orthographic_height'; keep one");
        }
        if (key == "orthographic_height") {
            camera.lens = Lens::orthographic;
            camera.lens_value = as_number(entry->value, key, positive);
        } else {
            camera.lens = key == "fov_x_degrees" ? Lens::fov_x : Lens::fov_y;
            camera.lens_value = glm::radians(as_number(entry->value, key, fov_range));
        }
    }
}

} // namespace

Camera read_camera(const TomlEntry& entry) {
    const TableReader table(entry.value, "[camera]", camera_keys);
    const TomlValue& matrix = table.require("matrix_world", "matrix_world = [[1,0,0,0],[0,1,0,0],[0,0,1,5],[0,0,0,1]]");
    Camera camera;
    camera.where = entry.where;
    camera.matrix_world = read_matrix(matrix);
    check_rigid(camera.matrix_world, matrix.where);
    read_lens(table, camera);
    return camera;
}

GBufferSettings read_gbuffer(const TomlEntry& entry) {
    const TableReader table(entry.value, "[gbuffer]", gbuffer_keys);
    GBufferSettings settings;
    for (const std::string_view role : role_names) {
        if (const TomlEntry* named = table.find(role)) {
            settings.roles.push_back({std::string(role), as_text_list(named->value, role), named->value.where});
        }
    }
    if (const TomlEntry* space = table.find("normal_space")) {
        settings.normal_space = static_cast<NormalSpace>(as_choice(space->value, "normal_space", normal_spaces));
    }
    if (const TomlEntry* encoding = table.find("normal_encoding")) {
        settings.normal_encoding =
            static_cast<NormalEncoding>(as_choice(encoding->value, "normal_encoding", normal_encodings));
    }
    if (const TomlEntry* kind = table.find("depth_kind")) {
        settings.depth_kind = static_cast<DepthKind>(as_choice(kind->value, "depth_kind", depth_kinds));
    }
    return settings;
}

} // namespace clshade
