// What progress says: numbers and words without terminal, clock or threads.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>

namespace clshade::cli {

/// Frames per second over the last 10 to 20 seconds. Frames slower than that are counted over the last eight, and until
/// there are enough, since the start. Times are in seconds of any one clock.
class FrameRate {
  public:
    explicit FrameRate(double start) : times_{start} {}
    /// A frame is finished.
    void frame(double now);
    /// Time went by without frames to shade: only what follows counts. Without effect once a frame was finished.
    void restart(double now);
    /// 0 before two frames are finished. Falls while a frame takes longer than those before.
    [[nodiscard]] double at(double now) const;

  private:
    std::deque<double> times_; ///< the beginning of what is counted, and of every frame since then its end
    bool from_start_ = true;   ///< the first is the start, not the end of a frame
    int finished_ = 0;
};

/// How far a job is.
struct ProgressState {
    int done = 0;
    int total = 1;
    int percent = 0;
    double rate = 0.0;   ///< steps per second; 0: not known
    bool frames = true;  ///< the steps are frames
    std::string what;    ///< is being done
    std::string slowest; ///< stage; empty: not known
};

/// Whole percent of `total` that `position` steps are, rounded down: 0 to 100.
[[nodiscard]] int percent_of(double position, int total);
/// "8.3 fps"; empty for a rate that is not known.
[[nodiscard]] std::string rate_text(double rate);
/// "0:38 left", "1:02:03 left", rounded up to seconds; empty unless `seconds` is positive and finite.
[[nodiscard]] std::string time_left_text(double seconds);
/// Seconds that the steps to come will take; 0 if not known.
[[nodiscard]] double seconds_left(const ProgressState& state);
/// "185 of 500 (37 %), 8.3 fps, 0:38 left", as far as it is known.
[[nodiscard]] std::string progress_words(const ProgressState& state);
/// "[####......]  37 %  185/500  8.3 fps  0:38 left  slowest: write", or what is being done where there is one step
/// only or no rate yet. At most `width` characters of UTF-8: the bar gets shorter first, then the numbers at the
/// end are left out, what is being done is cut.
[[nodiscard]] std::string bar_line(const ProgressState& state, std::size_t width);
/// The first `width` characters of UTF-8 text, with '?' for control characters.
[[nodiscard]] std::string one_line_of(std::string_view text, std::size_t width);

} // namespace clshade::cli
