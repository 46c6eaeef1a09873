// Lat-long pictures in: what is read exactly, what is put right, what is refused.
#include "host/images/environment_file.h"
#include "tests/images/fixtures.h"

#include <ImfStandardAttributes.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace clshade {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

LatLong read(const fs::path& file) {
    return read_lat_long(file, 0, false);
}

/// One line that names the file and says what to do.
std::string failure(const fs::path& file, std::uint64_t max_memory = 0, bool whole = false) {
    std::string said = failure_of([&] { static_cast<void>(read_lat_long(file, max_memory, whole)); });
    EXPECT_THAT(said, AllOf(HasSubstr(file.string() + ": "), HasSubstr("; "), Not(HasSubstr("\n"))));
    return said;
}

float texel(const LatLong& image, int x, int y, int c) {
    return image
        .rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) * 3 +
             static_cast<std::size_t>(c)];
}

const std::vector<PartChannel> rgb{{"R", Imf::HALF, 1}, {"G", Imf::FLOAT, 2}, {"B", Imf::HALF, 3}};

void expect_pattern(const LatLong& image, const Window& window, const std::array<int, 3>& numbers = {1, 2, 3}) {
    ASSERT_EQ(image.width, window.width());
    ASSERT_EQ(image.height, window.height());
    ASSERT_EQ(image.rgb.size(), static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3);
    int wrong = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                wrong += texel(image, x, y, c) ==
                                 pattern(numbers[static_cast<std::size_t>(c)], x + window.x_min, y + window.y_min)
                             ? 0
                             : 1;
            }
        }
    }
    EXPECT_EQ(wrong, 0);
}

// --- EXR

TEST(EnvironmentExr, EveryCompressionAndOrderOfPixels) {
    const TemporaryFolder folder;
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        for (const Window window : {Window{0, 0, 199, 99}, Window{-30, 7, 169, 106}, Window{0, 0, 1, 0}}) {
            Part part = make_part(window, rgb, compression);
            part.header.displayWindow() = part.header.dataWindow();
            write_parts(folder / "a.exr", {part});
            expect_pattern(read(folder / "a.exr"), window);
            tile(part, 48, 32, Imf::MIPMAP_LEVELS); // further levels hold other values
            write_parts(folder / "a.exr", {part});
            const LatLong image = read(folder / "a.exr");
            expect_pattern(image, window);
            EXPECT_EQ(image.name, "a.exr");
            EXPECT_EQ(image.halvings, 0);
            EXPECT_EQ(image.up, std::nullopt);
        }
    }
}

TEST(EnvironmentExr, ChannelsAreFoundByName) {
    const TemporaryFolder folder;
    const Window window{0, 0, 63, 31};
    const fs::path file = folder / "a.exr";
    const auto write = [&](const std::vector<PartChannel>& channels) {
        write_parts(file, {make_part(window, channels)});
    };
    write({{"A", Imf::HALF, 9}, {"B", Imf::HALF, 3}, {"G", Imf::HALF, 2}, {"R", Imf::HALF, 1}, {"Z", Imf::FLOAT, 8}});
    expect_pattern(read(file), window);
    write({{"Y", Imf::FLOAT, 4}});
    expect_pattern(read(file), window, {4, 4, 4});
    write({{"A", Imf::HALF, 9}, {"Y", Imf::HALF, 4}});
    expect_pattern(read(file), window, {4, 4, 4});
    write({{"sky.B", Imf::HALF, 3}, {"sky.G", Imf::HALF, 2}, {"sky.R", Imf::HALF, 1}, {"depth.Z", Imf::HALF, 7}});
    expect_pattern(read(file), window);
    write({{"B", Imf::HALF, 3},
           {"G", Imf::HALF, 2},
           {"R", Imf::HALF, 1},
           {"sky.B", Imf::HALF, 6},
           {"sky.G", Imf::HALF, 5},
           {"sky.R", Imf::HALF, 4}});
    expect_pattern(read(file), window);
    write({{"a.B", Imf::HALF, 3},
           {"a.G", Imf::HALF, 2},
           {"a.R", Imf::HALF, 1},
           {"b.B", Imf::HALF, 6},
           {"b.G", Imf::HALF, 5},
           {"b.R", Imf::HALF, 4}});
    EXPECT_THAT(failure(file), AllOf(HasSubstr("several layers"), HasSubstr("b.R")));
    write({{"R", Imf::HALF, 1}, {"G", Imf::HALF, 2}});
    EXPECT_THAT(failure(file), HasSubstr("no layer with R, G and B"));
    write({{"R", Imf::UINT, 1}, {"G", Imf::UINT, 2}, {"B", Imf::UINT, 3}});
    EXPECT_THAT(failure(file), HasSubstr("whole numbers"));
}

