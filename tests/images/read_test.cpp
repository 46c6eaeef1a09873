// Whole files: every way the pixels can lie in them must give the same planes.
#include "tests/images/fixtures.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

namespace clshade {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::vector<PartChannel> mixed{{"A", Imf::HALF, 0}, {"Z", Imf::FLOAT, 1}, {"id", Imf::UINT, 2}};

/// Every pixel of every channel holds its pattern inside the part's window and 0 elsewhere, the padding too.
void expect_pattern(const Picture& picture, const std::vector<PartChannel>& channels, const Window& window) {
    const PlaneSlab& planes = picture.plan.frame.planes;
    const Window& frame = picture.plan.frame.data_window;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        for (int y = 0; y < planes.height(); ++y) {
            for (int x = 0; x < planes.pitch(); ++x) {
                const int file_x = x + frame.x_min;
                const int file_y = y + frame.y_min;
                const bool inside = file_x >= window.x_min && file_x <= window.x_max && file_y >= window.y_min &&
                                    file_y <= window.y_max;
                const float value = planes.plane(
                    static_cast<int>(i))[static_cast<std::size_t>(y) * static_cast<std::size_t>(planes.pitch()) +
                                         static_cast<std::size_t>(x)];
                ASSERT_EQ(value, inside ? pattern(channels[i].number, file_x, file_y) : 0.0F)
                    << channels[i].name << " at " << file_x << ", " << file_y;
            }
        }
    }
}

class Compressions : public ::testing::TestWithParam<Imf::Compression> {};

// B44 and DWA lose precision in half channels; they are held to a bound below.
TEST_P(Compressions, ScanLinesReadBackExactly) {
    const TemporaryFolder folder;
    const Window window{-5, 3, 45, 40}; // odd width, height no multiple of any block
    for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
        Part part = make_part(window, mixed, GetParam());
        part.header.lineOrder() = order;
        write_parts(folder / "a.exr", {part});
        for (const int threads : {1, 3}) {
            const Picture picture = read_picture(folder / "a.exr", threads);
            EXPECT_EQ(picture.layout.parts[0].data_window, window);
            EXPECT_EQ(picture.layout.display_window, (Window{0, 0, 63, 47}));
            expect_pattern(picture, mixed, window);
        }
    }
}

TEST_P(Compressions, TilesReadBackExactly) {
    const TemporaryFolder folder;
    const Window window{-5, 3, 45, 40};
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
        for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::RANDOM_Y}) {
            Part part = make_part(window, mixed, GetParam());
            tile(part, 16, 8, mode, order);
            write_parts(folder / "a.exr", {part});
            const Picture picture = read_picture(folder / "a.exr", 2);
            EXPECT_TRUE(picture.layout.parts[0].tiled);
            expect_pattern(picture, mixed, window);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Lossless, Compressions,
                         ::testing::Values(Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                           Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION));

TEST(Read, LossyCompressionsComeClose) {
    const TemporaryFolder folder;
    const Window window{0, 0, 39, 39};
    for (const Imf::Compression compression :
         {Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION}) {
        write_parts(folder / "a.exr", {make_part(window, {{"Z", Imf::FLOAT, 1}, {"id", Imf::UINT, 2}}, compression)});
        const Picture picture = read_picture(folder / "a.exr");
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 40; ++x) {
                // PXR24 keeps 16 bits of a float's mantissa, enough for whole numbers; the others leave Z and ids
                // alone.
                ASSERT_EQ(picture.at(0, x, y), pattern(1, x, y)) << compression;
                ASSERT_EQ(picture.at(1, x, y), pattern(2, x, y)) << compression;
            }
        }
    }
}

TEST(Read, OnlyTheChannelsAskedFor) {
    const TemporaryFolder folder;
    const Window window{0, 0, 30, 20};
    for (const Imf::Compression compression : {Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        write_parts(folder / "a.exr", {make_part(window, mixed, compression)});
        const Picture picture = read_picture(folder / "a.exr", 1, {"id", "A"}); // not in the file's order
        expect_pattern(picture, {mixed[2], mixed[0]}, window);
    }
}

TEST(Read, PartsWithDifferentWindowsAreOffsetIntoTheFrame) {
    const Window small{10, 12, 20, 30};
    const Window large{-8, -2, 40, 21};
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        for (const bool tiled : {false, true}) {
            const TemporaryFolder folder;
            Part first = make_part(small, {{"N.X", Imf::FLOAT, 3}}, compression, "first");
            Part second = make_part(large, {{"P.X", Imf::HALF, 4}}, compression, "second");
            tile(tiled ? first : second, 16, 8); // one of each kind
            write_parts(folder / "a.exr", {first, second});
            const Picture both = read_picture(folder / "a.exr", 2);
            EXPECT_EQ(both.plan.frame.data_window, (Window{-8, -2, 40, 30}));
            EXPECT_EQ(both.at(0, 10, 12), pattern(3, 10, 12));
            EXPECT_EQ(both.at(1, 40, -2), pattern(4, 40, -2));
            expect_pattern(read_picture(folder / "a.exr", 1, {"N.X"}), {{"N.X", Imf::FLOAT, 3}}, small);
            expect_pattern(read_picture(folder / "a.exr", 1, {"P.X"}), {{"P.X", Imf::HALF, 4}}, large);
        }
    }
}

