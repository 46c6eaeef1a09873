// Outputs: what is stored, under which name, and what remains when storing fails.
#include "host/images/temporary_file.h"
#include "tests/images/fixtures.h"

#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <limits>

namespace clshade {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int width = 50;
constexpr int height = 300; // more than one strip

PlaneSlab example_planes() {
    PlaneSlab slab(width, height, 5);
    for (int plane = 0; plane < 5; ++plane) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                slab.at(plane, x, y) = pattern(plane, x, y);
            }
        }
    }
    return slab;
}

OutputImage image_of(const PlaneSlab& slab) {
    OutputImage image;
    image.data_window = {-10, 20, -10 + width - 1, 20 + height - 1};
    image.display_window = {0, 0, 99, 399};
    image.pixel_aspect = 1.5;
    const char* names[] = {"R", "G", "B", "A", "id.V"};
    for (int plane = 0; plane < 5; ++plane) {
        image.channels.push_back({names[plane], &slab, plane, plane == 4});
    }
    return image;
}

std::string usage_error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const UsageError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no UsageError";
    return "";
}

TEST(WriteExr, RoundTripInEveryLosslessCompression) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example_planes();
    const OutputImage image = image_of(slab);
    for (const char* compression : {"none", "rle", "zips", "zip", "piz"}) {
        for (const bool half : {true, false}) {
            for (const int threads : {1, 3}) {
                const auto written = tbb::task_arena(threads).execute([&] {
                    return write_exr(folder / "a.exr", image, {half, compression, {}});
                });
                EXPECT_EQ(written.clamped, 0U);
                const Picture picture = read_picture(folder / "a.exr");
                ASSERT_EQ(picture.layout.channels.size(), 5U);
                EXPECT_EQ(picture.layout.parts[0].data_window, image.data_window);
                EXPECT_EQ(picture.layout.parts[0].compression, compression);
                EXPECT_EQ(picture.layout.display_window, image.display_window);
                EXPECT_EQ(picture.layout.pixel_aspect, 1.5);
                for (const OutputChannel& channel : image.channels) {
                    const int index = index_of(picture.layout, channel.name);
                    EXPECT_EQ(picture.layout.channels[static_cast<std::size_t>(index)].type,
                              half && !channel.force_float ? SampleType::half : SampleType::float32);
                    for (int y = 0; y < height; ++y) {
                        for (int x = 0; x < width; ++x) {
                            ASSERT_EQ(picture.at(index, x - 10, y + 20), pattern(channel.plane, x, y));
                        }
                    }
                }
            }
        }
    }
    EXPECT_THAT(folder.names(), ElementsAre("a.exr"));
}

TEST(WriteExr, LossyCompressionsComeClose) {
    const TemporaryFolder folder;
    PlaneSlab slab(64, 64, 1);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            slab.at(0, x, y) =
                0.5F + 0.4F * std::sin(0.1F * static_cast<float>(x)) * std::cos(0.07F * static_cast<float>(y));
        }
    }
    OutputImage image;
    image.data_window = image.display_window = {0, 0, 63, 63};
    image.channels.push_back({"R", &slab, 0, false});
    for (const char* compression : {"pxr24", "b44", "b44a", "dwaa", "dwab"}) {
        write_exr(folder / "a.exr", image, {true, compression, {}});
        const Picture picture = read_picture(folder / "a.exr");
        EXPECT_EQ(picture.layout.parts[0].compression, compression);
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                // B44 quantises a smooth 4x4 block to about a 60th of its range, DWA at 45 below one display step.
                ASSERT_NEAR(picture.at(0, x, y), slab.at(0, x, y), 0.02) << compression;
            }
        }
    }
}

TEST(WriteExr, AttributesAreStored) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example_planes();
    OutputImage image = image_of(slab);
    image.attributes["clshade/device"] = "some device";
    image.matrices["worldToCamera"] = glm::dmat4(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
    write_exr(folder / "a.exr", image, {});
    const ImageLayout layout = read_layout(folder / "a.exr");
    EXPECT_EQ(layout.strings.at("clshade/device"), "some device");
    EXPECT_EQ(layout.strings.at("software"), "clshade");
    EXPECT_EQ(layout.matrices.at("worldToCamera"), image.matrices["worldToCamera"]);
    const Imf::InputFile file((folder / "a.exr").c_str()); // as another program sees it
    EXPECT_EQ(file.header().typedAttribute<Imf::M44fAttribute>("worldToCamera").value()[3][0], 13.0F);

    image.attributes["software"] = "clshade 0.1.0";
    write_exr(folder / "a.exr", image, {});
    EXPECT_EQ(read_layout(folder / "a.exr").strings.at("software"), "clshade 0.1.0");
    image.attributes["compression"] = "a structural attribute"; // refused by OpenEXR
    EXPECT_THAT(failure_of([&] { write_exr(folder / "a.exr", image, {}); }), HasSubstr("cannot be written"));
    EXPECT_THAT(folder.names(), ElementsAre("a.exr"));
}

