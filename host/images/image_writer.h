// Image files out: EXR with attributes, or a display-referred PNG preview; never half-written.
#pragma once

#include "host/base/plane_slab.h"
#include "host/gbuffer/image_layout.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace clshade {

struct ExrSettings {
    bool half = true;                ///< -d half|float
    std::string compression = "zip"; ///< none rle zips zip piz pxr24 b44 b44a dwaa dwab
    /// zip, zips: libdeflate's 1 (quick) to 9 (small), 4 if absent. dwaa, dwab: lossiness, 45 if absent.
    std::optional<double> level;
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

/// Rows of a block of this compression: 1 to 256. Bands of rows that are written one after the other are multiples of
/// it.
[[nodiscard]] int block_rows(const ExrSettings& settings);

/// Do both names lead to one existing file (through links, too)? Then writing `b` would destroy `a`. Never throws.
[[nodiscard]] bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) noexcept;

/// What became of a file.
struct WrittenFile {
    std::uint64_t clamped = 0;      ///< values too large for half, stored as +-65504
    std::uint64_t bytes = 0;        ///< of the file
    std::uint64_t hash = 0;         ///< as in its completion stamp (completion.h)
    double busy_milliseconds = 0.0; ///< summed over the threads that worked at it
    bool existed = false;           ///< Replace::no and somebody else was there first: nothing was written
};

/// With `no` a file that has the target's name by then stays, whoever made it: the check and the renaming are one step.
enum class Replace { yes, no };

/// Writes to a temporary name in the same folder, forces it to the medium, checks that it reads back whole, renames; on
/// any failure (full disk included) the temporary is removed and RuntimeFailure names the file and the reason. Adds
/// `software` unless given, and the completion stamp (completion.h). The bytes depend on the image and the settings
/// only; work is spread over the TBB arena of the caller, within `isolate`. Several threads may write files at once.
WrittenFile write_exr(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings,
                      Replace replace = Replace::yes);

/// sRGB preview of channels R, G, B (and A; colours are divided by it): 8 bits, clamped, data window only. Carries the
/// job attribute and the completion stamp as text. Temporary and errors as for write_exr.
WrittenFile write_png(const std::filesystem::path& file, const OutputImage& image, Replace replace = Replace::yes);

/// An EXR file written in bands of rows, from the top to the bottom. The bytes depend on picture and settings only, not
/// on bands or threads; work is spread over the TBB arena of the caller, within `isolate`. Never half-written: see
/// write_exr.
class ExrWriter {
  public:
    /// Makes the temporary and the header. Channels of `image` need no slab here. Throws like write_exr.
    ExrWriter(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings,
              Replace replace = Replace::yes);
    ~ExrWriter();
    ExrWriter(ExrWriter&&) noexcept;
    ExrWriter& operator=(ExrWriter&&) noexcept;
    ExrWriter(const ExrWriter&) = delete;
    ExrWriter& operator=(const ExrWriter&) = delete;

    /// The picture's next `rows` rows: rows [first, first + rows) of the slabs in `channels`, which are those of the
    /// constructor in the same order, now with slabs. All bands but the last have a multiple of band_rows() rows.
    void write(std::span<const OutputChannel> channels, int first, int rows);
    /// Rows of a block of the compression.
    [[nodiscard]] int band_rows() const;
    /// When all rows are written: stamps the file, forces it to the medium, checks it, renames it.
    [[nodiscard]] WrittenFile commit();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Removes temporaries of these files that a killed process left behind; those of living processes are locked and stay
/// (a file system shared between machines must share locks, too). Never throws.
void remove_stale_temporaries(std::span<const std::filesystem::path> targets) noexcept;

/// Removes temporaries of files being written; async-signal-safe, for SIGINT and SIGTERM handlers.
void remove_temporaries() noexcept;

} // namespace clshade
