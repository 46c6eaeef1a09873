// Private to host/images: a picture halved while its rows arrive.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace clshade {

/// Takes the rows of a lat-long picture from the top and halves them `halvings` times as `halved` does, holding no more
/// than the result and one row a halving.
class BandHalver {
  public:
    /// Size of the picture; both sides must be divisible by 2^halvings (std::invalid_argument).
    BandHalver(int width, int height, int halvings);

    /// The next rows, whole ones, 3 floats a texel.
    void push(std::span<const float> rows);

    /// The halved picture. Call after the last row.
    [[nodiscard]] std::vector<float> take() { return std::move(result_); }

  private:
    /// Of one size on the way: the upper row of a pair, waiting for the lower one.
    struct Stage {
        int width = 0;
        int height = 0;
        int pair = 0;
        bool waiting = false;
        std::vector<float> upper;
        std::vector<float> half; ///< what the pair becomes
    };

    void push_row(std::size_t stage, std::span<const float> row);

    std::vector<Stage> stages_;
    std::size_t row_floats_;
    std::vector<float> result_;
};

} // namespace clshade
