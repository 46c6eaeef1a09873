// EXRs written in bands: the same bytes whatever the bands and threads, and other programs' pixels.
#include "host/images/chunk_encoder.h"
#include "host/images/unpack.h"
#include "tests/images/fixtures.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <half.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <thread>

namespace clshade {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::array<const char*, 10> compressions{"none",  "rle", "zips", "zip",  "piz",
                                                   "pxr24", "b44", "b44a", "dwaa", "dwab"};
const std::vector<std::string> names{"R", "A", "layer.Z", "G", "B"}; // not in the order of the file

/// Smooth pictures with noise in the last plane, which does not shrink.
PlaneSlab example(int width, int height) {
    PlaneSlab slab(width, height, static_cast<int>(names.size()));
    std::mt19937 random(5);
    std::uniform_real_distribution<float> noise(0.0F, 1000.0F);
    for (int plane = 0; plane < slab.count(); ++plane) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const float smooth = 0.6F + 0.4F * std::sin(0.05F * static_cast<float>(x * (plane + 1) + y));
                slab.at(plane, x, y) = plane == 4 ? noise(random) : (y / 8 % 2 == 0 ? smooth : 0.25F);
            }
        }
    }
    return slab;
}

OutputImage image_of(const PlaneSlab& slab, int left = 0, int top = 0) {
    OutputImage image;
    image.data_window = {left, top, left + slab.width() - 1, top + slab.height() - 1};
    image.display_window = {0, 0, 99, 99};
    for (std::size_t i = 0; i < names.size(); ++i) {
        image.channels.push_back({names[i], &slab, static_cast<int>(i), names[i] == "layer.Z"});
    }
    return image;
}

Imf::Compression imf_compression(const std::string& name) {
    const auto found = std::find(compressions.begin(), compressions.end(), name);
    constexpr std::array<Imf::Compression, 10> all{Imf::NO_COMPRESSION,  Imf::RLE_COMPRESSION,  Imf::ZIPS_COMPRESSION,
                                                   Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,  Imf::PXR24_COMPRESSION,
                                                   Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION,
                                                   Imf::DWAB_COMPRESSION};
    return all.at(static_cast<std::size_t>(found - compressions.begin()));
}

/// The same picture by OpenEXR's own OutputFile, with our header's stamp copied so that only pixels can differ.
void write_with_library(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings,
                        const std::filesystem::path& ours) {
    const Window& window = image.data_window;
    const auto width = static_cast<std::size_t>(window.width());
    Imf::Header header({{0, 0}, {99, 99}}, {{window.x_min, window.y_min}, {window.x_max, window.y_max}}, 1.0F,
                       {0.0F, 0.0F}, 1.0F, Imf::INCREASING_Y, imf_compression(settings.compression));
    header.insert("software", Imf::StringAttribute("clshade"));
    const Imf::InputFile stamped(ours.c_str());
    header.insert("clshade/complete", *stamped.header().findTypedAttribute<Imf::StringAttribute>("clshade/complete"));
    if (settings.level) {
        header.dwaCompressionLevel() = static_cast<float>(*settings.level);
    }
    Imf::FrameBuffer buffer;
    std::vector<std::vector<half>> halves(image.channels.size());
    std::vector<std::vector<float>> floats(image.channels.size());
    for (std::size_t i = 0; i < image.channels.size(); ++i) {
        const OutputChannel& channel = image.channels[i];
        const bool as_half = settings.half && !channel.force_float;
        header.channels().insert(channel.name, Imf::Channel(as_half ? Imf::HALF : Imf::FLOAT));
        for (int y = 0; y < window.height(); ++y) {
            for (const float value : channel.slab->row(channel.plane, y)) {
                halves[i].emplace_back(value);
                floats[i].push_back(value);
            }
        }
        const std::ptrdiff_t skipped = window.x_min + static_cast<std::ptrdiff_t>(width) * window.y_min;
        if (as_half) {
            buffer.insert(channel.name,
                          Imf::Slice(Imf::HALF, reinterpret_cast<char*>(halves[i].data() - skipped), 2, 2 * width));
        } else {
            buffer.insert(channel.name,
                          Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(floats[i].data() - skipped), 4, 4 * width));
        }
    }
    Imf::OutputFile output(file.c_str(), header, 0);
    output.setFrameBuffer(buffer);
    output.writePixels(window.height());
}

/// One channel by OpenEXR's own InputFile.
std::vector<float> read_with_library(const std::filesystem::path& file, const std::string& channel) {
    Imf::InputFile input(file.c_str());
    const Imath::Box2i window = input.header().dataWindow();
    const auto width = static_cast<std::size_t>(window.size().x) + 1;
    const auto height = static_cast<std::size_t>(window.size().y) + 1;
    std::vector<float> values(width * height);
    const std::ptrdiff_t skipped = window.min.x + static_cast<std::ptrdiff_t>(width) * window.min.y;
    Imf::FrameBuffer buffer;
    buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data() - skipped), 4, 4 * width));
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
    return values;
}

