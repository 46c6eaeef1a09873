#include "tests/images/fixtures.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfThreading.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>
#include <gtest/gtest.h>
#include <half.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace clshade::testing {

namespace {

/// A channel's samples over a window, in the channel's own type.
struct Samples {
    std::vector<char> bytes;
    Imf::Slice slice;
};

template <typename Sample>
void fill(Samples& samples, const Window& window, int number, Imf::PixelType type) {
    const auto width = static_cast<std::size_t>(window.width());
    samples.bytes.resize(width * static_cast<std::size_t>(window.height()) * sizeof(Sample));
    auto* out = reinterpret_cast<Sample*>(samples.bytes.data());
    for (int y = window.y_min; y <= window.y_max; ++y) {
        for (int x = window.x_min; x <= window.x_max; ++x) {
            *out++ = static_cast<Sample>(pattern(number, x, y));
        }
    }
    samples.slice = Imf::Slice::Make(type, samples.bytes.data(), Imath::V2i(window.x_min, window.y_min), window.width(),
                                     window.height(), sizeof(Sample));
}

Samples samples_of(const PartChannel& channel, const Window& window) {
    Samples samples;
    switch (channel.type) {
    case Imf::HALF:
        fill<half>(samples, window, channel.number, channel.type);
        break;
    case Imf::UINT:
        fill<unsigned>(samples, window, channel.number, channel.type);
        break;
    default:
        fill<float>(samples, window, channel.number, channel.type);
        break;
    }
    return samples;
}

template <typename Output>
void write_levels(Output& output, const std::vector<PartChannel>& channels) {
    for (int level_y = 0; level_y < output.numYLevels(); ++level_y) {
        for (int level_x = 0; level_x < output.numXLevels(); ++level_x) {
            if (!output.isValidLevel(level_x, level_y)) {
                continue;
            }
            const Imath::Box2i box = output.dataWindowForLevel(level_x, level_y);
            const Window window{box.min.x, box.min.y, box.max.x, box.max.y};
            // Further levels hold other values, so that reading the wrong one is seen.
            const int shift = level_x + level_y > 0 ? 50 : 0;
            std::vector<Samples> samples;
            Imf::FrameBuffer buffer;
            for (const PartChannel& channel : channels) {
                PartChannel shifted = channel;
                shifted.number += shift;
                samples.push_back(samples_of(shifted, window));
                buffer.insert(channel.name, samples.back().slice);
            }
            output.setFrameBuffer(buffer);
            output.writeTiles(0, output.numXTiles(level_x) - 1, 0, output.numYTiles(level_y) - 1, level_x, level_y);
        }
    }
}

template <typename Output>
void write_lines(Output& output, const std::vector<PartChannel>& channels, const Window& window) {
    std::vector<Samples> samples;
    Imf::FrameBuffer buffer;
    for (const PartChannel& channel : channels) {
        samples.push_back(samples_of(channel, window));
        buffer.insert(channel.name, samples.back().slice);
    }
    output.setFrameBuffer(buffer);
    output.writePixels(window.height());
}

Window data_window_of(const Imf::Header& header) {
    const Imath::Box2i& box = header.dataWindow();
    return {box.min.x, box.min.y, box.max.x, box.max.y};
}

} // namespace

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "clshade-images-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error("no temporary folder");
    }
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
        found.push_back(entry.path().filename().string());
    }
    std::sort(found.begin(), found.end());
    return found;
}

float pattern(int channel, int x, int y) {
    // Whole numbers up to 2048 are exact in half; x and y may be negative.
    const int mixed = (x * 7 + y * 31 + channel * 113) % 2048;
    return static_cast<float>(mixed < 0 ? mixed + 2048 : mixed);
}

Part make_part(const Window& data_window, const std::vector<PartChannel>& channels, Imf::Compression compression,
               const std::string& name, const std::string& view) {
    Part part{Imf::Header(Imath::Box2i({0, 0}, {63, 47}),
                          Imath::Box2i({data_window.x_min, data_window.y_min}, {data_window.x_max, data_window.y_max})),
              channels};
    part.header.compression() = compression;
    part.header.setType(Imf::SCANLINEIMAGE);
    if (!name.empty()) {
        part.header.setName(name);
    }
    if (!view.empty()) {
        part.header.setView(view);
    }
    for (const PartChannel& channel : channels) {
        part.header.channels().insert(channel.name, Imf::Channel(channel.type));
    }
    return part;
}

