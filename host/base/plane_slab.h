// Planes in memory: one float plane per component (structure of arrays), all planes in one allocation.
#pragma once

#include "host/base/aligned_buffer.h"

#include <cstddef>
#include <span>

namespace clshade {

/// Rows are padded to this many floats so that a group of 16 lanes never crosses a row and every row starts on a
/// 64-byte boundary.
inline constexpr int row_alignment = 16;
/// Planes are padded to a multiple of this many floats: 64 work-items of 16 lanes, one work-group.
inline constexpr int plane_alignment = 1024;
/// Extra floats between planes. Without it all planes of a picture whose size is a multiple of 4 KiB lie on the same
/// cache sets; a skew of one line beyond a multiple of 4 KiB spreads them.
inline constexpr int plane_skew = 16;

/// A set of equally sized float planes in one allocation. Padding is zero and stays zero.
/// Plane p, pixel (x, y) lies at data()[p * stride() + y * pitch() + x].
class PlaneSlab {
  public:
    PlaneSlab() = default;
    /// width, height in pixels (each at least 1), planes >= 0. Throws RuntimeFailure when memory is short.
    PlaneSlab(int width, int height, int planes);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int count() const { return count_; }
    /// Floats from one row to the next; a multiple of row_alignment.
    [[nodiscard]] int pitch() const { return pitch_; }
    /// Floats of a plane that the device works on (pitch * height rounded up to plane_alignment).
    [[nodiscard]] std::size_t padded_pixels() const { return padded_pixels_; }
    /// Floats from one plane to the next; a multiple of row_alignment.
    [[nodiscard]] std::size_t stride() const { return stride_; }

    [[nodiscard]] float* data() { return buffer_.data(); }
    [[nodiscard]] const float* data() const { return buffer_.data(); }
    [[nodiscard]] std::span<float> all() { return buffer_.span(); }
    [[nodiscard]] std::span<const float> all() const { return buffer_.span(); }
    [[nodiscard]] std::span<float> plane(int p) { return {data() + p * stride_, padded_pixels_}; }
    [[nodiscard]] std::span<const float> plane(int p) const { return {data() + p * stride_, padded_pixels_}; }
    [[nodiscard]] std::span<float> row(int p, int y) {
        return {data() + p * stride_ + static_cast<std::size_t>(y) * pitch_, static_cast<std::size_t>(width_)};
    }
    [[nodiscard]] std::span<const float> row(int p, int y) const {
        return {data() + p * stride_ + static_cast<std::size_t>(y) * pitch_, static_cast<std::size_t>(width_)};
    }
    [[nodiscard]] float& at(int p, int x, int y) { return row(p, y)[static_cast<std::size_t>(x)]; }
    [[nodiscard]] float at(int p, int x, int y) const { return row(p, y)[static_cast<std::size_t>(x)]; }

  private:
    int width_ = 0;
    int height_ = 0;
    int count_ = 0;
    int pitch_ = 0;
    std::size_t padded_pixels_ = 0;
    std::size_t stride_ = 0;
    AlignedBuffer buffer_;
};

} // namespace clshade
