// The completion stamp: only whole files have one.
#include "host/images/completion.h"
#include "host/images/stamp.h"
#include "tests/images/fixtures.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <limits>
#include <random>
#include <string_view>

namespace clshade {
namespace {

using namespace testing;

/// A small picture with noise in it.
PlaneSlab example(int width, int height) {
    PlaneSlab slab(width, height, 3);
    std::mt19937 random(11);
    for (int plane = 0; plane < 3; ++plane) {
        for (int y = 0; y < height; ++y) {
            for (float& value : slab.row(plane, y)) {
                value = static_cast<float>(random() % 1000U) * 1e-3F;
            }
        }
    }
    return slab;
}

OutputImage image_of(const PlaneSlab& slab) {
    OutputImage image;
    image.data_window = image.display_window = {0, 0, slab.width() - 1, slab.height() - 1};
    image.channels = {{"R", &slab, 0, false}, {"G", &slab, 1, false}, {"B", &slab, 2, false}};
    image.attributes[job_attribute] = "0123456789abcdef0123456789abcdef";
    return image;
}

WrittenFile write(const std::filesystem::path& file, const OutputImage& image, const std::string& compression = "zip") {
    return file.extension() == ".png" ? write_png(file, image) : write_exr(file, image, {true, compression, {}});
}

class CompletionStampOf : public ::testing::TestWithParam<const char*> {};

TEST_P(CompletionStampOf, AWholeFileIsAccepted) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(20, 9);
    const std::filesystem::path file = folder / GetParam();
    OutputImage image = image_of(slab);
    const WrittenFile written = write(file, image);
    const auto stamp = read_completion_stamp(file);
    ASSERT_TRUE(stamp.has_value());
    EXPECT_EQ(stamp->bytes, std::filesystem::file_size(file));
    EXPECT_EQ(stamp->bytes, written.bytes);
    EXPECT_EQ(stamp->hash, written.hash);
    EXPECT_EQ(stamp->job, "0123456789abcdef0123456789abcdef");
    image.attributes.erase(job_attribute);
    const WrittenFile jobless = write(file, image);
    EXPECT_NE(jobless.hash, written.hash);
    ASSERT_TRUE(read_completion_stamp(file).has_value());
    EXPECT_EQ(read_completion_stamp(file)->job, "");
}

TEST_P(CompletionStampOf, EveryCutIsSeen) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(20, 9);
    write(folder / GetParam(), image_of(slab));
    const std::string whole = bytes_of_file(folder / GetParam());
    for (std::size_t length = 0; length < whole.size(); ++length) {
        write_bytes(folder / "cut", whole.substr(0, length));
        ASSERT_FALSE(read_completion_stamp(folder / "cut").has_value()) << length;
    }
    write_bytes(folder / "cut", whole + '\0');
    EXPECT_FALSE(read_completion_stamp(folder / "cut").has_value());
    write_bytes(folder / "cut", whole);
    EXPECT_TRUE(read_completion_stamp(folder / "cut").has_value());
}

TEST_P(CompletionStampOf, EveryOtherByteIsSeen) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(20, 9);
    write(folder / GetParam(), image_of(slab));
    const std::string whole = bytes_of_file(folder / GetParam());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const int flip : {0x01, 0x20, 0xff}) { // 0x20: capitals
            std::string damaged = whole;
            damaged[i] = static_cast<char>(damaged[i] ^ flip);
            write_bytes(folder / "damaged", damaged);
            ASSERT_FALSE(read_completion_stamp(folder / "damaged").has_value()) << i;
        }
    }
}

TEST_P(CompletionStampOf, AFileOfManyPiecesIsAccepted) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(1100, 700);
    const std::filesystem::path file = folder / GetParam();
    write(file, image_of(slab), "none");
    const std::string whole = bytes_of_file(file);
    ASSERT_GT(whole.size(), std::size_t{1} << 20U);
    EXPECT_TRUE(read_completion_stamp(file).has_value());
    for (const std::size_t at : {whole.size() / 2, (std::size_t{1} << 20U) - 1, std::size_t{1} << 20U}) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 4);
        write_bytes(file, damaged);
        EXPECT_FALSE(read_completion_stamp(file).has_value()) << at;
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, CompletionStampOf, ::testing::Values("a.exr", "a.png"),
                         [](const auto& format) { return std::string(format.param).substr(2); });