/// One channel by OpenImageIO.
std::vector<float> read_with_oiio(const std::filesystem::path& file, const std::string& channel) {
    const auto input = OIIO::ImageInput::open(file.string());
    EXPECT_NE(input, nullptr) << OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    std::vector<float> values(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
    const int index = spec.channelindex(channel);
    EXPECT_TRUE(input->read_image(0, 0, index, index + 1, OIIO::TypeDesc::FLOAT, values.data())) << input->geterror();
    return values;
}

/// Writes the image in bands of `rows` rows, each from a slab of its own.
WrittenFile write_in_bands(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings,
                           int rows) {
    OutputImage description = image;
    for (OutputChannel& channel : description.channels) {
        channel.slab = nullptr;
    }
    ExrWriter writer(file, description, settings);
    for (int top = 0; top < image.data_window.height(); top += rows) {
        const int count = std::min(rows, image.data_window.height() - top);
        PlaneSlab band(image.data_window.width(), count + 2, static_cast<int>(image.channels.size()));
        std::vector<OutputChannel> channels = image.channels;
        for (std::size_t i = 0; i < channels.size(); ++i) {
            for (int y = 0; y < count; ++y) {
                std::ranges::copy(image.channels[i].slab->row(image.channels[i].plane, top + y),
                                  band.row(static_cast<int>(i), y + 2).begin());
            }
            channels[i].slab = &band;
            channels[i].plane = static_cast<int>(i);
        }
        writer.write(channels, 2, count);
    }
    return writer.commit();
}

bool is_lossless(const std::string& compression) {
    return compression == "none" || compression == "rle" || compression == "zips" || compression == "zip" ||
           compression == "piz";
}

void expect_pixels(const OutputImage& image, const std::filesystem::path& file, const ExrSettings& settings) {
    for (const OutputChannel& channel : image.channels) {
        const bool as_half = settings.half && !channel.force_float;
        const std::vector<float> by_library = read_with_library(file, channel.name);
        const std::vector<float> by_oiio = read_with_oiio(file, channel.name);
        ASSERT_EQ(by_library, by_oiio);
        if (!is_lossless(settings.compression)) {
            continue; // compared with the library's own file
        }
        std::size_t i = 0;
        for (int y = 0; y < image.data_window.height(); ++y) {
            for (const float value : channel.slab->row(channel.plane, y)) {
                ASSERT_EQ(by_library[i++], as_half ? static_cast<float>(half(value)) : value)
                    << channel.name << " " << settings.compression;
            }
        }
    }
}

TEST(ExrWriter, OtherProgramsReadWhatTheLibraryWouldHaveWritten) {
    const TemporaryFolder folder;
    const std::vector<std::array<int, 4>> windows{
        {70, 300, 0, 0}, {33, 17, -5, 1000}, {1, 40, 7, -90}, {129, 1, 0, 0}, {1, 1, -1, -1}};
    for (const auto& [width, height, left, top] : windows) {
        const PlaneSlab slab = example(width, height);
        const OutputImage image = image_of(slab, left, top);
        for (const char* compression : compressions) {
            for (const bool as_half : {true, false}) {
                const ExrSettings settings{as_half, compression, {}};
                const WrittenFile written = write_exr(folder / "a.exr", image, settings);
                EXPECT_EQ(written.bytes, std::filesystem::file_size(folder / "a.exr"));
                EXPECT_GT(written.busy_milliseconds, 0.0);
                EXPECT_FALSE(written.existed);
                expect_pixels(image, folder / "a.exr", settings);
                write_with_library(folder / "b.exr", image, settings, folder / "a.exr");
                if (std::string(compression).starts_with("zip")) { // another packer, the same bytes when unpacked
                    for (const OutputChannel& channel : image.channels) {
                        EXPECT_EQ(read_with_library(folder / "a.exr", channel.name),
                                  read_with_library(folder / "b.exr", channel.name));
                    }
                } else {
                    EXPECT_EQ(bytes_of_file(folder / "a.exr"), bytes_of_file(folder / "b.exr"))
                        << compression << " " << width << " x " << height;
                }
            }
        }
    }
    EXPECT_THAT(folder.names(), ElementsAre("a.exr", "b.exr"));
}

TEST(ExrWriter, TheLevelReachesTheCompression) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(64, 64);
    const OutputImage image = image_of(slab);
    const ExrSettings settings{true, "dwaa", 200.0};
    write_exr(folder / "a.exr", image, settings);
    write_with_library(folder / "b.exr", image, settings, folder / "a.exr");
    EXPECT_EQ(bytes_of_file(folder / "a.exr"), bytes_of_file(folder / "b.exr"));
    write_exr(folder / "b.exr", image, {true, "dwaa", {}});
    EXPECT_NE(std::filesystem::file_size(folder / "a.exr"), std::filesystem::file_size(folder / "b.exr"));
}

