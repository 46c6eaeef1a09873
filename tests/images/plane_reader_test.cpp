// Bands: any cut of a picture must give the same planes as the whole.
#include "tests/images/fixtures.h"

#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <half.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <numeric>
#include <random>
#include <string>

namespace clshade {
namespace {

using namespace testing;
using ::testing::HasSubstr;

const std::vector<PartChannel> mixed{{"A", Imf::HALF, 0}, {"Z", Imf::FLOAT, 1}, {"id", Imf::UINT, 2}};
const std::vector<Imf::Compression> all_compressions{
    Imf::NO_COMPRESSION,    Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,  Imf::PIZ_COMPRESSION,
    Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION};

Window union_of(const ImageLayout& layout) {
    Window window = layout.parts[0].data_window;
    for (const PartInfo& part : layout.parts) {
        window = {std::min(window.x_min, part.data_window.x_min), std::min(window.y_min, part.data_window.y_min),
                  std::max(window.x_max, part.data_window.x_max), std::max(window.y_max, part.data_window.y_max)};
    }
    return window;
}

std::vector<int> all_channels(const ImageLayout& layout) {
    std::vector<int> channels(layout.channels.size());
    std::iota(channels.begin(), channels.end(), 0);
    return channels;
}

/// A slab whose pixels hold what no file holds, and whose padding is zero.
PlaneSlab dirty_slab(int width, int height, int planes) {
    PlaneSlab slab(width, height, planes);
    for (int p = 0; p < planes; ++p) {
        for (int y = 0; y < height; ++y) {
            std::fill(slab.row(p, y).begin(), slab.row(p, y).end(), -12345.0F);
        }
    }
    return slab;
}

/// Everything between the pixels of a slab must be as the allocation left it.
void expect_clean_padding(const PlaneSlab& slab) {
    std::vector<float> rest(slab.all().begin(), slab.all().end());
    for (int p = 0; p < slab.count(); ++p) {
        for (int y = 0; y < slab.height(); ++y) {
            std::fill_n(rest.begin() + (slab.row(p, y).data() - slab.data()), slab.width(), 0.0F);
        }
    }
    ASSERT_TRUE(std::all_of(rest.begin(), rest.end(), [](float value) { return value == 0.0F; }));
}

/// Rows of a band against those of the whole picture, bit by bit.
void expect_same_rows(const PlaneSlab& band, const PlaneSlab& whole, int first_row) {
    for (int p = 0; p < band.count(); ++p) {
        for (int y = 0; y < band.height(); ++y) {
            ASSERT_EQ(
                std::memcmp(band.row(p, y).data(), whole.row(p, first_row + y).data(), band.row(p, y).size_bytes()), 0)
                << "plane " << p << ", row " << first_row + y;
        }
    }
}

/// Reads the file in bands of one height, from the top or from the bottom.
void expect_bands_agree(const std::filesystem::path& file, const PlaneSlab& whole, int rows, bool upwards) {
    const ImageLayout layout = read_layout(file);
    const Window window = union_of(layout);
    PlaneReader reader(file, layout, all_channels(layout), window);
    std::vector<int> starts;
    for (int y = 0; y < window.height(); y += rows) {
        starts.push_back(y);
    }
    if (upwards) {
        std::reverse(starts.begin(), starts.end());
    }
    for (const int start : starts) {
        PlaneSlab band = dirty_slab(window.width(), std::min(rows, window.height() - start),
                                    static_cast<int>(layout.channels.size()));
        reader.read(start, band);
        expect_same_rows(band, whole, start);
        expect_clean_padding(band);
    }
}

/// Bands of several heights against the whole, read in one go.
void expect_any_bands_agree(const std::filesystem::path& file) {
    const ImageLayout layout = read_layout(file);
    const Window window = union_of(layout);
    PlaneSlab whole = dirty_slab(window.width(), window.height(), static_cast<int>(layout.channels.size()));
    PlaneReader reader(file, layout, all_channels(layout), window);
    reader.read(0, whole);
    expect_clean_padding(whole);
    EXPECT_GE(reader.band_rows(), 1);
    EXPECT_LE(reader.band_rows(), 256);
    for (const int rows : {1, 7, 16, 100, reader.band_rows()}) {
        expect_bands_agree(file, whole, rows, rows == 7);
        if (::testing::Test::HasFatalFailure()) {
            FAIL() << file << " in bands of " << rows;
        }
    }
}

/// Every sample of the whole picture as pattern() has it; 0 outside the part.
void expect_pattern(const std::filesystem::path& file, const std::vector<PartChannel>& channels) {
    const ImageLayout layout = read_layout(file);
    const Window window = layout.parts[0].data_window;
    PlaneSlab whole(window.width(), window.height(), static_cast<int>(channels.size()));
    PlaneReader(file, layout, all_channels(layout), window).read(0, whole);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        for (int y = 0; y < window.height(); ++y) {
            for (int x = 0; x < window.width(); ++x) {
                ASSERT_EQ(whole.at(static_cast<int>(c), x, y),
                          pattern(channels[c].number, x + window.x_min, y + window.y_min))
                    << channels[c].name << " at " << x << ", " << y;
            }
        }
    }
}

TEST(PlaneReader, BandsOfScanLines) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : all_compressions) {
        for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
            Part part = make_part({-5, 3, 45, 140}, mixed, compression); // odd width, height no multiple of any block
            part.header.lineOrder() = order;
            write_parts(folder / "a.exr", {part});
            expect_any_bands_agree(folder / "a.exr");
        }
    }
}