TEST(CompletionStamp, FilesOfOtherProgramsHaveNone) {
    const TemporaryFolder folder;
    std::vector<Part> parts;
    parts.push_back(make_part({0, 0, 9, 9}, {{"R", Imf::HALF, 0}}));
    write_parts(folder / "other.exr", std::move(parts));
    EXPECT_FALSE(read_completion_stamp(folder / "other.exr").has_value());
    const auto output = OIIO::ImageOutput::create((folder / "other.png").string());
    const std::vector<std::uint8_t> pixels(300, 7);
    ASSERT_TRUE(output->open((folder / "other.png").string(), OIIO::ImageSpec(10, 10, 3, OIIO::TypeDesc::UINT8)));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && output->close());
    EXPECT_FALSE(read_completion_stamp(folder / "other.png").has_value());
}

TEST(CompletionStamp, WhatIsNoFileHasNone) {
    const TemporaryFolder folder;
    write_bytes(folder / "empty", "");
    std::filesystem::create_directory(folder / "folder");
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    std::filesystem::create_symlink("nowhere", folder / "link");
    for (const char* name : {"empty", "folder", "pipe", "link", "missing", "missing/file"}) {
        EXPECT_FALSE(read_completion_stamp(folder / name).has_value()) << name;
    }
    EXPECT_FALSE(read_completion_stamp("/dev/zero").has_value());
    EXPECT_FALSE(read_completion_stamp("").has_value());
}

TEST(CompletionStamp, ClaimsOfAHeaderCostNothing) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(20, 9);
    write(folder / "a.exr", image_of(slab));
    const std::string whole = bytes_of_file(folder / "a.exr");
    const std::size_t attribute = whole.find("channels");
    ASSERT_NE(attribute, std::string::npos);
    for (const std::uint32_t claim : {0x7fffffffU, 0x80000000U, 0xffffffffU, 1U << 20U}) {
        std::string damaged = whole;
        damaged.replace(attribute + std::string("channels").size() + 1 + std::string("chlist").size() + 1, 4,
                        reinterpret_cast<const char*>(&claim), 4);
        write_bytes(folder / "b.exr", damaged);
        EXPECT_FALSE(read_completion_stamp(folder / "b.exr").has_value()) << claim;
    }
    for (const std::string& text :
         {stamp_text({whole.size(), std::numeric_limits<std::uint64_t>::max(), 1}), stamp_text({whole.size(), 0, 1})}) {
        std::string damaged = whole;
        damaged.replace(damaged.find("bytes="), stamp_length, text);
        write_bytes(folder / "b.exr", damaged);
        EXPECT_FALSE(read_completion_stamp(folder / "b.exr").has_value());
    }
}

TEST(CompletionStamp, TextIsReadAsItIsWrittenAndNotOtherwise) {
    const Stamp stamp{123, std::numeric_limits<std::uint64_t>::max(), 0xfedcba9876543210U};
    const std::string text = stamp_text(stamp);
    ASSERT_EQ(text, "bytes=00000000000000000123 head=18446744073709551615 xxh3=fedcba9876543210");
    const auto parsed = parse_stamp(text);
    ASSERT_TRUE(parsed.has_value());
    EXPECT_EQ(parsed->bytes, stamp.bytes);
    EXPECT_EQ(parsed->head, stamp.head);
    EXPECT_EQ(parsed->hash, stamp.hash);
    EXPECT_FALSE(parse_stamp("").has_value());
    EXPECT_FALSE(parse_stamp(text + "0").has_value());
    EXPECT_FALSE(parse_stamp("bytes=00000000000000000123 head=18446744073709551616 xxh3=fedcba9876543210"));
    EXPECT_FALSE(parse_stamp("bytes=00000000000000000123 head=99999999999999999999 xxh3=fedcba9876543210"));
    EXPECT_FALSE(parse_stamp("bytes=0000000000000000012a head=18446744073709551615 xxh3=fedcba9876543210"));
    EXPECT_FALSE(parse_stamp("bytes=00000000000000000123 head=18446744073709551615 xxh3=FEDCBA9876543210"));
    EXPECT_FALSE(parse_stamp("bytes=00000000000000000123 head=18446744073709551615 xxh3=gedcba9876543210"));
}

