#include "host/base/plane_slab.h"

#include "host/base/error.h"

#include <fmt/format.h>

namespace clshade {

namespace {
std::size_t round_up(std::size_t value, std::size_t multiple) {
    return (value + multiple - 1) / multiple * multiple;
}
} // namespace

PlaneSlab::PlaneSlab(int width, int height, int planes) : width_(width), height_(height), count_(planes) {
    if (width < 1 || height < 1 || planes < 0) {
        throw RuntimeFailure(
            fmt::format("an image of {}x{} pixels with {} planes cannot be shaded", width, height, planes));
    }
    pitch_ = static_cast<int>(round_up(static_cast<std::size_t>(width), row_alignment));
    padded_pixels_ = round_up(static_cast<std::size_t>(pitch_) * static_cast<std::size_t>(height), plane_alignment);
    stride_ = padded_pixels_ + plane_skew;
    buffer_ = AlignedBuffer(stride_ * static_cast<std::size_t>(planes));
}

} // namespace clshade