TEST(WriteExr, TheSameBytesForAnyNumberOfThreads) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example_planes();
    const OutputImage image = image_of(slab);
    for (const char* compression : {"zip", "piz", "dwaa", "dwab"}) {
        tbb::task_arena(1).execute([&] { write_exr(folder / "1.exr", image, {true, compression, {}}); });
        tbb::task_arena(4).execute([&] { write_exr(folder / "2.exr", image, {true, compression, {}}); });
        EXPECT_EQ(bytes_of_file(folder / "1.exr"), bytes_of_file(folder / "2.exr")) << compression;
    }
}

TEST(WriteExr, LevelsAndNamesOfCompressions) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example_planes();
    const OutputImage image = image_of(slab);
    const auto size = [&](const std::string& compression, double level) {
        write_exr(folder / "a.exr", image, {true, compression, level});
        static_cast<void>(read_picture(folder / "a.exr"));
        return std::filesystem::file_size(folder / "a.exr");
    };
    EXPECT_GT(size("zip", 1), size("zip", 9));
    EXPECT_GT(size("dwaa", 1), size("dwaa", 500));
    EXPECT_THAT(usage_error_of([&] {
                    check_exr_settings({true, "pizz", {}});
                }),
                AllOf(HasSubstr("unknown compression"), HasSubstr("did you mean 'piz'?")));
    EXPECT_THAT(usage_error_of([&] { check_exr_settings({true, "zip", 10.0}); }), HasSubstr("from 1 to 9"));
    EXPECT_THAT(usage_error_of([&] { check_exr_settings({true, "zips", std::nan("")}); }), HasSubstr("from 1 to 9"));
    EXPECT_THAT(usage_error_of([&] { check_exr_settings({true, "dwab", -1.0}); }), HasSubstr("0 or more"));
    EXPECT_THAT(usage_error_of([&] { check_exr_settings({true, "piz", 3.0}); }), HasSubstr("piz has no level"));
    EXPECT_NO_THROW(check_exr_settings({true, "dwaa", 45.0}));
}

TEST(WriteExr, ValuesBeyondHalfAreClampedAndCounted) {
    const TemporaryFolder folder;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> values{65504.0F, 65519.9F,  65520.0F,      1e10F, -1e10F,
                                    infinity, -infinity, std::nanf(""), 1.0F};
    const auto count = static_cast<int>(values.size());
    PlaneSlab slab(count, 1, 2);
    for (int plane = 0; plane < 2; ++plane) {
        std::copy(values.begin(), values.end(), slab.row(plane, 0).begin());
    }
    OutputImage image;
    image.data_window = image.display_window = {0, 0, count - 1, 0};
    image.channels = {{"R", &slab, 0, false}, {"Z", &slab, 1, true}};
    EXPECT_EQ(write_exr(folder / "a.exr", image, {}).clamped, 3U);
    const Picture picture = read_picture(folder / "a.exr");
    const std::vector<float> expected{65504, 65504, 65504, 65504, -65504, infinity, -infinity, std::nanf(""), 1};
    for (int x = 0; x < count; ++x) {
        const float got = picture.at(index_of(picture.layout, "R"), x, 0);
        const float whole = picture.at(index_of(picture.layout, "Z"), x, 0);
        const auto i = static_cast<std::size_t>(x);
        EXPECT_TRUE(std::isnan(expected[i]) ? std::isnan(got) : got == expected[i]) << got;
        EXPECT_TRUE(std::isnan(values[i]) ? std::isnan(whole) : whole == values[i]) << whole;
    }
}

