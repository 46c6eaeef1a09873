// Hostile, broken and unsuitable files: one clear failure, at once, and no memory to speak of.
#include "tests/images/fixtures.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <random>

namespace clshade {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Reads everything; true when that worked, false for a RuntimeFailure that names the file in one line.
bool reads(const std::filesystem::path& file) {
    try {
        static_cast<void>(read_picture(file, 1));
        return true;
    } catch (const RuntimeFailure& failure) {
        const std::string message = failure.what();
        EXPECT_THAT(message, AllOf(HasSubstr(file.string()), Not(HasSubstr("\n")), HasSubstr("; ")));
        EXPECT_THAT(message, Not(HasSubstr("internal")));
        return false;
    }
}

std::string failure(const std::filesystem::path& file) {
    return failure_of([&] { static_cast<void>(read_picture(file, 1)); });
}

std::string example(Imf::Compression compression, bool tiled = false) {
    const TemporaryFolder folder;
    Part part =
        make_part({-3, 2, 20, 29}, {{"N.X", Imf::HALF, 0}, {"Z", Imf::FLOAT, 1}, {"id", Imf::UINT, 2}}, compression);
    if (tiled) {
        tile(part, 8, 8, Imf::MIPMAP_LEVELS);
    }
    write_parts(folder / "a.exr", {part});
    return bytes_of_file(folder / "a.exr");
}

std::string two_parts() {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr", {make_part({0, 0, 9, 9}, {{"Z", Imf::FLOAT, 1}}, Imf::ZIP_COMPRESSION, "depth"),
                                   make_part({0, 0, 9, 9}, {{"N.X", Imf::HALF, 0}}, Imf::PIZ_COMPRESSION, "normal")});
    return bytes_of_file(folder / "a.exr");
}

TEST(Damaged, NotAFile) {
    const TemporaryFolder folder;
    EXPECT_THAT(failure(folder / "missing.exr"), HasSubstr("no such file"));
    EXPECT_THAT(failure(folder.path()), HasSubstr("is a folder"));
    EXPECT_THAT(failure("/dev/null"), HasSubstr("not a regular file"));
    ASSERT_EQ(::mkfifo((folder / "pipe.exr").c_str(), 0600), 0);
    EXPECT_THAT(failure(folder / "pipe.exr"), HasSubstr("not a regular file")); // and does not wait for a writer
}

TEST(Damaged, NoPermission) {
    const TemporaryFolder folder;
    write_bytes(folder / "a.exr", example(Imf::ZIP_COMPRESSION));
    std::filesystem::permissions(folder / "a.exr", std::filesystem::perms::none);
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
    EXPECT_EQ(as_common_user(
                  [&] { return failure(folder / "a.exr").find("check the permissions") != std::string::npos ? 0 : 1; }),
              0);
}

TEST(Damaged, NotAnExr) {
    const TemporaryFolder folder;
    write_bytes(folder / "empty.exr", "");
    write_bytes(folder / "text.exr", "version = 1\n# a scene, not an image\n");
    write_bytes(folder / "short.exr", "v/1");
    write_bytes(folder / "magic.exr", std::string("v/1\x01", 4));
    EXPECT_THAT(failure(folder / "empty.exr"), HasSubstr("is empty"));
    EXPECT_THAT(failure(folder / "text.exr"), HasSubstr("is not an OpenEXR file"));
    EXPECT_THAT(failure(folder / "short.exr"), HasSubstr("is not an OpenEXR file"));
    EXPECT_THAT(failure(folder / "magic.exr"), HasSubstr("header is damaged or incomplete"));
}

TEST(Damaged, SubsampledChannelsAreNamed) {
    const TemporaryFolder folder;
    Imf::Header header(16, 16);
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
    std::vector<std::uint16_t> zeros(256, 0);
    auto* base = reinterpret_cast<char*>(zeros.data());
    {
        Imf::OutputFile output((folder / "a.exr").c_str(), header);
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice(Imf::HALF, base, 2, 32));
        buffer.insert("RY", Imf::Slice(Imf::HALF, base, 2, 16, 2, 2));
        output.setFrameBuffer(buffer);
        output.writePixels(16);
    }
    EXPECT_THAT(failure(folder / "a.exr"), AllOf(HasSubstr("channel 'RY' is subsampled 2x2"), HasSubstr("convert")));
}

