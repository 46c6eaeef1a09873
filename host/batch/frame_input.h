// From an image file and a scene to a Frame that can be shaded or compared.
#pragma once

#include "host/gbuffer/frame_builder.h"
#include "host/gbuffer/roles.h"
#include "host/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace clshade {

/// An input whose header has been read and found good; no pixels yet.
struct PlannedInput {
    std::filesystem::path file;
    ImageLayout layout;
    RoleAssignment roles;
    FramePlan plan;
    std::string camera_source; ///< where the camera comes from, in words
};

/// Reads the header, assigns roles, binds the scene with the camera of the given frame. `keep`: layers passed through.
/// Throws like read_layout, assign_roles, camera_of_frame and plan_frame.
[[nodiscard]] PlannedInput plan_input(const std::filesystem::path& file, const Scene& scene, const std::string& view,
                                      const std::vector<std::string>& keep = {},
                                      std::optional<int> frame = std::nullopt);

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
    std::uint64_t bytes_read = 0;
    double busy_milliseconds = 0.0; ///< of all threads that decoded, summed
};

/// Reads the planes and finishes the frame. `planes`: a slab of the right shape to be used again, whatever it holds;
/// of another shape or empty: a new one is made. Throws like PlaneReader and finish_frame.
[[nodiscard]] LoadedFrame load_frame(PlannedInput input, PlaneSlab planes = {});

/// Everything of a LoadedFrame but the planes and the finished frame.
[[nodiscard]] LoadedFrame describe(const PlannedInput& input);
/// Moves a finished frame in, and its warnings.
void accept(LoadedFrame& loaded, Frame frame);

} // namespace clshade
