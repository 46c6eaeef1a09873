#include "host/scene/scene_camera.h"

#include "host/base/error.h"
#include "host/base/frame_range.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 4> camera_keys{"matrix_world", "fov_x_degrees", "fov_y_degrees",
                                                      "orthographic_height"};
constexpr std::array<std::string_view, 6> camera_table_keys{"matrix_world",        "fov_x_degrees", "fov_y_degrees",
                                                            "orthographic_height", "file",          "frames"};
constexpr std::string_view matrix_example = "matrix_world = [[1,0,0,0],[0,1,0,0],[0,0,1,5],[0,0,0,1]]";
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

void read_lens(const TableReader& table, CameraKeys& camera) {
    for (const std::string_view key : {"fov_x_degrees", "fov_y_degrees", "orthographic_height"}) {
        const TomlEntry* entry = table.find(key);
        if (entry == nullptr) {
            continue;
        }
        if (camera.lens != Lens::unknown) {
            fail(entry->where, fmt::format("{} has more than one of 'fov_x_degrees', 'fov_y_degrees' and "
                                           "'orthographic_height'; keep one",
                                           table.title()));
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

int frame_number(const TomlEntry& entry) {
    int number = 0;
    const char* const end = entry.key.data() + entry.key.size();
    const auto [last, error] = std::from_chars(entry.key.data(), end, number);
    if (error != std::errc() || last != end) {
        fail(entry.where, fmt::format("'{}' in [camera.frames] is not a frame number; write for instance "
                                      "[camera.frames.101]",
                                      entry.key));
    }
    return number;
}

std::map<int, Camera> read_listed(const TomlEntry& frames, const CameraKeys& shared) {
    const TomlTable* table = frames.value.table();
    if (table == nullptr || table->entries.empty()) {
        fail(frames.where, "'frames' of [camera] holds no table; write for instance [camera.frames.101] and the keys "
                           "of [camera] below it");
    }
    std::map<int, Camera> listed;
    for (const TomlEntry& entry : table->entries) {
        const int number = frame_number(entry);
        const TableReader keys(entry.value, fmt::format("[camera.frames.{}]", entry.key), camera_keys);
        const std::optional<Camera> camera = join_camera(read_camera_keys(keys), shared);
        if (!camera) {
            fail(entry.where, fmt::format("{} lacks 'matrix_world', and so does [camera]; write for instance {}",
                                          keys.title(), matrix_example));
        }
        if (!listed.emplace(number, *camera).second) {
            fail(entry.where, fmt::format("frame {} stands in [camera.frames] twice; keep one", number));
        }
    }
    return listed;
}

std::string read_file_pattern(const TomlValue& value) {
    const std::string& pattern = as_text(value, "file");
    const std::string extension = std::filesystem::path(pattern).extension().string();
    if (extension != ".json" && extension != ".toml") {
        fail(value.where, fmt::format("'file' of [camera] is '{}'; name .json or .toml files, for instance "
                                      "camera.%04d.json",
                                      pattern));
    }
    try {
        if (SequencePath::parse_pattern(pattern)) {
            return pattern;
        }
    } catch (const UsageError& error) {
        fail(value.where, fmt::format("'file' of [camera]: {}", error.what()));
    }
    fail(value.where,
         fmt::format("'file' of [camera] is '{}', without a place for the frame number; write for instance "
                     "camera.%04d.json or camera.####.json",
                     pattern));
}

} // namespace

std::span<const std::string_view> camera_key_names() {
    return camera_keys;
}

CameraKeys read_camera_keys(const TableReader& table) {
    CameraKeys keys;
    keys.where = table.where();
    if (const TomlEntry* matrix = table.find("matrix_world")) {
        keys.matrix_world = read_matrix(matrix->value);
        check_rigid(*keys.matrix_world, matrix->value.where);
    }
    read_lens(table, keys);
    return keys;
}

std::optional<Camera> join_camera(const CameraKeys& own, const CameraKeys& shared) {
    const std::optional<glm::dmat4>& matrix = own.matrix_world ? own.matrix_world : shared.matrix_world;
    if (!matrix) {
        return std::nullopt;
    }
    const CameraKeys& lens = own.lens != Lens::unknown ? own : shared;
    return Camera{*matrix, lens.lens, lens.lens_value, own.where};
}

void read_camera(const TomlEntry& entry, Scene& scene) {
    const TableReader table(entry.value, "[camera]", camera_table_keys);
    CameraKeys shared = read_camera_keys(table);
    shared.where = entry.where;
    scene.camera = join_camera(shared, shared);
    const TomlEntry* file = table.find("file");
    const TomlEntry* frames = table.find("frames");
    if (file == nullptr && frames == nullptr) {
        (void)table.require("matrix_world", matrix_example);
        return;
    }
    FrameCameras& cameras = scene.frame_cameras.emplace();
    cameras.shared = shared;
    if (frames != nullptr) {
        cameras.listed = read_listed(*frames, shared);
    }
    if (file != nullptr) {
        cameras.file = read_file_pattern(file->value);
        cameras.file_where = file->value.where;
    }
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