TEST(WriteExr, InconsistentImagesAreRefused) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example_planes();
    OutputImage image = image_of(slab);
    image.channels[1].name = "R";
    EXPECT_THAT(failure_of([&] { write_exr(folder / "a.exr", image, {}); }), HasSubstr("named 'R'"));
    image = image_of(slab);
    image.data_window.x_max += 1;
    EXPECT_THAT(failure_of([&] { write_exr(folder / "a.exr", image, {}); }), HasSubstr("has not the size"));
    image.channels.clear();
    EXPECT_THAT(failure_of([&] { write_exr(folder / "a.exr", image, {}); }), HasSubstr("no channels"));
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(WriteExr, AFullDiskLeavesNothingBehind) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example_planes();
    const OutputImage image = image_of(slab);
    write_bytes(folder / "a.exr", "the picture of yesterday");
    for (const char* compression : {"none", "zips", "zip", "piz", "dwaa"}) {
        const ExrSettings settings{true, compression, {}};
        const auto whole = static_cast<rlim_t>(write_exr(folder / "whole.exr", image, settings).bytes);
        std::filesystem::remove(folder / "whole.exr");
        // A limit on the size of files is a full disk to the program. 0: the first byte; whole - 1: only the last one.
        for (const rlim_t limit : {rlim_t{0}, whole / 2, whole - 1}) {
            const int result = in_child([&] {
                std::signal(SIGXFSZ, SIG_IGN);
                const rlimit small{limit, limit};
                ::setrlimit(RLIMIT_FSIZE, &small);
                try {
                    write_exr(folder / "a.exr", image, settings);
                } catch (const RuntimeFailure& failure) {
                    const std::string message = failure.what();
                    return message.find("a.exr: cannot be written") != std::string::npos &&
                                   message.find("free some space") != std::string::npos &&
                                   message.find('\n') == std::string::npos
                               ? 0
                               : 1;
                }
                return 2;
            });
            EXPECT_EQ(result, 0) << limit << " " << compression;
            EXPECT_THAT(folder.names(), ElementsAre("a.exr"));
            EXPECT_EQ(bytes_of_file(folder / "a.exr"), "the picture of yesterday");
        }
    }
}

TEST(WritePng, AFullDiskLeavesNothingBehind) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example_planes();
    const OutputImage image = image_of(slab);
    const int result = in_child([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit small{100, 100};
        ::setrlimit(RLIMIT_FSIZE, &small);
        try {
            write_png(folder / "a.png", image);
        } catch (const RuntimeFailure&) {
            return 0;
        }
        return 2;
    });
    EXPECT_EQ(result, 0);
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(WriteExr, AMissingFolderIsNamed) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example_planes();
    EXPECT_THAT(failure_of([&] { write_exr(folder / "none/a.exr", image_of(slab), {}); }),
                AllOf(HasSubstr("none/a.exr: cannot be written"), HasSubstr("No such file")));
}

TEST(WriteExr, WritesThroughALink) {
    const TemporaryFolder folder;
    const PlaneSlab slab = example_planes();
    std::filesystem::create_directory(folder / "real");
    write_bytes(folder / "real/a.exr", "old");
    std::filesystem::create_symlink("real/a.exr", folder / "link.exr");
    write_exr(folder / "link.exr", image_of(slab), {});
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.exr"));
    EXPECT_EQ(read_layout(folder / "real/a.exr").channels.size(), 5U);
}

TEST(Temporary, RemovedOnASignalAndOnFailure) {
    const TemporaryFolder folder;
    {
        TemporaryFile one(folder / "a.exr");
        const TemporaryFile two(folder / "b.exr");
        EXPECT_EQ(folder.names().size(), 2U);
        EXPECT_THAT(folder.names()[0], AllOf(::testing::StartsWith(".a.exr."), ::testing::EndsWith(".tmp")));
        one.write(std::as_bytes(std::span("text")));
        remove_temporaries();
        EXPECT_THAT(folder.names(), IsEmpty());
    }
    { const TemporaryFile dropped(folder / "c.exr"); }
    EXPECT_THAT(folder.names(), IsEmpty());
    TemporaryFile kept(folder / "d.exr");
    kept.write(std::as_bytes(std::span("text", 4)));
    kept.close();
    kept.commit();
    remove_temporaries();
    EXPECT_THAT(folder.names(), ElementsAre("d.exr"));
    EXPECT_EQ(bytes_of_file(folder / "d.exr"), "text");
}