TEST(ExrWriter, LongNamesAreMarkedInTheHeader) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(8, 8);
    OutputImage image = image_of(slab);
    image.channels[0].name = std::string(100, 'n');
    image.attributes["an attribute with a name of more than thirty-one characters"] = "text";
    write_exr(folder / "a.exr", image, {});
    EXPECT_EQ(read_with_library(folder / "a.exr", image.channels[0].name).size(), 64U);
    image.channels[0].name = std::string(256, 'n');
    EXPECT_THAT(failure_of([&] { write_exr(folder / "a.exr", image, {}); }), HasSubstr("at most 255"));
}

TEST(ExrWriter, TheSameBytesInAnyBandsOnAnyThreads) {
    const tbb::global_control seven(tbb::global_control::max_allowed_parallelism, 7);
    const TemporaryFolder folder;
    const PlaneSlab slab = example(90, 530);
    const OutputImage image = image_of(slab, 3, -7);
    for (const char* compression : compressions) {
        for (const bool as_half : {true, false}) {
            const ExrSettings settings{as_half, compression, {}};
            const WrittenFile whole = write_exr(folder / "whole.exr", image, settings);
            const std::string expected = bytes_of_file(folder / "whole.exr");
            const int block = ExrWriter(folder / "unused.exr", image, settings).band_rows();
            for (const int rows : {block, 2 * block, 3 * 256}) {
                for (const int threads : {1, 2, 7}) {
                    tbb::task_arena arena(threads);
                    const WrittenFile banded =
                        arena.execute([&] { return write_in_bands(folder / "banded.exr", image, settings, rows); });
                    EXPECT_EQ(banded.hash, whole.hash);
                    EXPECT_EQ(banded.bytes, whole.bytes);
                    ASSERT_EQ(bytes_of_file(folder / "banded.exr"), expected)
                        << compression << ", " << rows << " rows, " << threads << " threads";
                }
            }
        }
    }
    EXPECT_THAT(folder.names(), ElementsAre("banded.exr", "whole.exr"));
}

TEST(ExrWriter, SeveralFilesAtOnce) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(64, 100);
    const OutputImage image = image_of(slab);
    for (const char* compression : compressions) {
        write_exr(folder / (std::string(compression) + ".exr"), image, {true, compression, {}});
    }
    // From tasks and from threads of the caller's own.
    std::vector<std::string> written(40);
    const auto write_one = [&](std::size_t i) {
        const std::string name = std::to_string(i) + ".exr";
        write_exr(folder / name, image, {true, compressions.at(i % compressions.size()), {}});
        written[i] = bytes_of_file(folder / name);
    };
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < 4; ++i) {
        threads.emplace_back([&, i] {
            for (std::size_t k = i; k < 20; k += 4) {
                write_one(k);
            }
        });
    }
    tbb::parallel_for(std::size_t{20}, written.size(), write_one);
    for (std::thread& thread : threads) {
        thread.join();
    }
    for (std::size_t i = 0; i < written.size(); ++i) {
        EXPECT_TRUE(written[i] ==
                    bytes_of_file(folder / (std::string(compressions.at(i % compressions.size())) + ".exr")))
            << i;
    }
}

TEST(ExrWriter, ValuesClampedInBandsAndInChunksThatDoNotShrinkAreCountedOnce) {
    const TemporaryFolder folder;
    for (const char* compression : compressions) {
        PlaneSlab slab = example(40, 64);
        slab.at(0, 3, 5) = 1e9F;
        slab.at(1, 39, 63) = -70000.0F; // in the last column and row
        slab.at(2, 0, 0) = 1e9F;        // a channel of floats
        slab.at(4, 8, 33) = 1e9F;       // noise
        const OutputImage image = image_of(slab);
        EXPECT_EQ(write_exr(folder / "a.exr", image, {true, compression, {}}).clamped, 3U) << compression;
        EXPECT_EQ(write_exr(folder / "a.exr", image, {false, compression, {}}).clamped, 0U) << compression;
    }
}