TEST(EnvironmentExr, TheAttributeSaysWhatItIs) {
    const TemporaryFolder folder;
    Part flat = make_part({0, 0, 63, 31}, rgb);
    Imf::addEnvmap(flat.header, Imf::ENVMAP_LATLONG);
    write_parts(folder / "flat.exr", {flat});
    EXPECT_EQ(read(folder / "flat.exr").up, UpAxis::y); // OpenEXR's lat-long pictures stand on y
    Part cube = make_part({0, 0, 31, 191}, rgb);
    Imf::addEnvmap(cube.header, Imf::ENVMAP_CUBE);
    write_parts(folder / "cube.exr", {cube});
    EXPECT_THAT(failure(folder / "cube.exr"),
                HasSubstr("`exrenvmap -l -w 128 " + (folder / "cube.exr").string() + " LATLONG.exr`"));
}

TEST(EnvironmentExr, OtherShapesAreRefused) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.exr";
    const auto said = [&](int width, int height) {
        Part part = make_part({0, 0, width - 1, height - 1}, rgb);
        part.header.displayWindow() = part.header.dataWindow();
        write_parts(file, {part});
        return failure(file);
    };
    EXPECT_THAT(said(1, 1), AllOf(HasSubstr("is 1x1"), HasSubstr("exactly twice as wide as high")));
    EXPECT_THAT(said(64, 33), HasSubstr("is 64x33"));
    EXPECT_THAT(said(65, 32), HasSubstr("is 65x32"));
    EXPECT_THAT(said(32, 64), HasSubstr("is 32x64"));
    EXPECT_THAT(said(16, 96), AllOf(HasSubstr("16x96"), HasSubstr("`exrenvmap -ci -l -w 64 ")));
    for (const auto& [width, height] : {std::array{96, 16}, {48, 64}, {64, 48}}) {
        EXPECT_THAT(said(width, height), AllOf(HasSubstr("looks like a cube map"), HasSubstr("--cut 16x16+0+0")));
    }
}

TEST(EnvironmentExr, APartOfAPictureIsRefused) {
    const TemporaryFolder folder;
    Part part = make_part({10, 10, 41, 25}, rgb); // 32x16
    part.header.displayWindow() = Imath::Box2i({0, 0}, {127, 63});
    write_parts(folder / "a.exr", {part});
    EXPECT_THAT(failure(folder / "a.exr"), HasSubstr("32x16 pixels of 128x64"));
}

/// 8x4 texels of 0.5 with some set.
void write_floats(const fs::path& file, const std::function<void(PlaneSlab&)>& action) {
    PlaneSlab slab(8, 4, 3);
    for (int y = 0; y < 4; ++y) {
        for (int c = 0; c < 3; ++c) {
            std::fill(slab.row(c, y).begin(), slab.row(c, y).end(), 0.5F);
        }
    }
    action(slab);
    OutputImage image;
    image.data_window = {0, 0, 7, 3};
    image.display_window = image.data_window;
    image.channels = {{"R", &slab, 0, true}, {"G", &slab, 1, true}, {"B", &slab, 2, true}};
    write_exr(file, image, {});
}

TEST(EnvironmentExr, BadTexelsAreCleanedAndCounted) {
    const TemporaryFolder folder;
    constexpr float inf = std::numeric_limits<float>::infinity();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    write_floats(folder / "a.exr", [](PlaneSlab& slab) {
        slab.at(0, 1, 0) = nan;
        slab.at(1, 2, 1) = inf;
        slab.at(2, 3, 2) = -inf;
        slab.at(0, 4, 3) = -0.25F;
        slab.at(1, 4, 3) = 2e5F; // a sun beyond half's range stays
    });
    const LatLong image = read(folder / "a.exr");
    EXPECT_EQ(image.nonfinite, 3U);
    EXPECT_EQ(image.negative, 1U);
    for (const auto& [x, y] : {std::array{1, 0}, {2, 1}, {3, 2}}) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(texel(image, x, y, c), 0.0F);
        }
    }
    EXPECT_EQ(texel(image, 4, 3, 0), 0.0F);
    EXPECT_EQ(texel(image, 4, 3, 1), 2e5F);
    EXPECT_EQ(texel(image, 4, 3, 2), 0.5F);
    EXPECT_EQ(std::count(image.rgb.begin(), image.rgb.end(), 0.5F), 8 * 4 * 3 - 9 - 2);

    write_floats(folder / "a.exr", [&](PlaneSlab& slab) {
        for (int y = 0; y < 4; ++y) {
            std::fill(slab.row(y % 3, y).begin(), slab.row(y % 3, y).end(), nan);
        }
    });
    EXPECT_THAT(failure(folder / "a.exr"), HasSubstr("every texel is NaN or Inf"));
}

