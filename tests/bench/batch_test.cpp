// Whole runs on tiny sequences: what the made-up sequence holds, that every rival does the same work, and the rows.
#include "bench/batch_bench.h"
#include "bench/batch_folder.h"
#include "bench/batch_library_rival.h"
#include "bench/batch_oiio_rival.h"
#include "bench/batch_ours.h"
#include "bench/batch_rows.h"
#include "bench/batch_sequence.h"
#include "host/base/error.h"
#include "host/gbuffer/camera.h"
#include "host/images/image_reader.h"
#include "host/images/image_writer.h"
#include "tests/device/temporary_folder.h"

#include <glm/glm.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace clshade {
namespace {

namespace fs = std::filesystem;

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int width = 96;
constexpr int height = 54;

Device cpu() {
    return Device(select_device(list_devices(), "cpu"));
}

int plane_of(const std::string& channel) {
    const auto all = sequence_channels();
    return static_cast<int>(std::find(all.begin(), all.end(), channel) - all.begin());
}

PlaneSlab whole_frame(int index) {
    PlaneSlab planes(width, height, 16);
    fill_sequence_band(planes, 0, height, index);
    return planes;
}

glm::dvec3 vector_at(const PlaneSlab& planes, const std::string& layer, int x, int y) {
    return {planes.at(plane_of(layer + ".X"), x, y), planes.at(plane_of(layer + ".Y"), x, y),
            planes.at(plane_of(layer + ".Z"), x, y)};
}

/// A sequence of three frames on disk.
class Sequence {
  public:
    Sequence(bool half, const std::string& compression) : folder_(3) {
        for (std::size_t i = 0; i < folder_.inputs().size(); ++i) {
            write_sequence_frame(folder_.inputs()[i], {width, height, half, compression}, static_cast<int>(i));
        }
    }
    [[nodiscard]] const BatchFolder& files() const { return folder_; }
    [[nodiscard]] const fs::path& first() const { return folder_.inputs().front(); }

  private:
    BatchFolder folder_;
};

TEST(BatchSequence, HasSurfacesAndSkyAndSmallWholeIds) {
    const PlaneSlab planes = whole_frame(0);
    std::set<float> ids;
    int sky = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float coverage = planes.at(plane_of("coverage"), x, y);
            const float id = planes.at(plane_of("material_id"), x, y);
            ids.insert(id);
            ASSERT_EQ(id, std::round(id));
            if (coverage == 0.0F) {
                ++sky;
                EXPECT_EQ(planes.at(plane_of("Z"), x, y), 65504.0F);
                continue;
            }
            ASSERT_EQ(coverage, 1.0F);
            // One rounding of a float in each component.
            ASSERT_NEAR(glm::length(vector_at(planes, "N", x, y)), 1.0, 1e-6);
            ASSERT_GE(planes.at(plane_of("roughness"), x, y), 0.2F) << "oiio_tolerance counts on exponents up to 1250";
        }
    }
    EXPECT_GT(sky, width * height / 20);
    EXPECT_LT(sky, width * height / 2);
    EXPECT_GE(ids.size(), 4U);
    EXPECT_LE(*ids.rbegin(), 5.0F);
}

TEST(BatchSequence, BandsMakeTheWholeAndFramesDiffer) {
    const PlaneSlab whole = whole_frame(1);
    PlaneSlab band(width, 10, 16);
    fill_sequence_band(band, 20, height, 1);
    const PlaneSlab other = whole_frame(2);
    int differing = 0;
    for (int p = 0; p < 16; ++p) {
        for (int y = 0; y < 10; ++y) {
            for (int x = 0; x < width; ++x) {
                ASSERT_EQ(band.at(p, x, y), whole.at(p, x, 20 + y)) << p << ' ' << x << ' ' << y;
                differing += other.at(p, x, 20 + y) != whole.at(p, x, 20 + y) ? 1 : 0;
            }
        }
    }
    EXPECT_GT(differing, 1000);
}

TEST(BatchSequence, TheHeaderHasTheCameraThatSawIt) {
    const Sequence sequence(false, "none");
    const ImageLayout layout = read_layout(sequence.files().inputs()[2]);
    const auto view = view_from_header(layout, layout.parts.front().data_window);
    ASSERT_TRUE(view.has_value());
    ASSERT_TRUE(view->has_rays);
    const PlaneSlab planes = whole_frame(2);
    for (const auto& [x, y] : {std::pair{5, 50}, {48, 30}, {90, 40}}) {
        const double depth = static_cast<double>(planes.at(plane_of("Z"), x, y));
        const glm::dvec3 seen =
            view->eye + depth * (view->direction + (x + 0.5) * view->direction_dx + (y + 0.5) * view->direction_dy);
        // Matrices and planes are floats: a few of their roundings, 10 units away.
        EXPECT_LT(glm::distance(seen, vector_at(planes, "P", x, y)), 2e-5);
    }
}