TEST(Read, EveryHalfIsWidenedExactly) {
    const TemporaryFolder folder;
    PlaneSlab slab(256, 256, 1);
    std::vector<float> expected;
    for (unsigned bits = 0; bits < 65536; ++bits) {
        half value;
        value.setBits(static_cast<unsigned short>(bits));
        expected.push_back(value);
        slab.at(0, static_cast<int>(bits % 256), static_cast<int>(bits / 256)) = value;
    }
    OutputImage image;
    image.data_window = image.display_window = {0, 0, 255, 255};
    image.channels.push_back({"v", &slab, 0, false});
    for (const char* compression : {"none", "zip", "piz"}) {
        EXPECT_EQ(write_exr(folder / "a.exr", image, {true, compression, {}}).clamped, 0U);
        const Picture picture = read_picture(folder / "a.exr");
        for (unsigned bits = 0; bits < 65536; ++bits) {
            const float got = picture.at(0, static_cast<int>(bits % 256), static_cast<int>(bits / 256));
            if (std::isnan(expected[bits])) {
                ASSERT_TRUE(std::isnan(got));
            } else {
                ASSERT_EQ(std::bit_cast<std::uint32_t>(got), std::bit_cast<std::uint32_t>(expected[bits]))
                    << bits << " " << compression;
            }
        }
    }
}

TEST(Read, HeaderValuesArriveRaw) {
    const TemporaryFolder folder;
    Part part = make_part({0, 0, 3, 3}, mixed);
    Imath::M44f matrix(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
    part.header.insert("worldToCamera", Imf::M44fAttribute(matrix));
    part.header.insert("other", Imf::M44dAttribute(Imath::M44d(matrix)));
    part.header.insert("CameraFov", Imf::FloatAttribute(45.5F));
    part.header.insert("samples", Imf::IntAttribute(7));
    part.header.insert("arnold/color_space", Imf::StringAttribute("ACEScg"));
    part.header.insert("chromaticities",
                       Imf::ChromaticitiesAttribute(Imf::Chromaticities({0.713F, 0.293F}, {0.165F, 0.83F},
                                                                        {0.128F, 0.044F}, {0.32168F, 0.33767F})));
    part.header.insert("name", Imf::StringAttribute("stray"));
    write_parts(folder / "a.exr", {part});
    const ImageLayout layout = read_layout(folder / "a.exr");
    EXPECT_EQ(layout.file, (folder / "a.exr").string());
    EXPECT_EQ(layout.matrices.at("worldToCamera")[0][3], 4.0);
    EXPECT_EQ(layout.matrices.at("worldToCamera")[3][0], 13.0); // the translation of a row vector
    EXPECT_EQ(layout.matrices.at("other")[3][0], 13.0);
    EXPECT_EQ(layout.numbers.at("CameraFov"), 45.5);
    EXPECT_EQ(layout.numbers.at("samples"), 7.0);
    EXPECT_EQ(layout.strings.at("arnold/color_space"), "ACEScg");
    EXPECT_THAT(layout.strings.at("chromaticities"), HasSubstr("0.713 0.293"));
    EXPECT_EQ(layout.parts[0].name, "");
    EXPECT_EQ(layout.parts[0].compression, "zip");
    EXPECT_THAT(layout.warnings, IsEmpty());
    EXPECT_EQ(layout.channels[0].type, SampleType::half);
    EXPECT_EQ(layout.channels[1].type, SampleType::float32);
    EXPECT_EQ(layout.channels[2].type, SampleType::uint32);
}

TEST(Read, Rec709ChromaticitiesAreNotWorthAWord) {
    const TemporaryFolder folder;
    Part part = make_part({0, 0, 3, 3}, mixed);
    part.header.insert("chromaticities", Imf::ChromaticitiesAttribute(Imf::Chromaticities()));
    write_parts(folder / "a.exr", {part});
    EXPECT_EQ(read_layout(folder / "a.exr").strings.count("chromaticities"), 0U);
}

TEST(Read, MultiViewOfTheWrongTypeIsAWarning) {
    const TemporaryFolder folder;
    Part part = make_part({0, 0, 3, 3}, mixed);
    part.header.insert("multiView", Imf::StringAttribute("left"));
    part.header.insert("view", Imf::IntAttribute(1));
    write_parts(folder / "a.exr", {part});
    const Picture picture = read_picture(folder / "a.exr");
    EXPECT_THAT(picture.layout.warnings, ElementsAre(HasSubstr("multiView"), HasSubstr("view")));
    EXPECT_THAT(picture.layout.views, IsEmpty());
}

TEST(Read, StereoInOnePart) {
    const TemporaryFolder folder;
    Part part = make_part({0, 0, 3, 3}, {{"VL.Depth.left.Z", Imf::FLOAT, 0}, {"VL.Depth.right.Z", Imf::FLOAT, 1}});
    part.header.insert("multiView", Imf::StringVectorAttribute({"left", "right"}));
    write_parts(folder / "a.exr", {part});
    const Picture picture = read_picture(folder / "a.exr");
    EXPECT_THAT(picture.layout.views, ElementsAre("left", "right"));
    EXPECT_EQ(picture.layout.channels[0].name, "VL.Depth.Z");
    EXPECT_EQ(picture.layout.channels[0].view, "left");
    EXPECT_EQ(picture.layout.channels[1].name, "VL.Depth.right.Z");
    EXPECT_EQ(picture.layout.channels[1].view, "right");
    EXPECT_EQ(picture.at(1, 2, 2), pattern(1, 2, 2));
}

/// Planes against OpenImageIO's reading of the same file, bit by bit.
void expect_as_openimageio(const std::filesystem::path& file) {
    const Picture picture = read_picture(file, 2);
    const auto input = OIIO::ImageInput::open(file.string());
    ASSERT_NE(input, nullptr) << OIIO::geterror();
    std::size_t compared = 0;
    for (int part = 0; part < static_cast<int>(picture.layout.parts.size()); ++part) {
        const OIIO::ImageSpec spec = input->spec(part);
        const auto count = static_cast<std::size_t>(spec.nchannels);
        std::vector<float> pixels(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) * count);
        ASSERT_TRUE(input->read_image(part, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()));
        for (std::size_t i = 0; i < picture.layout.channels.size(); ++i) {
            const ChannelInfo& channel = picture.layout.channels[i];
            if (channel.part != part) {
                continue;
            }
            const int c = spec.channelindex(channel.file_name);
            ASSERT_GE(c, 0) << channel.file_name;
            const float* expected = pixels.data() + c;
            for (int y = 0; y < spec.height; ++y) {
                for (int x = 0; x < spec.width; ++x, expected += count, ++compared) {
                    const float got = picture.at(static_cast<int>(i), x + spec.x, y + spec.y);
                    ASSERT_TRUE(got == *expected || (std::isnan(got) && std::isnan(*expected)))
                        << file << " " << channel.name << " " << x << " " << y << ": " << got << " " << *expected;
                }
            }
        }
    }
    EXPECT_GT(compared, 0U);
}