TEST(PlaneReader, BandsOfTiles) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : all_compressions) {
        for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y, Imf::RANDOM_Y}) {
            Part part = make_part({-5, 3, 45, 140}, mixed, compression);
            tile(part, 16, 24, Imf::MIPMAP_LEVELS, order);
            write_parts(folder / "a.exr", {part});
            expect_any_bands_agree(folder / "a.exr");
        }
    }
}

TEST(PlaneReader, PartsOfDifferentWindows) {
    // Chunks of a part begin where the part does, not where the picture does.
    const TemporaryFolder folder;
    for (const Imf::Compression compression : all_compressions) {
        for (const bool tiled : {false, true}) {
            Part small = make_part({10, 12, 20, 61}, {{"N.X", Imf::FLOAT, 3}}, compression, "small");
            Part large = make_part({-8, -2, 40, 83}, {{"P.X", Imf::HALF, 4}, {"P.Y", Imf::FLOAT, 5}},
                                   Imf::ZIP_COMPRESSION, "large");
            Part below = make_part({-8, 90, 0, 98}, {{"id", Imf::UINT, 6}}, compression, "below");
            if (tiled) {
                tile(small, 16, 24);
            }
            write_parts(folder / "a.exr", {small, large, below});
            expect_any_bands_agree(folder / "a.exr");
        }
    }
}

TEST(PlaneReader, WhatNoPartCoversIsZero) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        const Window part{10, 12, 20, 30};
        write_parts(folder / "a.exr", {make_part(part, {{"Z", Imf::FLOAT, 3}}, compression)});
        const ImageLayout layout = read_layout(folder / "a.exr");
        const Window window{-3, 5, 30, 50};
        PlaneReader reader(folder / "a.exr", layout, all_channels(layout), window);
        for (int y = 0; y < window.height(); ++y) {
            PlaneSlab row = dirty_slab(window.width(), 1, 1);
            reader.read(y, row);
            for (int x = 0; x < window.width(); ++x) {
                const int file_x = x + window.x_min;
                const int file_y = y + window.y_min;
                const bool inside =
                    file_x >= part.x_min && file_x <= part.x_max && file_y >= part.y_min && file_y <= part.y_max;
                ASSERT_EQ(row.at(0, x, 0), inside ? pattern(3, file_x, file_y) : 0.0F) << file_x << ", " << file_y;
            }
            expect_clean_padding(row);
        }
    }
}

TEST(PlaneReader, AnyNumberOfThreadsGivesTheSame) {
    const TemporaryFolder folder;
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 5);
    for (const Imf::Compression compression : all_compressions) {
        write_parts(folder / "a.exr", {make_part({0, 0, 122, 299}, mixed, compression)});
        const ImageLayout layout = read_layout(folder / "a.exr");
        const Window window = layout.parts[0].data_window;
        PlaneSlab one(123, 300, 3);
        tbb::task_arena(1).execute(
            [&] { PlaneReader(folder / "a.exr", layout, all_channels(layout), window).read(0, one); });
        for (const int threads : {2, 5}) {
            for (int round = 0; round < 5; ++round) {
                PlaneSlab many = dirty_slab(123, 300, 3);
                tbb::task_arena(threads).execute(
                    [&] { PlaneReader(folder / "a.exr", layout, all_channels(layout), window).read(0, many); });
                expect_same_rows(many, one, 0);
            }
        }
    }
}