TEST(EnvironmentExr, CutFilesAreRefused) {
    const TemporaryFolder folder;
    for (const bool tiled : {false, true}) {
        Part part = make_part({0, 0, 63, 31}, rgb, Imf::ZIPS_COMPRESSION);
        if (tiled) {
            tile(part, 16, 16);
        }
        write_parts(folder / "whole.exr", {part});
        const std::string whole = bytes_of_file(folder / "whole.exr");
        for (std::size_t size = 0; size < whole.size(); size += size < whole.size() - 40 ? 37 : 1) {
            write_bytes(folder / "cut.exr", whole.substr(0, size));
            EXPECT_FALSE(failure(folder / "cut.exr").empty()) << size;
        }
    }
}

TEST(EnvironmentExr, MonstrousClaimsTakeNoMemory) {
    const TemporaryFolder folder;
    Part part = make_part({0, 0, 63, 31}, rgb);
    write_parts(folder / "a.exr", {part});
    std::string bytes = bytes_of_file(folder / "a.exr");
    const std::string box("dataWindow\0box2i\0\x10\0\0\0", 21);
    const std::size_t at = bytes.find(box);
    ASSERT_NE(at, std::string::npos);
    for (const auto& [width, height] : {std::array{2000000, 1000000}, {200000, 100000}, {2147483646, 1073741823}}) {
        for (int i = 0; i < 4; ++i) {
            bytes[at + box.size() + 8 + static_cast<std::size_t>(i)] = static_cast<char>((width - 1) >> (8 * i));
            bytes[at + box.size() + 12 + static_cast<std::size_t>(i)] = static_cast<char>((height - 1) >> (8 * i));
        }
        write_bytes(folder / "a.exr", bytes);
        const int result = in_child([&] {
            static_cast<void>(failure_of([&] { static_cast<void>(read(folder / "a.exr")); })); // libraries loaded
            rusage before{};
            ::getrusage(RUSAGE_SELF, &before);
            const std::string said = failure_of([&] { static_cast<void>(read(folder / "a.exr")); });
            rusage after{};
            ::getrusage(RUSAGE_SELF, &after);
            const bool checked =
                said.find(" chunk") != std::string::npos || said.find("the header is") != std::string::npos;
            return checked && after.ru_maxrss - before.ru_maxrss < 16384 ? 0 : 1;
        });
        EXPECT_EQ(result, 0) << width;
    }
}

// --- fitting the memory

void expect_halvings(const fs::path& file, int height, int most) {
    const std::uint64_t whole_bytes =
        std::uint64_t{2} * 12 * static_cast<std::uint64_t>(height) * static_cast<std::uint64_t>(height);
    LatLong expected = read_lat_long(file, whole_bytes, true); // just fits
    EXPECT_EQ(expected.height, height);
    for (int halvings = 1; halvings <= most; ++halvings) {
        expected = halved(expected);
        const std::uint64_t fits = whole_bytes >> (2 * halvings);
        const LatLong image = read_lat_long(file, halvings == 1 ? fits : 4 * fits - 1, false);
        EXPECT_EQ(image.halvings, halvings);
        EXPECT_EQ(image.width, 2 * height >> halvings);
        EXPECT_EQ(image.height, height >> halvings);
        EXPECT_TRUE(image.rgb == expected.rgb);
    }
    // With a background, or where even 1024 rows take too much.
    const std::string mebibytes = fmt::format(" {} MiB", whole_bytes >> 20U);
    EXPECT_THAT(failure(file, whole_bytes - 1, true), AllOf(HasSubstr(mebibytes), HasSubstr("--max-mem")));
    EXPECT_THAT(failure(file, (whole_bytes >> (2 * most)) - 1), AllOf(HasSubstr(mebibytes), HasSubstr("--max-mem")));
}

TEST(EnvironmentMemory, PicturesAreHalvedAsIfInMemory) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.exr";
    write_parts(file, {make_part({0, 0, 8191, 4095}, {{"Y", Imf::HALF, 1}}, Imf::RLE_COMPRESSION)});
    expect_halvings(file, 4096, 2);
    Part tiled = make_part({0, 0, 4095, 2047}, rgb, Imf::RLE_COMPRESSION);
    tile(tiled, 256, 97); // an odd number of rows in each band
    write_parts(file, {tiled});
    expect_halvings(file, 2048, 1);
}