TEST(BatchRows, AreThereOnlyWhereTheFilterSaysBatch) {
    BenchOptions options;
    EXPECT_THAT(select_batch_rows(options), IsEmpty());
    options.filter = "half|1920x1080|.*";
    EXPECT_THAT(select_batch_rows(options), IsEmpty());
    options.filter = "^batch\\.(half|float)\\.";
    std::vector<std::string> keys;
    const std::vector<BatchRow> rows = select_batch_rows(options);
    keys.reserve(rows.size());
    for (const BatchRow& row : rows) {
        keys.push_back(row.key());
    }
    EXPECT_THAT(keys,
                ElementsAre("batch.half.none.1920x1080", "batch.half.zip.1920x1080", "batch.half.piz.1920x1080",
                            "batch.half.dwaa.1920x1080", "batch.float.none.1920x1080", "batch.float.zip.1920x1080",
                            "batch.float.piz.1920x1080", "batch.float.dwaa.1920x1080"));
    options.filter = "batch\\.encode\\.zip:4";
    options.width = 640;
    options.height = 360;
    ASSERT_EQ(select_batch_rows(options).size(), 1U);
    EXPECT_EQ(select_batch_rows(options).front().key(), "batch.encode.zip:4.640x360");
}

TEST(BatchRivals, EveryWayOfTheLibraryDecodesWhatWeRead) {
    for (const bool half : {true, false}) {
        for (const char* compression : {"none", "zip", "piz", "dwaa"}) {
            const Sequence sequence(half, compression);
            const ImageLayout layout = read_layout(sequence.first());
            const std::vector<int> indices{0, 7, 15};
            std::vector<std::string> names;
            names.reserve(indices.size());
            for (const int index : indices) {
                names.push_back(layout.channels[static_cast<std::size_t>(index)].file_name);
            }
            PlaneSlab ours(width, height, 3);
            PlaneReader(sequence.first(), layout, indices, layout.parts.front().data_window).read(0, ours);
            for (const LibraryPath path : library_paths(compression)) {
                PlaneSlab theirs(width, height, 3);
                decode_with(sequence.first(), names, path, theirs);
                for (int p = 0; p < 3; ++p) {
                    for (int y = 0; y < height; ++y) {
                        ASSERT_TRUE(std::ranges::equal(ours.row(p, y), theirs.row(p, y)))
                            << compression << ' ' << half << ' ' << description_of(path) << ' ' << p << ' ' << y;
                    }
                }
            }
        }
    }
}

TEST(BatchRivals, TheLibraryWritesThePictureItWasGiven) {
    Device device = cpu();
    BatchContestant ours(device, {}, 2);
    const Sequence sequence(true, "zip");
    const BatchFolder& files = sequence.files();
    (void)ours.run({files.inputs(), files.ours(), true, "zip"});
    BareWork work;
    work.inputs = files.inputs();
    work.outputs = files.theirs();
    work.channels = ours.channels(sequence.first());
    EXPECT_EQ(work.channels.size(), 15U) << "all but the ids, which no material claims";
    work.compression = "zip";
    work.picture = std::make_shared<StoredPicture>(read_stored_picture(files.ours()[1]));
    work.threads = 2;
    for (const LibraryPath path : library_paths("zip")) {
        for (const fs::path& output : work.outputs) {
            fs::remove(output);
        }
        EXPECT_GT(decode_and_encode(work, path), 0.0);
        for (const fs::path& output : work.outputs) {
            EXPECT_EQ(stored_difference(read_stored_picture(output), *work.picture), 0.0) << description_of(path);
        }
    }
    EXPECT_GT(stored_difference(*work.picture, read_stored_picture(files.ours()[2])), 0.1) << "another frame";
    work.inputs[1] = "/nonexistent.exr";
    EXPECT_THROW((void)decode_and_encode(work, LibraryPath::frames), RuntimeFailure);
}