TEST(PlaneReader, OddWidthsAndSmallPictures) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                               Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        for (int width = 1; width <= 70; ++width) {
            // A half before a float: samples of the float are not aligned in the file.
            write_parts(folder / "a.exr", {make_part({3, -1, 2 + width, 1}, mixed, compression)});
            expect_pattern(folder / "a.exr", mixed);
        }
    }
}

/// Values of all kinds: what a random float holds, and plain ones.
std::vector<float> any_values(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> values(count);
    for (float& value : values) {
        const auto bits = static_cast<std::uint32_t>(random());
        value = bits % 4 == 0 ? std::bit_cast<float>(bits) : static_cast<float>(bits % 1000) * 0.037F;
    }
    return values;
}

TEST(PlaneReader, AgreesWithTheLibrary) {
    const TemporaryFolder folder;
    constexpr int width = 203; // lines beyond a vector's length, and some left over
    constexpr int height = 67;
    constexpr std::size_t row = width;
    std::vector<float> values = any_values(row * height, 11);
    std::vector<half> halves(values.begin(), values.end());
    std::vector<unsigned> numbers(values.size());
    std::transform(values.begin(), values.end(), numbers.begin(), [](float v) { return std::bit_cast<unsigned>(v); });
    for (const Imf::Compression compression : all_compressions) {
        Part part = make_part({0, 0, width - 1, height - 1}, mixed, compression);
        {
            Imf::OutputFile output((folder / "a.exr").c_str(), part.header);
            Imf::FrameBuffer buffer;
            buffer.insert("A", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(halves.data()), 2, 2 * row));
            buffer.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 4 * row));
            buffer.insert("id", Imf::Slice(Imf::UINT, reinterpret_cast<char*>(numbers.data()), 4, 4 * row));
            output.setFrameBuffer(buffer);
            output.writePixels(height);
        }
        PlaneSlab expected(width, height, 3);
        {
            Imf::InputFile input((folder / "a.exr").c_str());
            Imf::FrameBuffer buffer;
            const std::size_t line = static_cast<std::size_t>(expected.pitch()) * 4;
            buffer.insert("A", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(expected.plane(0).data()), 4, line));
            buffer.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(expected.plane(1).data()), 4, line));
            buffer.insert("id", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(expected.plane(2).data()), 4, line));
            input.setFrameBuffer(buffer);
            input.readPixels(0, height - 1);
        }
        const ImageLayout layout = read_layout(folder / "a.exr");
        PlaneSlab planes = dirty_slab(width, height, 3);
        PlaneReader(folder / "a.exr", layout, all_channels(layout), {0, 0, width - 1, height - 1}).read(0, planes);
        for (int p = 0; p < 3; ++p) {
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const float got = planes.at(p, x, y);
                    const float wanted = expected.at(p, x, y);
                    // The library may leave a NaN of a half signalling.
                    ASSERT_TRUE(std::bit_cast<std::uint32_t>(got) == std::bit_cast<std::uint32_t>(wanted) ||
                                (p == 0 && std::isnan(got) && std::isnan(wanted)))
                        << compression << ", plane " << p << " at " << x << ", " << y << ": " << got << " " << wanted;
                }
            }
        }
    }
}