TEST(ExrWriter, AnExistingFileStaysIfItMayNotBeReplaced) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(16, 16);
    const OutputImage image = image_of(slab);
    const WrittenFile first = write_exr(folder / "a.exr", image, {}, Replace::no);
    EXPECT_FALSE(first.existed);
    EXPECT_EQ(std::filesystem::file_size(folder / "a.exr"), first.bytes);
    write_bytes(folder / "a.exr", "of somebody else");
    EXPECT_TRUE(write_exr(folder / "a.exr", image, {}, Replace::no).existed);
    EXPECT_EQ(bytes_of_file(folder / "a.exr"), "of somebody else");
    EXPECT_FALSE(write_exr(folder / "a.exr", image, {}, Replace::yes).existed);
    EXPECT_EQ(std::filesystem::file_size(folder / "a.exr"), first.bytes);
    EXPECT_THAT(folder.names(), ElementsAre("a.exr"));
    // Through a link to a file that is not there yet.
    std::filesystem::create_symlink("b.exr", folder / "link.exr");
    EXPECT_FALSE(write_exr(folder / "link.exr", image, {}, Replace::no).existed);
    EXPECT_TRUE(write_exr(folder / "link.exr", image, {}, Replace::no).existed);
    EXPECT_THAT(folder.names(), ElementsAre("a.exr", "b.exr", "link.exr"));
}

TEST(ExrWriter, OneOfManyWinsARace) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(16, 16);
    for (int round = 0; round < 10; ++round) {
        std::filesystem::remove(folder / "a.exr");
        std::atomic<int> winners{0};
        const auto compete = [&] {
            if (!write_exr(folder / "a.exr", image_of(slab), {}, Replace::no).existed) {
                ++winners;
            }
        };
        std::vector<std::thread> threads(8);
        std::generate(threads.begin(), threads.end(), [&] { return std::thread(compete); });
        for (std::thread& thread : threads) {
            thread.join();
        }
        EXPECT_EQ(winners, 1);
        EXPECT_THAT(folder.names(), ElementsAre("a.exr"));
    }
}

TEST(ExrWriter, WrongBandsAreRefusedAndLeaveNothing) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(16, 40);
    const OutputImage image = image_of(slab);
    const PlaneSlab narrow(15, 40, 5);
    const OutputImage other = [&] {
        OutputImage changed = image;
        for (OutputChannel& channel : changed.channels) {
            channel.slab = &narrow;
        }
        return changed;
    }();
    const auto refused = [&](const std::vector<OutputChannel>& channels, int first, int rows) {
        return failure_of([&] {
            ExrWriter writer(folder / "a.exr", image, {});
            writer.write(image.channels, 0, 16);
            writer.write(channels, first, rows);
        });
    };
    EXPECT_THAT(refused(image.channels, 16, 25), HasSubstr("do not fit"));
    EXPECT_THAT(refused(image.channels, 16, 15), HasSubstr("do not fit")); // not a whole block, not the last
    EXPECT_THAT(refused(image.channels, 30, 16), HasSubstr("has not the size"));
    EXPECT_THAT(refused(other.channels, 16, 16), HasSubstr("has not the size"));
    EXPECT_THAT(refused({image.channels.begin(), image.channels.end() - 1}, 16, 16), HasSubstr("do not fit"));
    EXPECT_THAT(failure_of([&] {
                    ExrWriter writer(folder / "a.exr", image, {});
                    writer.write(image.channels, 0, 32);
                    static_cast<void>(writer.commit());
                }),
                HasSubstr("only 32 rows"));
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(ExrWriter, AFileWithoutItsEndIsNotOneWhoeverReadsIt) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(300, 600);
    const OutputImage image = image_of(slab);
    ExrWriter writer(folder / "a.exr", image, {false, "none", {}});
    writer.write(image.channels, 0, 599);
    const std::vector<std::string> temporaries = folder.names();
    ASSERT_EQ(temporaries.size(), 1U);
    EXPECT_THAT(failure_of([&] { static_cast<void>(read_layout(folder / temporaries[0])); }),
                HasSubstr("not an OpenEXR file"));
    writer.write(image.channels, 599, 1);
    static_cast<void>(writer.commit());
    EXPECT_THAT(folder.names(), ElementsAre("a.exr"));
}

TEST(Runs, ComeBackAndShrink) {
    std::mt19937 random(3);
    for (int round = 0; round < 2000; ++round) {
        std::vector<std::byte> bytes(1 + random() % 600);
        const std::size_t kinds = 1 + random() % 4;
        std::size_t i = 0;
        while (i < bytes.size()) {
            const auto value = static_cast<std::byte>(random() % (2 * kinds));
            for (std::size_t n = random() % (200 / kinds) + 1; n > 0 && i < bytes.size(); --n) {
                bytes[i++] = value;
            }
        }
        std::vector<std::byte> packed(bytes.size());
        const std::size_t size = pack_runs(bytes, packed.data());
        ASSERT_LT(size, bytes.size());
        if (size != 0) {
            std::vector<std::byte> back(bytes.size());
            ASSERT_TRUE(undo_runs(std::span(packed).first(size), back));
            ASSERT_EQ(back, bytes);
        }
    }
}

} // namespace
} // namespace clshade