void tile(Part& part, int width, int height, Imf::LevelMode mode, Imf::LineOrder order) {
    part.header.setType(Imf::TILEDIMAGE);
    part.header.setTileDescription(
        Imf::TileDescription(static_cast<unsigned>(width), static_cast<unsigned>(height), mode));
    part.header.lineOrder() = order;
}

void write_parts(const std::filesystem::path& file, std::vector<Part> parts) {
    if (parts.size() == 1) {
        const Part& part = parts[0];
        if (part.header.type() == Imf::TILEDIMAGE) {
            Imf::TiledOutputFile output(file.c_str(), part.header);
            write_levels(output, part.channels);
        } else {
            Imf::OutputFile output(file.c_str(), part.header);
            write_lines(output, part.channels, data_window_of(part.header));
        }
        return;
    }
    std::vector<Imf::Header> headers;
    headers.reserve(parts.size());
    for (const Part& part : parts) {
        headers.push_back(part.header);
    }
    Imf::MultiPartOutputFile output(file.c_str(), headers.data(), static_cast<int>(headers.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].header.type() == Imf::TILEDIMAGE) {
            Imf::TiledOutputPart part(output, static_cast<int>(i));
            write_levels(part, parts[i].channels);
        } else {
            Imf::OutputPart part(output, static_cast<int>(i));
            write_lines(part, parts[i].channels, data_window_of(parts[i].header));
        }
    }
}

float Picture::at(int channel, int x, int y) const {
    return plan.frame.planes.at(channel, x - plan.frame.data_window.x_min, y - plan.frame.data_window.y_min);
}

Picture read_picture(const std::filesystem::path& file, int threads, const std::vector<std::string>& names) {
    Picture picture;
    picture.layout = read_layout(file);
    if (names.empty()) {
        for (std::size_t i = 0; i < picture.layout.channels.size(); ++i) {
            picture.plan.channels.push_back(static_cast<int>(i));
        }
    }
    for (const std::string& name : names) {
        picture.plan.channels.push_back(index_of(picture.layout, name));
    }
    Window window = picture.layout.parts[0].data_window;
    for (const PartInfo& part : picture.layout.parts) {
        window = {std::min(window.x_min, part.data_window.x_min), std::min(window.y_min, part.data_window.y_min),
                  std::max(window.x_max, part.data_window.x_max), std::max(window.y_max, part.data_window.y_max)};
    }
    picture.plan.frame.data_window = window;
    picture.plan.frame.planes =
        PlaneSlab(window.width(), window.height(), static_cast<int>(picture.plan.channels.size()));
    read_planes(file, picture.layout, picture.plan, threads);
    return picture;
}

int index_of(const ImageLayout& layout, const std::string& name) {
    const auto found = std::find_if(layout.channels.begin(), layout.channels.end(),
                                    [&](const ChannelInfo& channel) { return channel.name == name; });
    if (found == layout.channels.end()) {
        throw std::runtime_error("no channel " + name);
    }
    return static_cast<int>(found - layout.channels.begin());
}

std::string bytes_of_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return bytes.str();
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::filesystem::remove(file); // some file systems force data to the medium when an old file is overwritten
    std::ofstream stream(file, std::ios::binary);
    stream << bytes;
}

std::string failure_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const RuntimeFailure& failure) {
        return failure.what();
    } catch (const std::exception& other) {
        ADD_FAILURE() << "another exception: " << other.what();
        return "";
    }
    ADD_FAILURE() << "no exception";
    return "";
}

int in_child(const std::function<int()>& action) {
    // A child has none of the parent's threads, but whatever they had locked. So TBB's go first, and those of OpenEXR,
    // which OpenImageIO starts; TBB starts them anew.
    Imf::setGlobalThreadCount(0);
    tbb::task_scheduler_handle threads{tbb::attach{}};
    EXPECT_TRUE(tbb::finalize(threads, std::nothrow));
    const pid_t child = ::fork();
    if (child == 0) {
        int result = 99;
        try {
            result = action();
        } catch (...) {
            result = 99;
        }
        ::_exit(result);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? 100 + WTERMSIG(status) : WEXITSTATUS(status);
}

int as_common_user(const std::function<int()>& action) {
    return in_child([&] {
        constexpr uid_t nobody = 65534;
        if (::geteuid() == 0 && ::setuid(nobody) != 0) {
            return 98;
        }
        return action();
    });
}

} // namespace clshade::testing