TEST(EnvironmentMemory, OddPicturesCannotBeHalved) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr", {make_part({0, 0, 4197, 2098}, {{"Y", Imf::HALF, 1}}, Imf::RLE_COMPRESSION)});
    EXPECT_THAT(failure(folder / "a.exr", 1 << 20), AllOf(HasSubstr("odd number of rows"), HasSubstr("--max-mem")));
    EXPECT_EQ(read_lat_long(folder / "a.exr", std::uint64_t{1} << 30U, true).height, 2099);
}

// --- Radiance

/// A mantissa a component and the common exponent: 2^(e - 136) m.
using Rgbe = std::array<unsigned char, 4>;

std::string hdr_header(const std::string& lines, int width, int height) {
    return "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
           std::to_string(width) + "\n";
}

Rgbe hdr_texel(int x, int y) {
    return {static_cast<unsigned char>(128 + x % 128), static_cast<unsigned char>(y % 256),
            static_cast<unsigned char>((3 * x + y) % 256), static_cast<unsigned char>(120 + y % 30)};
}

/// One line in the run-length encoding that most writers use, without any run.
std::string hdr_line(int width, int y) {
    std::string line{2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
    for (std::size_t c = 0; c < 4; ++c) {
        for (int x = 0; x < width; ++x) {
            if (x % 128 == 0) {
                line.push_back(static_cast<char>(std::min(128, width - x)));
            }
            line.push_back(static_cast<char>(hdr_texel(x, y)[c]));
        }
    }
    return line;
}

std::string hdr_file(const std::string& lines, int width = 200, int height = 100) {
    std::string bytes = hdr_header(lines, width, height);
    for (int y = 0; y < height; ++y) {
        bytes += hdr_line(width, y);
    }
    return bytes;
}

void expect_hdr(const LatLong& image, int width = 200, int height = 100) {
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(image.height, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Rgbe stored = hdr_texel(x, y);
            for (int c = 0; c < 3; ++c) {
                ASSERT_EQ(texel(image, x, y, c),
                          std::ldexp(static_cast<float>(stored[static_cast<std::size_t>(c)]), stored[3] - 136))
                    << x << " " << y;
            }
        }
    }
}

TEST(EnvironmentHdr, IsReadAsItStands) {
    const TemporaryFolder folder;
    write_bytes(folder / "a.hdr", hdr_file(""));
    const LatLong image = read(folder / "a.hdr");
    expect_hdr(image);
    EXPECT_EQ(image.up, std::nullopt);
    EXPECT_EQ(image.negative + image.nonfinite, 0U);
}

TEST(EnvironmentHdr, NonsenseInTheHeaderIsNotApplied) {
    // conventions.md section 4: often wrong, so not applied.
    const TemporaryFolder folder;
    for (const char* lines :
         {"GAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\n", "GAMMA=2.2\n", "PRIMARIES=0.7 0.2 0.3 0.6 0.1 0.1 0.3 0.3\n",
          "EXPOSURE=2.0\n", "#?RADIANCE\n# a comment\n"}) {
        write_bytes(folder / "a.hdr", hdr_file(lines));
        expect_hdr(read(folder / "a.hdr"));
    }
}

TEST(EnvironmentHdr, CutFilesAreRefused) {
    const TemporaryFolder folder;
    const std::string whole = hdr_file("", 20, 10);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        write_bytes(folder / "a.hdr", whole.substr(0, size));
        EXPECT_FALSE(failure(folder / "a.hdr").empty()) << size;
    }
    write_bytes(folder / "a.hdr", whole);
    expect_hdr(read(folder / "a.hdr"), 20, 10);
}

TEST(EnvironmentHdr, WhatWouldComeOutWrongIsRefused) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.hdr";
    std::string xyz = hdr_file("");
    xyz.replace(xyz.find("rgbe"), 4, "xyze");
    write_bytes(file, xyz);
    EXPECT_THAT(failure(file), HasSubstr("ra_xyze -r"));
    const auto with_size = [](const std::string& size) {
        std::string bytes = hdr_file("");
        const std::string old = "-Y 100 +X 200";
        bytes.replace(bytes.find(old), old.size(), size);
        return bytes;
    };
    for (const char* size : {"+Y 100 +X 200", "-Y 100 -X 200", "+Y 100 -X 200"}) {
        write_bytes(file, with_size(size));
        EXPECT_THAT(failure(file), HasSubstr("--reorient")) << size;
    }
    for (const char* size : {"-Y 1000000 +X 2000000", "-Y 20000 +X 40000", "-Y 1000 +X 2000"}) {
        write_bytes(file, with_size(size));
        EXPECT_THAT(failure(file), HasSubstr("bytes can hold")) << size;
    }
    for (const char* size :
         {"-Y -100 +X -200", "-Y 99999999999 +X 199999999998", "-Y 0 +X 0", "-Y 101 +X 202", "no size"}) {
        write_bytes(file, with_size(size));
        EXPECT_FALSE(failure(file).empty()) << size;
    }
}