TEST(Damaged, DeepImagesAreRefused) {
    const TemporaryFolder folder;
    Imf::Header header(4, 4);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    std::vector<unsigned> counts(16, 0);
    std::vector<float*> samples(16, nullptr);
    {
        Imf::DeepScanLineOutputFile output((folder / "a.exr").c_str(), header);
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(
            Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), 4 * sizeof(unsigned)));
        buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), sizeof(float*),
                                          4 * sizeof(float*), sizeof(float)));
        output.setFrameBuffer(buffer);
        output.writePixels(4);
    }
    EXPECT_THAT(failure(folder / "a.exr"), AllOf(HasSubstr("deep image"), HasSubstr("flatten it first")));
}

/// A file cut anywhere, in the header, in the table of chunks or in the pixels, must fail: something is missing.
TEST(Damaged, EveryTruncationFails) {
    const TemporaryFolder folder;
    for (const std::string& whole :
         {example(Imf::ZIP_COMPRESSION), example(Imf::PIZ_COMPRESSION), example(Imf::NO_COMPRESSION), two_parts()}) {
        write_bytes(folder / "a.exr", whole);
        ASSERT_TRUE(reads(folder / "a.exr"));
        for (std::size_t size = whole.size(); size-- > 0;) {
            std::filesystem::resize_file(folder / "a.exr", size);
            ASSERT_FALSE(reads(folder / "a.exr")) << "cut to " << size << " of " << whole.size();
        }
    }
}

/// Bytes changed at seeded places: a failure or a picture, never a crash.
TEST(Damaged, FlippedBytesNeverCrash) {
    const TemporaryFolder folder;
    std::mt19937 random(20240607);
    std::size_t failed = 0;
    for (const std::string& whole :
         {example(Imf::ZIP_COMPRESSION), example(Imf::ZIPS_COMPRESSION, true), example(Imf::NO_COMPRESSION),
          example(Imf::PIZ_COMPRESSION), example(Imf::RLE_COMPRESSION), example(Imf::PXR24_COMPRESSION),
          example(Imf::B44_COMPRESSION), example(Imf::DWAA_COMPRESSION), two_parts(),
          example(Imf::NO_COMPRESSION, true), example(Imf::PXR24_COMPRESSION, true),
          example(Imf::B44A_COMPRESSION, true)}) {
        for (int round = 0; round < 400; ++round) {
            std::string broken = whole;
            const int changes = 1 + static_cast<int>(random() % 4);
            for (int i = 0; i < changes; ++i) {
                // Half of the changes hit the header and the table of chunks, where the sizes stand.
                const std::size_t range = (round % 2 == 0) ? std::min<std::size_t>(whole.size(), 400) : whole.size();
                broken[4 + random() % (range - 4)] = static_cast<char>(random() % 4 == 0 ? 0xff : random() % 256);
            }
            write_bytes(folder / "a.exr", broken);
            failed += reads(folder / "a.exr") ? 0 : 1;
        }
    }
    EXPECT_GT(failed, 1000U); // of 4800: most changes are noticed
}

/// Replaces the value of a box2i attribute.
std::string with_window(std::string bytes, const std::string& attribute, std::int32_t x_min, std::int32_t y_min,
                        std::int32_t x_max, std::int32_t y_max) {
    const std::string tag = attribute + std::string(1, '\0') + "box2i" + std::string(1, '\0');
    const std::size_t at = bytes.find(tag);
    EXPECT_NE(at, std::string::npos);
    const std::int32_t values[4] = {x_min, y_min, x_max, y_max};
    std::memcpy(bytes.data() + at + tag.size() + 4, values, sizeof(values));
    return bytes;
}