TEST(Temporary, RemovedFromASignalHandler) {
    const TemporaryFolder folder;
    const int result = in_child([&] {
        std::signal(SIGTERM, [](int) {
            remove_temporaries();
            ::_exit(7);
        });
        TemporaryFile file(folder / "a.exr");
        file.write(std::as_bytes(std::span("text")));
        ::raise(SIGTERM);
        return 0;
    });
    EXPECT_EQ(result, 7);
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(OutputPath, RefusedBeforeTheWork) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "folder.exr");
    write_bytes(folder / "file", "");
    write_bytes(folder / "file.exr", "");
    EXPECT_NO_THROW(check_output_path(folder / "a.exr"));
    EXPECT_NO_THROW(check_output_path(folder / "a.PNG"));
    EXPECT_NO_THROW(check_output_path("a.exr"));
    EXPECT_THAT(usage_error_of([&] { check_output_path(folder / "a.jpg"); }), HasSubstr("'.jpg'; use .exr"));
    EXPECT_THAT(usage_error_of([&] { check_output_path(folder / "a"); }), HasSubstr("use .exr"));
    EXPECT_THAT(failure_of([&] { check_output_path(folder / "folder.exr"); }), HasSubstr("is a folder"));
    EXPECT_THAT(failure_of([&] { check_output_path(folder / "none/a.exr"); }), HasSubstr("does not exist"));
    EXPECT_THAT(failure_of([&] { check_output_path(folder / "file/a.exr"); }), HasSubstr("a.exr"));
    EXPECT_THAT(failure_of([&] { check_output_path("/dev/full"); }), HasSubstr("not a regular file"));
    std::filesystem::permissions(folder / "file.exr", std::filesystem::perms(0444));
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0777));
    EXPECT_EQ(as_common_user([&] {
                  const std::string message = failure_of([&] { check_output_path(folder / "file.exr"); });
                  return message.find("cannot be replaced") != std::string::npos ? 0 : 1;
              }),
              0);
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
    EXPECT_EQ(as_common_user([&] {
                  const std::string message = failure_of([&] { check_output_path(folder / "a.exr"); });
                  return message.find("check its permissions") != std::string::npos ? 0 : 1;
              }),
              0);
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0700));
}

TEST(OutputPath, SameFileIsSeenThroughLinksAndDots) {
    const TemporaryFolder folder;
    write_bytes(folder / "a.exr", "a");
    write_bytes(folder / "b.exr", "a");
    std::filesystem::create_symlink("a.exr", folder / "link.exr");
    std::filesystem::create_hard_link(folder / "a.exr", folder / "hard.exr");
    std::filesystem::create_directory(folder / "sub");
    EXPECT_TRUE(same_file(folder / "a.exr", folder / "a.exr"));
    EXPECT_TRUE(same_file(folder / "a.exr", folder / "sub/../a.exr"));
    EXPECT_TRUE(same_file(folder / "a.exr", folder / "link.exr"));
    EXPECT_TRUE(same_file(folder / "a.exr", folder / "hard.exr"));
    EXPECT_FALSE(same_file(folder / "a.exr", folder / "b.exr"));
    EXPECT_FALSE(same_file(folder / "a.exr", folder / "missing.exr"));
    EXPECT_FALSE(same_file(folder / "missing.exr", folder / "missing.exr"));
}

TEST(WritePng, DisplayValues) {
    const TemporaryFolder folder;
    PlaneSlab slab(6, 1, 4);
    //                          black half   premultiplied NaN  too bright  negative
    const float colour[6] = {0.0F, 0.5F, 0.25F, std::nanf(""), 7.0F, -1.0F};
    const float alpha[6] = {0.0F, 1.0F, 0.5F, 1.0F, 1.0F, 1.0F};
    for (int x = 0; x < 6; ++x) {
        for (int plane = 0; plane < 3; ++plane) {
            slab.at(plane, x, 0) = colour[x];
        }
        slab.at(3, x, 0) = alpha[x];
    }
    OutputImage image;
    image.data_window = image.display_window = {0, 0, 5, 0};
    image.channels = {{"B", &slab, 2, false}, {"A", &slab, 3, false}, {"G", &slab, 1, false}, {"R", &slab, 0, false}};
    write_png(folder / "a.png", image);
    EXPECT_THAT(folder.names(), ElementsAre("a.png"));
    OIIO::ImageSpec raw;
    raw.attribute("oiio:UnassociatedAlpha", 1); // as stored
    const auto input = OIIO::ImageInput::open((folder / "a.png").string(), &raw);
    ASSERT_NE(input, nullptr);
    ASSERT_EQ(input->spec().nchannels, 4);
    std::vector<std::uint8_t> pixels(24);
    ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, pixels.data()));
    // Linear 0.5 is 187.52 of 255 in sRGB (1.055 * 0.5^(1/2.4) - 0.055).
    const std::vector<std::uint8_t> expected{0, 188, 188, 0, 255, 0};
    const std::vector<std::uint8_t> opacity{0, 255, 128, 255, 255, 255};
    for (std::size_t x = 0; x < 6; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(pixels[4 * x + c], expected[x]) << x;
        }
        EXPECT_EQ(pixels[4 * x + 3], opacity[x]) << x;
    }
    image.channels.pop_back();
    EXPECT_THAT(failure_of([&] { write_png(folder / "b.png", image); }), HasSubstr("needs channels R, G and B"));
}

} // namespace
} // namespace clshade
