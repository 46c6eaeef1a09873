// Image files out: EXR with attributes, or a display-referred PNG preview; never half-written.
#pragma once

#include "host/base/plane_slab.h"
#include "host/gbuffer/image_layout.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clshade {

struct ExrSettings {
    bool half = true;                ///< -d half|float
    std::string compression = "zip"; ///< none rle zips zip piz pxr24 b44 b44a dwaa dwab
    std::optional<double> level;     ///< zip: 1..9, dwa: lossiness
    int threads = 1;
};

/// Planes to write: names[i] is the channel name of plane plane_index[i] of slab[i].
struct OutputChannel {
    std::string name;
    const PlaneSlab* slab = nullptr;
    int plane = 0;
    bool force_float = false; ///< ids, positions, depth: never half
};

struct OutputImage {
    Window data_window;
    Window display_window;
    double pixel_aspect = 1.0;
    std::vector<OutputChannel> channels;
    std::map<std::string, std::string> attributes; ///< strings
    std::map<std::string, glm::dmat4> matrices;    ///< element [row][column] as stored (row vectors)
};

/// Throws UsageError for an extension other than .exr and .png (in any case), RuntimeFailure for a folder that does not
/// exist or cannot be written, and for a target that is a folder, a device or write-protected. Call before shading, so
/// that nobody waits for a result that cannot be stored.
void check_output_path(const std::filesystem::path& file);

/// Throws UsageError for a compression nobody knows (with a suggestion) or a level that it does not have.
/// Call before shading.
void check_exr_settings(const ExrSettings& settings);

/// Do both names lead to one existing file (through links, too)? Then writing `b` would destroy `a`. Never throws.
[[nodiscard]] bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) noexcept;

/// Writes to a temporary name in the same folder, forces it to the medium, checks that it reads back whole, renames; on
/// any failure (full disk included) the temporary is removed and RuntimeFailure names the file and the reason.
/// Returns how many values were too large for half and were stored as +-65504. Adds `software` unless given. The bytes
/// depend on the image and the settings only, not on the number of threads (OpenEXR's is set process-wide).
std::uint64_t write_exr(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings);

/// sRGB preview of channels R, G, B (and A; colours are divided by it): 8 bits, clamped, data window only. Temporary
/// and errors as for write_exr.
void write_png(const std::filesystem::path& file, const OutputImage& image);

/// Removes temporaries of files being written; async-signal-safe, for SIGINT and SIGTERM handlers.
void remove_temporaries() noexcept;

} // namespace clshade