TEST(PlaneReader, FewOfManyChannels) {
    // Uncompressed rows that lie far apart and close together, of several kinds, in both directions.
    const TemporaryFolder folder;
    std::vector<PartChannel> channels;
    channels.reserve(40);
    for (int i = 0; i < 40; ++i) {
        channels.push_back(
            {"c" + std::to_string(100 + i), i % 3 == 0 ? Imf::HALF : (i % 3 == 1 ? Imf::FLOAT : Imf::UINT), i});
    }
    for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
        for (const int width : {3, 300, 3000}) {
            Part part = make_part({0, 0, width - 1, 20}, channels, Imf::NO_COMPRESSION);
            part.header.lineOrder() = order;
            write_parts(folder / "a.exr", {part});
            const ImageLayout layout = read_layout(folder / "a.exr");
            for (const std::vector<int>& wanted : {std::vector<int>{39, 0}, {20, 21, 22}, {1}, {5, 38, 6, 5}}) {
                PlaneReader reader(folder / "a.exr", layout, wanted, {0, 0, width - 1, 20});
                const std::uint64_t before = reader.bytes_read();
                PlaneSlab planes = dirty_slab(width, 21, static_cast<int>(wanted.size()));
                reader.read(0, planes);
                for (std::size_t i = 0; i < wanted.size(); ++i) {
                    for (int y = 0; y < 21; ++y) {
                        for (int x = 0; x < width; ++x) {
                            ASSERT_EQ(planes.at(static_cast<int>(i), x, y), pattern(wanted[i], x, y))
                                << wanted[i] << " at " << x << ", " << y << " of " << width;
                        }
                    }
                }
                if (width == 3000) {
                    EXPECT_LT(reader.bytes_read() - before, std::filesystem::file_size(folder / "a.exr") / 4);
                }
            }
        }
    }
}

TEST(PlaneReader, AChannelMayBeWantedTwice) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        write_parts(folder / "a.exr", {make_part({0, 0, 30, 20}, mixed, compression)});
        const ImageLayout layout = read_layout(folder / "a.exr");
        const std::vector<int> channels{1, 0, 1};
        PlaneSlab planes = dirty_slab(31, 21, 3);
        PlaneReader(folder / "a.exr", layout, channels, {0, 0, 30, 20}).read(0, planes);
        EXPECT_EQ(planes.at(0, 7, 9), pattern(1, 7, 9));
        EXPECT_EQ(planes.at(1, 7, 9), pattern(0, 7, 9));
        EXPECT_EQ(planes.at(2, 7, 9), pattern(1, 7, 9));
    }
}

TEST(PlaneReader, TheLibrarysOwnThreadsAreStopped) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr", {make_part({0, 0, 30, 20}, mixed, Imf::PIZ_COMPRESSION)});
    Imf::setGlobalThreadCount(3);
    expect_pattern(folder / "a.exr", mixed);
    EXPECT_EQ(Imf::globalThreadCount(), 0);
}

TEST(PlaneReader, RowsOfABand) {
    const TemporaryFolder folder;
    const auto rows_of = [&](std::vector<Part> parts) {
        write_parts(folder / "a.exr", std::move(parts));
        const ImageLayout layout = read_layout(folder / "a.exr");
        return PlaneReader(folder / "a.exr", layout, all_channels(layout), union_of(layout)).band_rows();
    };
    const Window window{0, 0, 9, 299};
    EXPECT_EQ(rows_of({make_part(window, mixed, Imf::NO_COMPRESSION)}), 1);
    EXPECT_EQ(rows_of({make_part(window, mixed, Imf::ZIP_COMPRESSION)}), 16);
    EXPECT_EQ(rows_of({make_part(window, mixed, Imf::DWAB_COMPRESSION)}), 256);
    EXPECT_EQ(rows_of({make_part({0, 0, 9, 5}, mixed, Imf::DWAB_COMPRESSION)}), 6);
    Part tiles = make_part(window, {{"N.X", Imf::HALF, 0}}, Imf::ZIP_COMPRESSION, "tiles");
    tile(tiles, 32, 24);
    EXPECT_EQ(rows_of({make_part(window, mixed, Imf::ZIP_COMPRESSION, "lines"), tiles}), 48);
    tile(tiles, 32, 37);
    EXPECT_EQ(rows_of({make_part(window, mixed, Imf::ZIP_COMPRESSION, "lines"), tiles}), 37); // not 592
}

