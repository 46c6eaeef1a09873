#include "host/images/completion.h"

#include "host/images/stamp.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>
#include <optional>
#include <string_view>
#include <vector>

namespace clshade {

namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 20U;
constexpr std::string_view png_signature("\x89PNG\r\n\x1a\n", 8);

/// A regular file, open for reading.
class OpenFile {
  public:
    explicit OpenFile(const std::filesystem::path& file)
        : descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) { // a pipe must not make us wait
        struct stat status {};
        if (descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
            size_ = static_cast<std::uint64_t>(status.st_size);
        }
    }
    ~OpenFile() {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
        }
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    OpenFile(OpenFile&&) = delete;
    OpenFile& operator=(OpenFile&&) = delete;

    /// 0 for what is no file.
    [[nodiscard]] std::uint64_t size() const { return size_; }

    /// False unless all bytes could be read.
    [[nodiscard]] bool read(std::uint64_t offset, std::span<std::byte> bytes) const {
        while (!bytes.empty()) {
            const ssize_t got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
            if (got < 0 && errno == EINTR) {
                continue;
            }
            if (got <= 0) {
                return false;
            }
            offset += static_cast<std::uint64_t>(got);
            bytes = bytes.subspan(static_cast<std::size_t>(got));
        }
        return true;
    }

  private:
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

/// Bytes that are hashed as another value.
struct Blank {
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
    std::byte value{};
};

struct Found {
    Stamp stamp;
    std::string job;
    std::array<Blank, 2> blanks;
};

class StampReader {
  public:
    explicit StampReader(const std::filesystem::path& file) : file_(file) {}

    std::optional<CompletionStamp> read() {
        if (file_.size() == 0) {
            return std::nullopt;
        }
        buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(file_.size(), piece_bytes)));
        if (!file_.read(0, buffer_)) {
            return std::nullopt;
        }
        const std::string_view start(reinterpret_cast<const char*>(buffer_.data()), buffer_.size());
        const bool png = start.starts_with(png_signature);
        std::optional<Found> found = png ? find_in_png() : find_in_exr();
        if (!found || found->stamp.bytes != file_.size() || found->stamp.head > file_.size() || !hash_fits(*found)) {
            return std::nullopt;
        }
        return CompletionStamp{found->stamp.bytes, found->stamp.hash, png ? job_of_png() : found->job};
    }

  private:
    [[nodiscard]] std::optional<Found> find_in_exr() const {
        const auto place = find_exr_stamp(buffer_);
        if (!place) {
            return std::nullopt;
        }
        const std::string_view text(reinterpret_cast<const char*>(buffer_.data()) + place->offset, stamp_length);
        const auto stamp = parse_stamp(text);
        if (!stamp) {
            return std::nullopt;
        }
        const Blank digits{place->offset + stamp_length - stamp_hash_digits, stamp_hash_digits, std::byte{'0'}};
        return Found{*stamp, place->job, {digits, Blank{}}};
    }

    /// The stamp's chunk and the end of the file stand where write_png puts them, or nowhere.
    [[nodiscard]] std::optional<Found> find_in_png() const {
        std::array<std::byte, PngStampPlace::chunk> tail{};
        if (file_.size() < tail.size() || !file_.read(file_.size() - tail.size(), tail)) {
            return std::nullopt;
        }
        const std::string_view all(reinterpret_cast<const char*>(tail.data()), tail.size());
        const std::string_view text = all.substr(PngStampPlace::chunk - PngStampPlace::text, stamp_length);
        const auto stamp = parse_stamp(text);
        if (!stamp || !all.starts_with(png_text_chunk(completion_attribute, text))) {
            return std::nullopt;
        }
        return Found{*stamp,
                     "",
                     {Blank{file_.size() - PngStampPlace::text + stamp_length - stamp_hash_digits, stamp_hash_digits,
                            std::byte{'0'}},
                      Blank{file_.size() - PngStampPlace::crc, 4, std::byte{0}}}};
    }

    bool hash_fits(const Found& found) {
        StreamHash hash;
        return add_range(hash, found, found.stamp.head, file_.size()) && add_range(hash, found, 0, found.stamp.head) &&
               hash.value() == found.stamp.hash;
    }

    bool add_range(StreamHash& hash, const Found& found, std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t at = begin; at < end;) {
            const std::span<std::byte> piece =
                std::span(buffer_).first(static_cast<std::size_t>(std::min<std::uint64_t>(end - at, buffer_.size())));
            if (!file_.read(at, piece)) {
                return false;
            }
            for (const Blank& blank : found.blanks) {
                const std::uint64_t from = std::clamp(blank.offset, at, at + piece.size());
                const std::uint64_t to = std::clamp(blank.offset + blank.length, at, at + piece.size());
                std::fill(piece.begin() + static_cast<std::ptrdiff_t>(from - at),
                          piece.begin() + static_cast<std::ptrdiff_t>(to - at), blank.value);
            }
            hash.add(piece);
            at += piece.size();
        }
        return true;
    }

    [[nodiscard]] bool starts_with(std::uint64_t offset, std::string_view wanted) {
        const std::span<std::byte> bytes = std::span(buffer_).first(wanted.size());
        return file_.read(offset, bytes) && std::ranges::equal(bytes, std::as_bytes(std::span(wanted)));
    }

    /// Of a file whose hash fits, so that its chunks are in order.
    [[nodiscard]] std::string job_of_png() {
        const std::string wanted = std::string("tEXt") + job_attribute + '\0';
        for (std::uint64_t at = png_signature.size(); at + 12 <= file_.size();) {
            std::array<unsigned char, 4> length{};
            if (!file_.read(at, std::as_writable_bytes(std::span(length)))) {
                break;
            }
            const std::uint64_t bytes = std::uint64_t{length[0]} << 24U | std::uint64_t{length[1]} << 16U |
                                        std::uint64_t{length[2]} << 8U | std::uint64_t{length[3]};
            const std::uint64_t named = bytes + 4; // with the chunk's name
            if (named >= wanted.size() && named <= buffer_.size() && starts_with(at + 4, wanted)) {
                std::string text(static_cast<std::size_t>(named) - wanted.size(), '\0');
                if (file_.read(at + 4 + wanted.size(), std::as_writable_bytes(std::span(text)))) {
                    return text;
                }
            }
            at += named + 8;
        }
        return "";
    }

    OpenFile file_;
    std::vector<std::byte> buffer_;
};

} // namespace

std::optional<CompletionStamp> read_completion_stamp(const std::filesystem::path& file) noexcept {
    try {
        return StampReader(file).read();
    } catch (const std::exception&) { // no memory: better to shade the frame once more
        return std::nullopt;
    }
}

} // namespace clshade