TEST(CompletionStamp, StaysTextThatOtherProgramsCanRead) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(20, 9);
    OutputImage image = image_of(slab);
    image.attributes[completion_attribute] = "of the caller: not ours"; // replaced
    const WrittenFile written = write(folder / "a.exr", image);
    const std::string text = read_layout(folder / "a.exr").strings.at(completion_attribute);
    EXPECT_TRUE(read_completion_stamp(folder / "a.exr").has_value());
    ASSERT_TRUE(parse_stamp(text).has_value());
    EXPECT_EQ(parse_stamp(text)->hash, written.hash);
    // The definition of completion.h, by other means.
    std::string bytes = bytes_of_file(folder / "a.exr");
    bytes.replace(bytes.find("xxh3=") + 5, 16, std::string(16, '0'));
    const auto head = static_cast<std::size_t>(parse_stamp(text)->head);
    const std::string order = bytes.substr(head) + bytes.substr(0, head);
    EXPECT_EQ(XXH3_64bits(order.data(), order.size()), written.hash);
    EXPECT_EQ(parse_stamp(text)->bytes, bytes.size());
}

/// The PNG specification's checksum, bit by bit.
std::uint32_t slow_crc(std::string_view bytes) {
    std::uint32_t crc = 0xffffffffU;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
        }
    }
    return ~crc;
}

std::uint32_t big_endian(std::string_view bytes) {
    std::uint32_t value = 0;
    for (const char c : bytes.substr(0, 4)) {
        value = value << 8U | static_cast<unsigned char>(c);
    }
    return value;
}

TEST(CompletionStamp, APngIsInOrder) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(20, 9);
    const OutputImage image = image_of(slab);
    write(folder / "a.png", image);
    const std::string bytes = bytes_of_file(folder / "a.png");
    std::vector<std::string> chunks;
    for (std::string_view left = std::string_view(bytes).substr(8); left.size() >= 12;) {
        const std::size_t length = big_endian(left);
        ASSERT_LE(length + 12, left.size());
        const std::string_view chunk = left.substr(4, length + 4);
        EXPECT_EQ(big_endian(left.substr(length + 8)), slow_crc(chunk));
        chunks.emplace_back(chunk);
        left.remove_prefix(length + 12);
    }
    ASSERT_GE(chunks.size(), 5U);
    EXPECT_EQ(chunks.front().substr(0, 4), "IHDR");
    EXPECT_EQ(chunks[chunks.size() - 3], std::string("tEXtclshade/job") + '\0' + image.attributes.at(job_attribute));
    EXPECT_EQ(chunks[chunks.size() - 2].substr(0, 21), std::string("tEXtclshade/complete") + '\0');
    EXPECT_TRUE(parse_stamp(chunks[chunks.size() - 2].substr(21)).has_value());
    EXPECT_EQ(chunks.back(), "IEND");
    const auto input = OIIO::ImageInput::open((folder / "a.png").string());
    ASSERT_NE(input, nullptr);
    std::vector<std::uint8_t> pixels(540);
    EXPECT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data())) << input->geterror();
}

TEST(CompletionStamp, AnExistingPngStaysIfItMayNotBeReplaced) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example(20, 9);
    EXPECT_FALSE(write_png(folder / "a.png", image_of(slab), Replace::no).existed);
    write_bytes(folder / "a.png", "of somebody else");
    EXPECT_TRUE(write_png(folder / "a.png", image_of(slab), Replace::no).existed);
    EXPECT_EQ(bytes_of_file(folder / "a.png"), "of somebody else");
    EXPECT_EQ(folder.names().size(), 1U);
}

} // namespace
} // namespace clshade