TEST(Read, BlenderCropsAgreeWithOpenImageIO) {
    for (const char* name : {"room_crop.exr", "suzanne_crop.exr", "fileoutput_crop.exr"}) {
        expect_as_openimageio(std::filesystem::path(CLSHADE_TEST_DATA) / name);
    }
    const ImageLayout layout = read_layout(std::filesystem::path(CLSHADE_TEST_DATA) / "room_crop.exr");
    EXPECT_EQ(layout.parts[0].data_window, (Window{240, 150, 399, 245}));
    EXPECT_EQ(layout.display_window, (Window{0, 0, 639, 359}));
    EXPECT_EQ(layout.channels[static_cast<std::size_t>(index_of(layout, "ViewLayer.Normal.Y"))].file_name,
              "ViewLayer.Normal.Y");
}

TEST(Read, SharedFilesAgreeWithOpenImageIO) {
    const std::filesystem::path shared(CLSHADE_SHARED_DATA);
    if (!std::filesystem::exists(shared)) {
        GTEST_SKIP() << "no example files beside the repository";
    }
    for (const char* folder :
         {"blender", "conformance/layers", "conformance/tiled", "conformance/window", "conformance/values"}) {
        for (const auto& entry : std::filesystem::directory_iterator(shared / folder)) {
            if (entry.path().extension() == ".exr" && entry.path().string().find("720p") == std::string::npos) {
                expect_as_openimageio(entry.path());
            }
        }
    }
}

TEST(Read, AFileThatChangedInBetweenIsNoticed) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr", {make_part({0, 0, 30, 20}, mixed)});
    Picture picture = read_picture(folder / "a.exr");
    write_parts(folder / "a.exr", {make_part({0, 0, 60, 20}, mixed)});
    EXPECT_THAT(failure_of([&] { read_planes(folder / "a.exr", picture.layout, picture.plan, 1); }),
                HasSubstr("changed while it was being read"));
}

} // namespace
} // namespace clshade
