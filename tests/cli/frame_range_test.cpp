#include "host/base/error.h"
#include "host/cli/frame_range.h"
#include "tests/cli/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace clshade::cli {
namespace {

using ::testing::ElementsAre;
using tests::TemporaryFolder;
using tests::write_bytes;

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
}

TEST(FrameRange, RefusesEverythingElse) {
    for (const char* text :
         {"", "a", "1-", "1-5x0", "1-5x", "1,,2", "1-2-3", "1.5", "1-2000000000", "1-9999999", "99999999999"}) {
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
    EXPECT_EQ(SequencePath::parse("a.%04d.exr")->at(-7), "a.-007.exr");
    EXPECT_EQ(SequencePath::parse("shot#/a.exr")->at(1), "shot0001/a.exr");
    EXPECT_FALSE(SequencePath::parse("a.exr"));
    EXPECT_THROW(static_cast<void>(SequencePath::parse("a.#.b.#.exr")), UsageError);
}

TEST(SequencePath, FindsFilesOnDisk) {
    const TemporaryFolder folder;
    for (const char* name : {"a.0010.exr", "a.0002.exr", "a.12345.exr", "a.7.exr", "a.0003.exr.bak", "b.0001.exr",
                             "a.00x1.exr", "a.-005.exr"}) {
        write_bytes(folder / name, "x");
    }
    EXPECT_THAT(SequencePath::parse((folder / "a.####.exr").string())->existing(), ElementsAre(-5, 2, 10, 12345));
    EXPECT_THAT(SequencePath::parse((folder / "a.%d.exr").string())->existing(), ElementsAre(7, 12345));
    EXPECT_THROW(static_cast<void>(SequencePath::parse((folder / "c.#.exr").string())->existing()), RuntimeFailure);
    EXPECT_THROW(static_cast<void>(SequencePath::parse((folder / "s#/c.exr").string())->existing()), UsageError);
}

TEST(SequencePath, AFileOfThatNameIsNoSequence) {
    const TemporaryFolder folder;
    write_bytes(folder / "take#2.exr", "x");
    EXPECT_FALSE(SequencePath::parse((folder / "take#2.exr").string()));
}

} // namespace
} // namespace clshade::cli
