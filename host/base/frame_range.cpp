#include "host/base/frame_range.h"

#include "host/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <regex>
#include <set>

namespace clshade {

namespace {

constexpr std::size_t most_frames = 1'000'000;
constexpr int largest_frame = 1'000'000'000; // either way; leaves room for stepping past the end
const char* const frames_help = "write 7, 1-100, 1-100x2, or a list such as 1,5,10-20";

int to_int(const std::string& digits, std::string_view whole) {
    int value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value < -largest_frame ||
        value > largest_frame) {
        throw UsageError(fmt::format("--frames: '{}' in '{}' is out of range", digits, whole));
    }
    return value;
}

// Appends the frames of one entry that are not there yet.
void append_range(const std::string& entry, std::string_view whole, std::vector<int>& frames, std::set<int>& seen) {
    static const std::regex grammar(R"((-?[0-9]+)(?:-(-?[0-9]+)(?:x(-?[0-9]+))?)?)");
    std::smatch match;
    if (!std::regex_match(entry, match, grammar)) {
        throw UsageError(fmt::format("--frames: '{}' is not a frame range; {}", entry, frames_help));
    }
    const int first = to_int(match[1], whole);
    const int last = match[2].matched ? to_int(match[2], whole) : first;
    const int written_step = match[3].matched ? to_int(match[3], whole) : 1;
    if (written_step == 0) {
        throw UsageError(fmt::format("--frames: the step in '{}' is 0; {}", entry, frames_help));
    }
    const int step = last >= first ? std::abs(written_step) : -std::abs(written_step);
    for (int frame = first; step > 0 ? frame <= last : frame >= last; frame += step) {
        if (seen.insert(frame).second) {
            frames.push_back(frame);
        }
        if (frames.size() > most_frames) {
            throw UsageError(fmt::format("--frames: '{}' names more than {} frames", whole, most_frames));
        }
    }
}

} // namespace

std::vector<int> parse_frames(std::string_view text) {
    std::vector<int> frames;
    std::set<int> seen;
    std::string_view rest = text;
    while (true) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        append_range(std::string(rest.substr(0, comma)), text, frames, seen);
        if (comma == rest.size()) {
            return frames;
        }
        rest.remove_prefix(comma + 1);
    }
}

std::vector<int> chunk_of(std::span<const int> frames, int index, int count) {
    const auto bound = [&](int i) {
        return frames.size() * static_cast<std::size_t>(i) / static_cast<std::size_t>(count);
    };
    return {frames.begin() + static_cast<std::ptrdiff_t>(bound(index - 1)),
            frames.begin() + static_cast<std::ptrdiff_t>(bound(index))};
}

Chunk parse_chunk(std::string_view text) {
    static const std::regex grammar(R"(([0-9]{1,6})/([0-9]{1,6}))");
    std::match_results<std::string_view::const_iterator> match;
    Chunk chunk;
    if (std::regex_match(text.begin(), text.end(), match, grammar)) {
        chunk = {std::stoi(match[1].str()), std::stoi(match[2].str())};
        if (chunk.index >= 1 && chunk.index <= chunk.count) {
            return chunk;
        }
    }
    throw UsageError(fmt::format("--chunk: '{}' is not I/N with 1 <= I <= N, for example 2/8", text));
}

std::optional<SequencePath> SequencePath::parse(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored) ? std::nullopt : parse_pattern(path);
}

std::optional<SequencePath> SequencePath::parse_pattern(const std::string& path) {
    static const std::regex place(R"(#+|%(0[1-9])?d)");
    std::smatch match;
    if (!std::regex_search(path, match, place)) {
        return std::nullopt;
    }
    const std::string suffix = match.suffix();
    if (std::regex_search(suffix, place)) {
        throw UsageError(fmt::format("{}: two places for the frame number; keep one # or %04d", path));
    }
    const std::string sign = match[0];
    int digits = 1;
    if (sign.front() == '#') {
        digits = sign.size() == 1 ? 4 : static_cast<int>(sign.size());
    } else if (match[1].matched) {
        digits = sign[2] - '0';
    }
    return SequencePath(match.prefix(), digits, suffix);
}

std::filesystem::path SequencePath::at(int frame) const {
    // As printf does it: the sign counts as one of the digits.
    return fmt::format("{}{:0{}d}{}", prefix_, frame, digits_, suffix_);
}

std::vector<int> SequencePath::existing() const {
    const std::string pattern = fmt::format("{}#{}", prefix_, suffix_);
    if (suffix_.find('/') != std::string::npos) {
        throw UsageError(
            fmt::format("{}: the frame number stands in a folder's name; name the frames with --frames", pattern));
    }
    const std::filesystem::path prefix(prefix_);
    const std::filesystem::path folder = prefix.has_parent_path() ? prefix.parent_path() : ".";
    const std::string head = prefix.filename().string();
    std::vector<int> frames;
    std::error_code error;
    for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        const std::string name = it->path().filename().string();
        if (name.size() <= head.size() + suffix_.size() || !name.starts_with(head) || !name.ends_with(suffix_)) {
            continue;
        }
        const std::string number = name.substr(head.size(), name.size() - head.size() - suffix_.size());
        int frame = 0;
        const auto [last, bad] = std::from_chars(number.data(), number.data() + number.size(), frame);
        // Only names that this pattern would itself produce: "7" is not frame 7 of "####".
        if (bad == std::errc() && last == number.data() + number.size() && at(frame).filename() == name) {
            frames.push_back(frame);
        }
    }
    if (error) {
        throw RuntimeFailure(fmt::format("{}: cannot list the folder: {}", folder.string(), error.message()));
    }
    if (frames.empty()) {
        throw RuntimeFailure(
            fmt::format("{}: no file on disk fits; check the path or name the frames with --frames", pattern));
    }
    std::sort(frames.begin(), frames.end());
    return frames;
}

} // namespace clshade
