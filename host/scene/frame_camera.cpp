#include "host/scene/frame_camera.h"

#include "host/base/error.h"
#include "host/base/frame_range.h"
#include "host/scene/camera_side_file.h"
#include "host/scene/scene_camera.h"

#include <fmt/format.h>

namespace clshade {

namespace {

constexpr std::size_t most_named = 8; // frames listed in a message

std::string start_of_message(const Scene& scene) {
    return scene.file.empty() ? std::string() : scene.file + ": ";
}

std::string listed_frames(const FrameCameras& cameras) {
    std::string text;
    std::size_t named = 0;
    for (const auto& [number, camera] : cameras.listed) {
        if (named == most_named) {
            return fmt::format("{} and {} more", text, cameras.listed.size() - most_named);
        }
        text += fmt::format("{}{}", named == 0 ? "" : ", ", number);
        ++named;
    }
    return text;
}

/// The frame's number, where it matters.
int number_of(const Scene& scene, std::optional<int> frame) {
    if (!frame) {
        throw UsageError(fmt::format("{}[camera] differs from frame to frame, and the input has no frame number; give "
                                     "the input as a sequence, such as name.####.exr with --frames N",
                                     start_of_message(scene)));
    }
    return *frame;
}

} // namespace

bool has_frame_cameras(const Scene& scene) {
    return scene.frame_cameras.has_value();
}

std::optional<Camera> camera_of_frame(const Scene& scene, std::optional<int> frame) {
    if (!scene.frame_cameras) {
        return scene.camera;
    }
    const FrameCameras& cameras = *scene.frame_cameras;
    const int number = number_of(scene, frame);
    if (const auto listed = cameras.listed.find(number); listed != cameras.listed.end()) {
        return listed->second;
    }
    if (cameras.file.empty()) {
        if (!scene.camera) {
            throw UsageError(fmt::format("{}no camera for frame {}: [camera.frames] has {}; write [camera.frames.{}], "
                                         "or matrix_world in [camera] for all other frames",
                                         start_of_message(scene), number, listed_frames(cameras), number));
        }
        return scene.camera;
    }
    const std::filesystem::path file = camera_file_of_frame(scene, number);
    std::optional<Camera> camera;
    try {
        camera = join_camera(read_camera_side_file(file), cameras.shared);
    } catch (const UsageError& error) { // content of an input file: other frames may be good
        throw RuntimeFailure(fmt::format("{} (camera of frame {})", error.what(), number));
    }
    if (!camera) {
        throw RuntimeFailure(fmt::format("{}: the camera of frame {} lacks 'matrix_world', and so does [camera]; write "
                                         "it as four rows of four numbers",
                                         file.string(), number));
    }
    return camera;
}

std::filesystem::path camera_file_of_frame(const Scene& scene, std::optional<int> frame) {
    if (!scene.frame_cameras || !frame || scene.frame_cameras->file.empty() ||
        scene.frame_cameras->listed.count(*frame) > 0) {
        return {};
    }
    const auto pattern = SequencePath::parse_pattern(scene.frame_cameras->file);
    return std::filesystem::path(scene.file).parent_path() / pattern.value().at(*frame);
}

std::string camera_place(const Scene& scene, std::optional<int> frame) {
    const std::filesystem::path file = camera_file_of_frame(scene, frame);
    if (!file.empty()) {
        return file.string();
    }
    const bool listed = scene.frame_cameras && frame && scene.frame_cameras->listed.count(*frame) > 0;
    if (!listed && !scene.camera) {
        return {};
    }
    if (scene.file.empty()) {
        return "--set camera";
    }
    return listed ? fmt::format("[camera.frames.{}] of {}", *frame, scene.file)
                  : fmt::format("[camera] of {}", scene.file);
}

} // namespace clshade
