#include "host/base/frame_range.h"

#include "host/base/error.h"
#include "tests/device/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numeric>

namespace clshade {
namespace {

using ::testing::ElementsAre;
using tests::TemporaryFolder;

void touch(const std::filesystem::path& file) {
    std::ofstream(file) << "x";
}

TEST(FrameRange, Expands) {
    EXPECT_THAT(parse_frames("7"), ElementsAre(7));
    EXPECT_THAT(parse_frames("1-4"), ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(parse_frames("1-10x3"), ElementsAre(1, 4, 7, 10));
    EXPECT_THAT(parse_frames("1-9x3"), ElementsAre(1, 4, 7));
    EXPECT_THAT(parse_frames("1,5,10-12"), ElementsAre(1, 5, 10, 11, 12));
    EXPECT_THAT(parse_frames("-3--1"), ElementsAre(-3, -2, -1));
    EXPECT_THAT(parse_frames("-2-2x2"), ElementsAre(-2, 0, 2));
    EXPECT_THAT(parse_frames("5-1x2"), ElementsAre(5, 3, 1));
    EXPECT_THAT(parse_frames("5-1x-2"), ElementsAre(5, 3, 1));
    EXPECT_THAT(parse_frames("1-3,2-4"), ElementsAre(1, 2, 3, 4)) << "each frame once";
    EXPECT_THAT(parse_frames("3,1,3-1"), ElementsAre(3, 1, 2)) << "in the order written";
    EXPECT_THAT(parse_frames("1-5x2,205"), ElementsAre(1, 3, 5, 205));
    EXPECT_THAT(parse_frames("-10-10x5"), ElementsAre(-10, -5, 0, 5, 10));
    EXPECT_THAT(parse_frames("1--1"), ElementsAre(1, 0, -1));
    EXPECT_THAT(parse_frames("0001-0010x03"), ElementsAre(1, 4, 7, 10)) << "leading zeros mean nothing";
    EXPECT_THAT(parse_frames("-0"), ElementsAre(0));
}

TEST(FrameRange, RefusesEverythingElse) {
    for (const char* text : {"", "a", "1-", "1-5x0", "1-5x", "1,,2", "1-2-3", "1.5", "1-2000000000", "1-9999999",
                             "99999999999", "-2147483648", "1-5x-2147483648"}) {
        EXPECT_THROW(static_cast<void>(parse_frames(text)), UsageError) << text;
    }
}

TEST(Chunks, CoverEveryFrameOnce) {
    std::vector<int> frames(23);
    std::iota(frames.begin(), frames.end(), 1);
    for (const int count : {1, 2, 5, 23, 40}) {
        std::vector<int> all;
        for (int index = 1; index <= count; ++index) {
            const std::vector<int> part = chunk_of(frames, index, count);
            const std::size_t fair = frames.size() / static_cast<std::size_t>(count);
            EXPECT_GE(part.size(), fair);
            EXPECT_LE(part.size(), fair + 1);
            all.insert(all.end(), part.begin(), part.end());
        }
        EXPECT_EQ(all, frames) << count;
    }
}

TEST(Chunks, AreWrittenAsFractions) {
    EXPECT_EQ(parse_chunk("2/8").index, 2);
    EXPECT_EQ(parse_chunk("2/8").count, 8);
    for (const char* text : {"", "2", "0/8", "9/8", "2/0", "-1/2", "1/2/3", "a/b"}) {
        EXPECT_THROW(static_cast<void>(parse_chunk(text)), UsageError) << text;
    }
}

TEST(SequencePath, FillsInTheNumber) {
    EXPECT_EQ(SequencePath::parse("a.#.exr")->at(7), "a.0007.exr");
    EXPECT_EQ(SequencePath::parse("a.####.exr")->at(12345), "a.12345.exr");
    EXPECT_EQ(SequencePath::parse("a.##.exr")->at(7), "a.07.exr");
    EXPECT_EQ(SequencePath::parse("a.%03d.exr")->at(7), "a.007.exr");
    EXPECT_EQ(SequencePath::parse("a.%d.exr")->at(7), "a.7.exr");
    // Negative frames as printf and oiiotool write them: the sign is one of the four.
    EXPECT_EQ(SequencePath::parse("a.%04d.exr")->at(-7), "a.-007.exr");
    EXPECT_EQ(SequencePath::parse("a.#.exr")->at(-7), "a.-007.exr");
    EXPECT_EQ(SequencePath::parse("a.####.exr")->at(-1234), "a.-1234.exr");
    EXPECT_EQ(SequencePath::parse("a.%d.exr")->at(-7), "a.-7.exr");
    EXPECT_EQ(SequencePath::parse("a.%04d.exr")->at(12345), "a.12345.exr") << "wider than its padding";
    EXPECT_EQ(SequencePath::parse("shot#/a.exr")->at(1), "shot0001/a.exr");
    EXPECT_FALSE(SequencePath::parse("a.exr"));
    EXPECT_THROW(static_cast<void>(SequencePath::parse("a.#.b.#.exr")), UsageError);
}

TEST(SequencePath, FindsFilesOnDisk) {
    const TemporaryFolder folder;
    for (const char* name : {"a.0010.exr", "a.0002.exr", "a.12345.exr", "a.7.exr", "a.0003.exr.bak", "b.0001.exr",
                             "a.00x1.exr", "a.-005.exr"}) {
        touch(folder.path() / name);
    }
    EXPECT_THAT(SequencePath::parse((folder.path() / "a.####.exr").string())->existing(),
                ElementsAre(-5, 2, 10, 12345));
    EXPECT_THAT(SequencePath::parse((folder.path() / "a.%d.exr").string())->existing(), ElementsAre(7, 12345));
    EXPECT_THROW(static_cast<void>(SequencePath::parse((folder.path() / "c.#.exr").string())->existing()),
                 RuntimeFailure);
    EXPECT_THROW(static_cast<void>(SequencePath::parse((folder.path() / "s#/c.exr").string())->existing()), UsageError);
}

TEST(SequencePath, AFileOfThatNameIsNoSequence) {
    const TemporaryFolder folder;
    touch(folder.path() / "take#2.exr");
    EXPECT_FALSE(SequencePath::parse((folder.path() / "take#2.exr").string()));
    EXPECT_TRUE(SequencePath::parse_pattern((folder.path() / "take#2.exr").string()));
}

} // namespace
} // namespace clshade
