// From an image file and a scene to a Frame that can be shaded or compared.
#pragma once

#include "host/cli/options.h"
#include "host/cli/run_stats.h"
#include "host/gbuffer/frame_builder.h"
#include "host/gbuffer/roles.h"
#include "host/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace clshade::cli {

/// A scene and what the output says about it.
struct ChosenScene {
    Scene scene;
    std::string name;                               ///< file name, or "default"
    std::string hash;                               ///< of the file's text, the overrides and the tables
    std::string file;                               ///< empty for the default scene
    std::vector<std::filesystem::path> tables;      ///< n,k files of metals
    std::vector<std::filesystem::path> environment; ///< files of the environment; not in the hash
};

/// Reads --scene, or takes the default scene; --set and --model applied. Throws like read_scene.
[[nodiscard]] ChosenScene choose_scene(const SceneOptions& options);

/// An input whose header has been read and found good; no pixels yet.
struct PlannedInput {
    std::filesystem::path file;
    ImageLayout layout;
    RoleAssignment roles;
    FramePlan plan;
};

/// Reads the header, assigns roles, binds the scene. Throws like read_layout, assign_roles and plan_frame.
[[nodiscard]] PlannedInput plan_input(const std::filesystem::path& file, const Scene& scene, const std::string& view,
                                      const std::vector<std::string>& keep = {});

/// A layer that is passed through to the output.
struct KeptPlane {
    int plane = 0;    ///< of Frame::planes
    std::string name; ///< as in the input
    bool exact_in_half = false;
};

/// A frame in memory and what is known of the file it came from.
struct LoadedFrame {
    ImageLayout layout;
    Frame frame;
    std::vector<KeptPlane> kept;
    std::string camera_source;
    std::vector<std::string> warnings; ///< of header, roles and frame, each once
};

/// Reads the planes and finishes the frame. Throws like read_planes and finish_frame.
[[nodiscard]] LoadedFrame load_frame(PlannedInput input, const Scene& scene, int threads);

/// Where the camera of a planned input comes from, in words.
[[nodiscard]] std::string camera_source(const PlannedInput& input, const Scene& scene);

/// One line per role that has channels: role, channels, rule.
[[nodiscard]] std::string roles_text(const PlannedInput& input);

} // namespace clshade::cli