// --- anything else

TEST(EnvironmentFile, OtherThingsAreRefused) {
    const TemporaryFolder folder;
    EXPECT_THAT(failure(folder / "none.hdr"), HasSubstr("no such file"));
    EXPECT_THAT(failure(folder.path()), HasSubstr("is a folder"));
    write_bytes(folder / "empty.hdr", "");
    EXPECT_THAT(failure(folder / "empty.hdr"), HasSubstr("is empty"));
    write_bytes(folder / "text.hdr", "twice as wide as high");
    EXPECT_THAT(failure(folder / "text.hdr"), HasSubstr("not an image"));
    write_bytes(folder / "a.hdr", hdr_file(""));
    fs::permissions(folder / "a.hdr", fs::perms::none);
    fs::permissions(folder.path(), fs::perms(0755));
    EXPECT_EQ(
        as_common_user([&] { return failure(folder / "a.hdr").find("permissions") != std::string::npos ? 0 : 1; }), 0);
}

TEST(EnvironmentFile, ReadingLeavesPreviewsAlone) {
    const TemporaryFolder folder;
    PlaneSlab slab(4, 2, 3);
    OutputImage image;
    image.data_window = {0, 0, 3, 1};
    image.display_window = image.data_window;
    image.channels = {{"R", &slab, 0}, {"G", &slab, 1}, {"B", &slab, 2}};
    slab.at(0, 1, 1) = 0.5F;
    write_png(folder / "before.png", image);
    write_bytes(folder / "a.hdr", hdr_file("GAMMA=2.2\n"));
    static_cast<void>(read(folder / "a.hdr"));
    write_png(folder / "after.png", image);
    EXPECT_EQ(bytes_of_file(folder / "before.png"), bytes_of_file(folder / "after.png"));
    EXPECT_THAT(failure(folder / "after.png"), HasSubstr("whole numbers"));
}

class SharedEnvironments : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!fs::is_directory(CLSHADE_SHARED_DATA)) {
            GTEST_SKIP() << "the example files are not part of the repository";
        }
    }
    static fs::path file(const std::string& name) { return fs::path(CLSHADE_SHARED_DATA) / name; }
};

TEST_F(SharedEnvironments, AreReadOrRefused) {
    // Sizes and peaks as the README of the examples has them.
    const LatLong studio = read(file("hdri/studio_small_03_1k.hdr"));
    EXPECT_EQ(studio.width, 1024);
    EXPECT_EQ(*std::max_element(studio.rgb.begin(), studio.rgb.end()), 3568.0F);
    const LatLong workshop = read(file("hdri/aerodynamics_workshop_1k.hdr"));
    EXPECT_EQ(*std::max_element(workshop.rgb.begin(), workshop.rgb.end()), 956.0F);
    const LatLong stage = read(file("hdri/StageEnvLatLong.exr"));
    EXPECT_EQ(stage.width, 1000);
    EXPECT_EQ(stage.up, UpAxis::y);
    EXPECT_EQ(*std::max_element(stage.rgb.begin(), stage.rgb.end()), 4096.0F);
    const LatLong orientation = read(file("conformance/tiled/OrientationLatLong_mip.exr"));
    EXPECT_EQ(orientation.width, 1024);
    EXPECT_EQ(orientation.up, UpAxis::y);
    EXPECT_THAT(failure(file("conformance/tiled/WavyLinesCube_mip.exr")), HasSubstr("exrenvmap -l -w 1024"));
    EXPECT_THAT(failure(file("conformance/values/BrightRingsNanInf.exr")), HasSubstr("is 800x800"));
    for (const char* name :
         {"memory_DOS_1.exr", "invalid.exr", "asan_heap-oob_7f4d5.exr", "unfinished_multipart.exr"}) {
        EXPECT_FALSE(failure(file("conformance/damaged") / name).empty()) << name;
    }
    EXPECT_FALSE(failure(file("conformance/lumchroma/XYZ_YC.exr")).empty());
    EXPECT_FALSE(failure(file("conformance/deep/deep_11.exr")).empty());
}

} // namespace
} // namespace clshade