TEST(PlaneReader, ABandTakesItsChunksAndNoMore) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        write_parts(folder / "a.exr", {make_part({0, 0, 1999, 319}, mixed, compression)});
        const ImageLayout layout = read_layout(folder / "a.exr");
        PlaneReader reader(folder / "a.exr", layout, all_channels(layout), {0, 0, 1999, 319});
        const std::uint64_t before = reader.bytes_read();
        EXPECT_LT(before, 20000U); // header and table
        PlaneSlab band(2000, 32, 3);
        reader.read(64, band);
        const auto size = static_cast<double>(std::filesystem::file_size(folder / "a.exr"));
        const auto taken = static_cast<double>(reader.bytes_read() - before);
        EXPECT_GT(taken, 0.05 * size); // 32 of 320 rows, of which no two need the same room
        EXPECT_LT(taken, 0.2 * size);
        EXPECT_GT(reader.busy_milliseconds(), 0.0);
    }
}

TEST(PlaneReader, PlanesThatDoNotFitAreRefused) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr", {make_part({0, 0, 30, 20}, mixed)});
    const ImageLayout layout = read_layout(folder / "a.exr");
    PlaneReader reader(folder / "a.exr", layout, all_channels(layout), {0, 0, 30, 20});
    PlaneSlab band(31, 10, 3);
    EXPECT_THAT(failure_of([&] { reader.read(12, band); }), HasSubstr("do not fit"));
    EXPECT_THAT(failure_of([&] { reader.read(-1, band); }), HasSubstr("do not fit"));
    PlaneSlab narrow(30, 10, 3);
    EXPECT_THAT(failure_of([&] { reader.read(0, narrow); }), HasSubstr("do not fit"));
    PlaneSlab few(31, 10, 2);
    EXPECT_THAT(failure_of([&] { reader.read(0, few); }), HasSubstr("do not fit"));
}

TEST(PlaneReader, AFileCutWhileItIsReadFails) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : all_compressions) {
        write_parts(folder / "a.exr", {make_part({0, 0, 200, 600}, mixed, compression)});
        const ImageLayout layout = read_layout(folder / "a.exr");
        PlaneReader reader(folder / "a.exr", layout, all_channels(layout), {0, 0, 200, 600});
        PlaneSlab band(201, 32, 3);
        reader.read(0, band);
        std::filesystem::resize_file(folder / "a.exr", std::filesystem::file_size(folder / "a.exr") / 2);
        EXPECT_THAT(failure_of([&] { reader.read(560, band); }), HasSubstr((folder / "a.exr").string()));
    }
}

TEST(PlaneReader, AFileThatIsReplacedIsReadToItsEnd) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : all_compressions) {
        write_parts(folder / "a.exr", {make_part({0, 0, 40, 99}, mixed, compression)});
        const ImageLayout layout = read_layout(folder / "a.exr");
        PlaneReader reader(folder / "a.exr", layout, all_channels(layout), {0, 0, 40, 99});
        PlaneSlab before(41, 100, 3);
        reader.read(0, before);
        PlaneReader second(folder / "a.exr", layout, all_channels(layout), {0, 0, 40, 99});
        write_parts(folder / "b.exr", {make_part({0, 0, 20, 9}, mixed, compression)});
        std::filesystem::rename(folder / "b.exr", folder / "a.exr");
        PlaneSlab after = dirty_slab(41, 100, 3);
        second.read(0, after);
        expect_same_rows(after, before, 0);
    }
}

TEST(PlaneReader, AFileOverwrittenInPlaceNeverCrashes) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : all_compressions) {
        for (const bool tiled : {false, true}) {
            Part wide = make_part({0, 0, 400, 99}, mixed, compression);
            Part narrow = make_part({0, 0, 40, 99}, mixed, compression);
            if (tiled) {
                tile(wide, 48, 32);
                tile(narrow, 16, 16);
            }
            write_parts(folder / "wide.exr", {wide});
            write_parts(folder / "a.exr", {narrow});
            const ImageLayout layout = read_layout(folder / "a.exr");
            PlaneReader reader(folder / "a.exr", layout, all_channels(layout), {0, 0, 40, 99});
            {
                std::fstream file(folder / "a.exr", std::ios::in | std::ios::out | std::ios::binary);
                const std::string bytes = bytes_of_file(folder / "wide.exr");
                file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
            }
            PlaneSlab planes(41, 100, 3);
            EXPECT_THAT(failure_of([&] { reader.read(0, planes); }), HasSubstr((folder / "a.exr").string()));
            expect_clean_padding(planes);
        }
    }
}

} // namespace
} // namespace clshade
