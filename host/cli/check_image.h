// The parts of `check` that touch image files: INPUT and --dump.
#pragma once

#include "host/cli/environment_input.h"
#include "host/cli/options.h"
#include "host/gbuffer/frame.h"
#include "host/reference/reference.h"
#include "host/shading/shader.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace clshade::cli {

struct CheckInput {
    Frame frame; ///< its environment still lacks the maps that kernels read
    std::optional<EnvironmentInput> environment;
    std::vector<std::string> warnings;
};

/// Reads INPUT and the scene's environment as `shade` would. In builds without image files: throws UsageError.
[[nodiscard]] CheckInput read_check_input(const std::filesystem::path& file, const SceneOptions& scene,
                                          std::uint64_t max_memory);

/// Throws as check_output_path does, and if --dump would overwrite the input.
void check_dump_path(const std::filesystem::path& file, const std::filesystem::path& input);

/// Planes device.R, reference.R, error.R (device - reference), ..., of one or several frames. They lie in the upper
/// left corner of the largest frame's window.
class ErrorDump {
  public:
    /// `layer`: put before the planes' names with a dot; may be empty.
    void add(const std::string& layer, const Frame& frame, const ShadedImage& shaded, const reference::Image& expected);
    /// Writes all as float EXR. Throws RuntimeFailure.
    void write(const std::filesystem::path& file) const;

  private:
    struct Entry {
        std::string layer;
        PlaneSlab planes;
    };
    Window data_window_;
    Window display_window_;
    double pixel_aspect_ = 1.0;
    std::vector<Entry> entries_;
};

} // namespace clshade::cli