TEST(Damaged, ZeroSizedAndInvertedWindows) {
    const TemporaryFolder folder;
    const std::string whole = example(Imf::ZIP_COMPRESSION);
    for (const char* attribute : {"dataWindow", "displayWindow"}) {
        write_bytes(folder / "a.exr", with_window(whole, attribute, 0, 0, -1, 29));
        EXPECT_THAT(failure(folder / "a.exr"), HasSubstr("window"));
        write_bytes(folder / "a.exr", with_window(whole, attribute, 10, 10, 0, 0));
        EXPECT_THAT(failure(folder / "a.exr"), HasSubstr("window"));
    }
}

/// 0: the file is refused within a second and 64 MiB.
int fails_in_bounds(const std::filesystem::path& file) {
    return in_child([&] {
        rusage before{};
        ::getrusage(RUSAGE_SELF, &before);
        const auto start = std::chrono::steady_clock::now();
        const bool read = reads(file);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        rusage after{};
        ::getrusage(RUSAGE_SELF, &after);
        const std::int64_t grown_kib = after.ru_maxrss - before.ru_maxrss;
        return read ? 1 : (seconds > 1.0 ? 2 : (grown_kib > std::int64_t{65536} ? 3 : 0));
    });
}

TEST(Damaged, HugeClaimsCostNothing) {
    const TemporaryFolder folder;
    for (const bool tiled : {false, true}) {
        for (const Imf::Compression compression :
             {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAB_COMPRESSION}) {
            const std::string whole = example(compression, tiled);
            write_bytes(folder / "high.exr", with_window(whole, "dataWindow", 0, 0, 20, 452984832));
            EXPECT_EQ(fails_in_bounds(folder / "high.exr"), 0);
            write_bytes(folder / "wide.exr", with_window(whole, "dataWindow", 0, 0, 900000000, 27));
            EXPECT_EQ(fails_in_bounds(folder / "wide.exr"), 0);
            write_bytes(folder / "both.exr",
                        with_window(whole, "dataWindow", -1000000000, -1000000000, 1000000000, 1000000000));
            EXPECT_EQ(fails_in_bounds(folder / "both.exr"), 0);
        }
    }
}

TEST(Damaged, AMissingChunkIsNotFilledWithZeros) {
    const TemporaryFolder folder;
    std::string bytes = example(Imf::ZIPS_COMPRESSION);
    // The table of chunks stands after the zero byte that ends the header; its first entry points just behind it.
    const std::size_t chunks = 28;
    std::size_t table = 0;
    for (std::size_t at = 8; at + 8 * chunks < bytes.size() && table == 0; ++at) {
        std::uint64_t first = 0;
        std::memcpy(&first, bytes.data() + at, sizeof(first));
        table = first == at + 8 * chunks ? at : 0;
    }
    ASSERT_NE(table, 0U);
    std::memset(bytes.data() + table + std::size_t{40}, 0, 8);
    write_bytes(folder / "a.exr", bytes);
    EXPECT_THAT(failure(folder / "a.exr"), HasSubstr("incomplete: 1 of 28 chunks"));
}

TEST(Damaged, ExampleFiles) {
    const std::filesystem::path shared = std::filesystem::path(CLSHADE_SHARED_DATA) / "conformance";
    if (!std::filesystem::exists(shared)) {
        GTEST_SKIP() << "no example files beside the repository";
    }
    const std::vector<std::pair<std::string, std::string>> expected{
        {"damaged/memory_DOS_1.exr", "452984833 chunks"},
        {"damaged/invalid.exr", "not an OpenEXR file"},
        {"damaged/asan_heap-oob_7f4d5.exr", "damaged"},
        {"damaged/unfinished_multipart.exr", "incomplete: part 'Part"},
        {"deep/deep_11.exr", "deep image"},
        {"lumchroma/XYZ_YC.exr", "channel 'BY' is subsampled"},
    };
    for (const auto& [name, message] : expected) {
        EXPECT_THAT(failure(shared / name), HasSubstr(message));
        EXPECT_EQ(fails_in_bounds(shared / name), 0) << name;
    }
}

} // namespace
} // namespace clshade
