// Folders, pictures and files that the tests of host/images share.
#pragma once

#include "host/base/error.h"
#include "host/images/image_reader.h"
#include "host/images/image_writer.h"

#include <ImfHeader.h>
#include <ImfPixelType.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace clshade::testing {

/// A fresh folder, removed at the end.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    TemporaryFolder(TemporaryFolder&&) = delete;
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Names of the files in it, sorted.
    [[nodiscard]] std::vector<std::string> names() const;

  private:
    std::filesystem::path path_;
};

/// Value of sample `channel` at pixel (x, y) of the file's coordinates; exact in half and in unsigned integers.
[[nodiscard]] float pattern(int channel, int x, int y);

/// One channel for make_part.
struct PartChannel {
    std::string name;
    Imf::PixelType type = Imf::FLOAT;
    int number = 0; ///< which pattern()
};

/// A part for write_parts: a header with channels and type set, and its channels.
struct Part {
    Imf::Header header;
    std::vector<PartChannel> channels;
};

[[nodiscard]] Part make_part(const Window& data_window, const std::vector<PartChannel>& channels,
                             Imf::Compression compression = Imf::ZIP_COMPRESSION, const std::string& name = "",
                             const std::string& view = "");
/// Makes it a tiled part.
void tile(Part& part, int width, int height, Imf::LevelMode mode = Imf::ONE_LEVEL,
          Imf::LineOrder order = Imf::INCREASING_Y);

/// Writes the parts with the OpenEXR library, every pixel as pattern() says.
void write_parts(const std::filesystem::path& file, std::vector<Part> parts);

/// Reads all channels, or those named, of a file.
struct Picture {
    ImageLayout layout;
    FramePlan plan;
    [[nodiscard]] float at(int channel, int x, int y) const; ///< in the file's coordinates
};
[[nodiscard]] Picture read_picture(const std::filesystem::path& file, int threads = 1,
                                   const std::vector<std::string>& names = {});
[[nodiscard]] int index_of(const ImageLayout& layout, const std::string& name);

[[nodiscard]] std::string bytes_of_file(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

/// The message of the RuntimeFailure that `action` throws; fails the test if it throws nothing or anything else.
[[nodiscard]] std::string failure_of(const std::function<void()>& action);

/// Runs `action` in a child process; its return value, or 99 for an exception, or 100 + the signal that ended it.
[[nodiscard]] int in_child(const std::function<int()>& action);
/// The same without the superuser's powers, should the tests have them.
[[nodiscard]] int as_common_user(const std::function<int()>& action);

} // namespace clshade::testing
