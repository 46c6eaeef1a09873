// A picture that is too large for the memory there is: read in bands of rows.
#pragma once

#include "host/batch/frame_input.h"
#include "host/images/image_reader.h"

#include <cstdint>

namespace clshade {

class BandedInput {
  public:
    /// Finishes the frame; where the camera has to be recovered, in passes over the file, whose bands take about
    /// `memory` bytes. `block`: bands have a multiple of so many rows (those of the output's compression). Throws like
    /// load_frame.
    BandedInput(PlannedInput input, std::uint64_t memory, int block);

    /// The frame without planes; once.
    [[nodiscard]] LoadedFrame take() { return std::move(loaded_); }
    /// Fills frame.planes with `rows` rows from `first_row` on. Throws like PlaneReader.
    void read(Frame& frame, int first_row, int rows);

    /// Rows of the smallest band that decodes no chunk in vain.
    [[nodiscard]] int smallest_band() const { return step_; }
    /// Rows of the largest band that takes no more than `memory` bytes with so many output planes; never less than the
    /// smallest.
    [[nodiscard]] int largest_band(std::uint64_t memory, int outputs) const;

    [[nodiscard]] std::uint64_t bytes_read() const { return reader_.bytes_read() + camera_bytes_; }
    [[nodiscard]] double busy_milliseconds() const { return reader_.busy_milliseconds(); }

  private:
    [[nodiscard]] Frame finish(PlannedInput& input, std::uint64_t memory);

    PlaneReader reader_;
    LoadedFrame loaded_;
    int planes_ = 0;
    int kept_ = 0;
    int step_ = 1;
    std::uint64_t chunk_bytes_ = 0; ///< of one row of blocks, all channels, unpacked
    std::uint64_t camera_bytes_ = 0;
};

} // namespace clshade
