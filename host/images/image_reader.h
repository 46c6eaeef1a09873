// Image files in: headers into ImageLayout, needed channels straight into planes. The only place that knows formats.
#pragma once

#include "host/gbuffer/frame_builder.h"
#include "host/gbuffer/image_layout.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace clshade {

/// Reads the header of an EXR file, and the Cryptomatte manifests beside it that it names. Costs no memory in
/// proportion to what the header claims. Throws RuntimeFailure: missing, empty, not an EXR, truncated, deep, subsampled
/// chroma, claims more than it holds.
[[nodiscard]] ImageLayout read_layout(const std::filesystem::path& file);

/// Decodes plan.channels into plan.frame.planes (half and uint widened to float), nothing else. threads >= 1.
/// Throws RuntimeFailure naming the file, part and channel when the pixel data is broken or incomplete.
void read_planes(const std::filesystem::path& file, const ImageLayout& layout, FramePlan& plan, int threads);

/// The planes of one file, whole or in bands of rows. Opened once, not shared between threads; work is spread over the
/// TBB arena of the caller, within `isolate`, so that a thread that waits takes up no foreign work.
class PlaneReader {
  public:
    /// `channels` are indices into layout.channels, `window` the picture's (rows and columns that a part does not cover
    /// become 0). Throws RuntimeFailure as read_planes does, also for a file that is no longer what `layout` says.
    PlaneReader(const std::filesystem::path& file, const ImageLayout& layout, std::span<const int> channels,
                const Window& window);
    ~PlaneReader();
    PlaneReader(PlaneReader&&) noexcept;
    PlaneReader& operator=(PlaneReader&&) noexcept;
    PlaneReader(const PlaneReader&) = delete;
    PlaneReader& operator=(const PlaneReader&) = delete;

    /// Decodes rows [first_row, first_row + planes.height()) of the window: plane i takes channels[i], half and uint
    /// widened to float. What stood in the planes before does not matter; padding is not touched. Throws
    /// RuntimeFailure naming file, part and what is damaged.
    void read(int first_row, PlaneSlab& planes);
    /// Bands that begin at multiples of this row decode no chunk twice (1 to 256; tiles: their height).
    [[nodiscard]] int band_rows() const;
    /// Bytes taken from the file so far.
    [[nodiscard]] std::uint64_t bytes_read() const;
    /// Time that threads spent in read(), summed over them, in milliseconds.
    [[nodiscard]] double busy_milliseconds() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace clshade
