// Frame numbers and file sequences: 1-100x2, lists, #, ####, %04d, chunks.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// Expands "1-100x2", "5", "10-1", "-5--1" and comma-separated lists of these, in the order written, each frame once.
/// A range runs downwards when its end lies below its start. Throws UsageError for anything else, a step of 0, or
/// more than a million frames.
[[nodiscard]] std::vector<int> parse_frames(std::string_view text);

/// Part `index` (1-based) of `count` of the frames: neighbours stay together, sizes differ by one at most, and every
/// frame is in exactly one part.
[[nodiscard]] std::vector<int> chunk_of(std::span<const int> frames, int index, int count);

struct Chunk {
    int index = 1;
    int count = 1;
};
/// "I/N" with 1 <= I <= N. Throws UsageError.
[[nodiscard]] Chunk parse_chunk(std::string_view text);

/// A path with one place for the frame number.
class SequencePath {
  public:
    /// Finds `#` (four digits), `##...` (as many digits as signs), `%04d` or `%d` in the file's name or its folders.
    /// Empty if there is none, or if a file of exactly this name exists. Throws UsageError for two such places.
    [[nodiscard]] static std::optional<SequencePath> parse(const std::string& path);
    /// The same whatever files there are.
    [[nodiscard]] static std::optional<SequencePath> parse_pattern(const std::string& path);

    [[nodiscard]] std::filesystem::path at(int frame) const;
    /// Numbers of the files on disk, ascending. Throws UsageError if the place lies in a folder's name, RuntimeFailure
    /// if the folder cannot be read or holds no such file.
    [[nodiscard]] std::vector<int> existing() const;

  private:
    SequencePath(std::string prefix, int digits, std::string suffix)
        : prefix_(std::move(prefix)), digits_(digits), suffix_(std::move(suffix)) {}

    std::string prefix_;
    int digits_ = 4; ///< at least this many, zero-padded
    std::string suffix_;
};

} // namespace clshade
