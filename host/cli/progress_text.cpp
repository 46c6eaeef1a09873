#include "host/cli/progress_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace clshade::cli {

namespace {

constexpr std::size_t few_frames = 8;   // make a rate
constexpr double window_seconds = 10.0; // at least, where frames are faster than that
constexpr double settled_seconds = 2.0; // of frames outweigh the start, which builds kernels
constexpr std::size_t most_cells = 30;
constexpr std::size_t fewest_cells = 10;

bool continues_character(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

std::size_t characters(std::string_view text) {
    return text.size() - static_cast<std::size_t>(std::count_if(text.begin(), text.end(), continues_character));
}

// What stands behind the bar: as many of the numbers as fit into `room`, and what is being done, cut.
std::string words_behind_bar(const ProgressState& state, std::size_t room) {
    const bool many_frames = state.total > 1 && state.frames && state.rate > 0.0;
    std::vector<std::string> words;
    if (state.total > 1) {
        words = {fmt::format("{}/{}", state.done, state.total), state.frames ? rate_text(state.rate) : "",
                 time_left_text(seconds_left(state))};
    }
    if (many_frames && !state.slowest.empty()) {
        words.push_back("slowest: " + state.slowest);
    }
    std::string text;
    for (const std::string& word : words) {
        if (!word.empty() && characters(text) + 2 + characters(word) > room) {
            return text;
        }
        text += word.empty() ? "" : "  " + word;
    }
    return many_frames || state.what.empty() ? text : one_line_of(text + "  " + state.what, room);
}

} // namespace

void FrameRate::frame(double now) {
    ++finished_;
    times_.push_back(now);
    // Frames in flight end in bursts, so the number of frames alone says nothing: what stays must span a time, too.
    while (times_.size() > few_frames + 1 && now - times_[1] >= (from_start_ ? settled_seconds : window_seconds)) {
        times_.pop_front();
        from_start_ = false;
    }
}

void FrameRate::restart(double now) {
    if (finished_ == 0) {
        times_.front() = now;
    }
}

double FrameRate::at(double now) const {
    const double span = times_.back() - times_.front();
    if (finished_ < 2 || span <= 0.0) {
        return 0.0;
    }
    const auto frames = static_cast<double>(times_.size() - 1);
    const double until_now = std::max(now - times_.front(), span);
    return std::min(frames / span, (frames + 1.0) / until_now); // at best, the next frame ends right now
}

int percent_of(double position, int total) {
    return static_cast<int>(std::clamp(100.0 * position / std::max(total, 1), 0.0, 100.0));
}

std::string rate_text(double rate) {
    if (rate <= 0.0) {
        return {};
    }
    constexpr double fast = 100.0;
    constexpr double slow = 1.0;
    constexpr double very_slow = 0.1;
    const int digits = rate >= fast ? 0 : rate >= slow ? 1 : rate >= very_slow ? 2 : 4;
    return fmt::format("{:.{}f} fps", rate, digits);
}

std::string time_left_text(double seconds) {
    constexpr double too_long = 1e9;
    if (!(seconds > 0.0) || seconds > too_long) {
        return {};
    }
    constexpr std::int64_t sixty = 60;
    const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
    const std::int64_t minutes = whole / sixty;
    if (minutes < sixty) {
        return fmt::format("{}:{:02} left", minutes, whole % sixty);
    }
    return fmt::format("{}:{:02}:{:02} left", minutes / sixty, minutes % sixty, whole % sixty);
}

double seconds_left(const ProgressState& state) {
    return state.rate > 0.0 ? std::max(state.total - state.done, 0) / state.rate : 0.0;
}

std::string progress_words(const ProgressState& state) {
    std::string words = fmt::format("{} of {} ({} %)", state.done, state.total, state.percent);
    const std::string left = time_left_text(seconds_left(state));
    if (state.frames && state.rate > 0.0) {
        words += ", " + rate_text(state.rate);
    }
    return left.empty() ? words : words + ", " + left;
}

std::string bar_line(const ProgressState& state, std::size_t width) {
    const std::string percent = fmt::format("] {:3} %", state.percent);
    const std::size_t least = 1 + fewest_cells + characters(percent);
    const std::string words = percent + words_behind_bar(state, width - std::min(width, least));
    const std::size_t beside = 1 + characters(words);
    const std::size_t cells = std::clamp(width - std::min(width, beside), fewest_cells, most_cells);
    const std::size_t full = cells * static_cast<std::size_t>(std::clamp(state.percent, 0, 100)) / 100;
    return one_line_of('[' + std::string(full, '#') + std::string(cells - full, '.') + words, width);
}

std::string one_line_of(std::string_view text, std::size_t width) {
    constexpr unsigned char first_printable = 0x20;
    constexpr unsigned char rub_out = 0x7F;
    std::string line;
    std::size_t columns = 0;
    for (const char c : text) {
        columns += continues_character(c) ? 0 : 1;
        if (columns > width) {
            break;
        }
        const auto byte = static_cast<unsigned char>(c);
        line += byte < first_printable || byte == rub_out ? '?' : c;
    }
    return line;
}

} // namespace clshade::cli