TEST(BatchRivals, TheOpenImageIoProgramShadesWhatWeShade) {
    if (!oiio_rival_trouble().empty()) {
        GTEST_SKIP() << oiio_rival_trouble();
    }
    Device device = cpu();
    BatchContestant ours(device, {}, 2);
    const Sequence sequence(true, "zip");
    const BatchFolder& files = sequence.files();
    (void)ours.run({files.inputs(), files.ours(), false, "none"});
    OiioWork work;
    work.inputs = files.inputs();
    work.outputs = files.theirs();
    work.half = false;
    work.compression = "none";
    const glm::dvec3 to_light = -glm::normalize(ours.light().direction);
    for (int c = 0; c < 3; ++c) {
        work.light.to_light[c] = static_cast<float>(to_light[c]);
        work.light.irradiance[c] = static_cast<float>(ours.light().power[c]);
    }
    work.threads = 2;
    EXPECT_GT(run_oiio_rival(work), 0.0);
    for (std::size_t i = 0; i < files.ours().size(); ++i) {
        const StoredPicture theirs = read_stored_picture(files.theirs()[i]);
        const StoredPicture picture = read_stored_picture(files.ours()[i]);
        EXPECT_LT(stored_difference(theirs, picture), oiio_tolerance) << i;
    }
    work.light.irradiance[1] *= 1.01F;
    (void)run_oiio_rival(work);
    EXPECT_GT(stored_difference(read_stored_picture(files.theirs()[0]), read_stored_picture(files.ours()[0])),
              oiio_tolerance)
        << "one per cent more green must be seen";
}

TEST(BatchBench, RowsHaveFiguresOfWholeRunsAndLeaveNothingBehind) {
    Device device = cpu();
    BenchOptions options;
    options.quick = true;
    options.width = width;
    options.height = height;
    options.filter = "batch\\.(half\\.zip|float\\.dwaa|encode\\.zip:1)\\.";
    const tests::TemporaryFolder folder;
    const char* const before = std::getenv("TMPDIR");
    const std::string kept = before == nullptr ? "" : before;
    ::setenv("TMPDIR", folder.path().c_str(), 1);
    const BenchReport report = run_benchmarks(device, options);
    if (before == nullptr) {
        ::unsetenv("TMPDIR");
    } else {
        ::setenv("TMPDIR", kept.c_str(), 1);
    }
    EXPECT_TRUE(fs::is_empty(folder.path()));

    ASSERT_EQ(report.results.size(), 3U);
    for (const BenchResult& row : report.results) {
        ASSERT_EQ(row.status, BenchStatus::ok) << row.key << ": " << row.reason;
        ASSERT_TRUE(row.batch.has_value());
        EXPECT_EQ(row.width, width);
        EXPECT_GT(row.median_ms, 0.0);
        EXPECT_GT(row.batch->bytes_written, 0.0);
        EXPECT_NEAR(row.batch->frames_per_second * row.median_ms, 1e3, 1e-9);
        if (row.key.starts_with("batch.encode.")) {
            EXPECT_TRUE(row.against.empty());
            continue;
        }
        EXPECT_EQ(row.batch->frames, 3);
        EXPECT_GT(row.batch->bytes_read, row.batch->bytes_written) << "15 channels in, 4 out";
        ASSERT_EQ(row.against.size(), 2U);
        EXPECT_EQ(row.against[0].name, "decode_encode");
        EXPECT_THAT(row.against[0].note, HasSubstr("OpenEXR"));
        EXPECT_EQ(row.against[1].name, "oiio");
        for (const RivalResult& rival : row.against) {
            ASSERT_EQ(rival.status, BenchStatus::ok) << row.key << " against " << rival.name << ": " << rival.reason;
            EXPECT_GT(rival.median_ms, 0.0);
            EXPECT_GT(rival.ratio, 0.0);
        }
    }
    EXPECT_TRUE(batch_limits(report.results).empty()) << "they are about 1920x1080";
}

TEST(BatchBench, LimitsAreThoseOfTheRowsTheyAreAbout) {
    BenchResult row;
    row.key = "batch.half.zip.1920x1080";
    row.width = 1920;
    row.height = 1080;
    row.batch.emplace();
    RivalResult library;
    library.name = "decode_encode";
    library.ratio = 1.2;
    RivalResult oiio;
    oiio.name = "oiio";
    oiio.ratio = 0.4;
    row.against = {library, oiio};
    BenchResult other = row;
    other.key = "batch.half.piz.1920x1080";
    const std::vector<SpeedLimit> limits = batch_limits({row, other});
    ASSERT_EQ(limits.size(), 3U) << "OpenImageIO is a limit for half ZIP and uncompressed float only";
    EXPECT_EQ(limits[0].limit, 1.15);
    EXPECT_FALSE(limits[0].met());
    EXPECT_EQ(limits[1].limit, 0.5);
    EXPECT_TRUE(limits[1].met());
}

} // namespace
} // namespace clshade
