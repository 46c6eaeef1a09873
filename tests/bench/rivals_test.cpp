// Every rival computes what it claims to: against the double-precision reference, for each instruction set there is.
#include "bench/bench_environment.h"
#include "bench/bench_frame.h"
#include "bench/contest.h"
#include "bench/device_rivals.h"
#include "bench/host_rivals.h"
#include "bench/prefilter_bench.h"
#include "bench/prefilter_rival.h"
#include "host/device/device.h"
#include "host/reference/reference.h"
#include "host/shading/kernel_library.h"
#include "host/shading/shader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace clshade {
namespace {

// Neither a multiple of 16 wide nor of 1024 pixels, so that padding is in play.
constexpr int width = 173;
constexpr int height = 97;

Frame frame_of(BenchLights lights) {
    Frame frame = make_bench_frame(width, height, 7);
    apply_scene(frame, {.lights = lights});
    return frame;
}

/// Largest difference of a picture (R, G, B) from the reference.
double difference_from_reference(const Frame& frame, const PlaneSlab& picture) {
    const reference::Image expected = reference::shade(frame, {}, 2);
    return picture_difference(picture, [&expected](int p, int x, int y) {
        return expected
            .planes[static_cast<std::size_t>(p)][static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
    });
}

Device cpu() {
    return Device(select_device(list_devices(), "cpu"));
}

class HostRivalsTest : public ::testing::TestWithParam<std::string_view> {};

TEST_P(HostRivalsTest, OneLightAgreesWithTheReference) {
    const Frame frame = frame_of(BenchLights::distant1);
    const auto lights = distant_lights(frame);
    PlaneSlab output(width, height, 4);
    HostRivals rivals(frame, output, 2, GetParam());
    EXPECT_EQ(rivals.instruction_set(), GetParam());
    EXPECT_GT(rivals.openmp_simd(lights, 4), 0.0);
    // The usual form of N.H at n = 256 (models.md section 14) leaves up to 1e-4 of a highlight in single precision.
    EXPECT_LT(difference_from_reference(frame, output), 1e-4);
    EXPECT_GT(rivals.hand_simd(lights, 4), 0.0);
    EXPECT_LT(difference_from_reference(frame, output), 1e-4);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            ASSERT_EQ(output.at(3, x, y), 1.0F) << x << ", " << y;
        }
    }
}

TEST_P(HostRivalsTest, EightLightsAgreeWithTheReference) {
    const Frame frame = frame_of(BenchLights::distant8);
    PlaneSlab output(width, height, 4);
    HostRivals rivals(frame, output, 2, GetParam());
    rivals.hand_simd(distant_lights(frame), 3);
    EXPECT_LT(difference_from_reference(frame, output), 1e-4);
}

TEST_P(HostRivalsTest, ThreeOutputPlanesLeaveAlphaAlone) {
    const Frame frame = frame_of(BenchLights::distant1);
    PlaneSlab output(width, height, 4);
    HostRivals rivals(frame, output, 1, GetParam());
    rivals.openmp_simd(distant_lights(frame), 3);
    rivals.hand_simd(distant_lights(frame), 3);
    EXPECT_EQ(output.at(3, 5, 5), 0.0F);
}

TEST_P(HostRivalsTest, PixelsWithoutANormalAreBlackAndTransparent) {
    Frame frame = frame_of(BenchLights::distant1);
    for (int p = 0; p < 3; ++p) {
        frame.planes.at(p, 30, 40) = 0.0F;
    }
    PlaneSlab output(width, height, 4);
    HostRivals rivals(frame, output, 1, GetParam());
    for (const bool by_hand : {false, true}) {
        by_hand ? rivals.hand_simd(distant_lights(frame), 4) : rivals.openmp_simd(distant_lights(frame), 4);
        for (int p = 0; p < 4; ++p) {
            EXPECT_EQ(output.at(p, 30, 40), 0.0F) << "plane " << p;
        }
        EXPECT_EQ(output.at(3, 31, 40), 1.0F);
    }
}

TEST_P(HostRivalsTest, StreamReadsEveryPlane) {
    const Frame frame = frame_of(BenchLights::distant1);
    PlaneSlab output(width, height, 4);
    HostRivals rivals(frame, output, 2, GetParam());
    for (const int planes_in : {3, 13, 14}) {
        rivals.stream(planes_in, 4);
        for (int y = 0; y < height; y += 7) {
            for (int x = 0; x < width; ++x) {
                double sum = 0.0;
                double size = 0.0;
                for (int p = 0; p < planes_in; ++p) {
                    sum += static_cast<double>(frame.planes.at(p, x, y));
                    size += std::abs(static_cast<double>(frame.planes.at(p, x, y)));
                }
                // 14 additions in floats: at most 14 roundings of 6e-8 of the sum of sizes.
                ASSERT_NEAR(output.at(0, x, y), sum, 1e-6 * size);
                ASSERT_NEAR(output.at(3, x, y), 4.0 * sum, 4e-6 * size);
            }
        }
    }
}

TEST_P(HostRivalsTest, TheFilterAgreesWithTheReference) {
    // 64 rows are doubled, 256 are halved for broad lobes; suns of 2e5 tell when a texel is lost.
    for (const int rows : {64, 256}) {
        const LatLong sky = sunny_sky(rows, 3);
        PrefilterRival rival(2, GetParam());
        const FilteredSet set = rival.filter(sky);
        EXPECT_NO_THROW(check_sizes(set));
        // w - R rounds to 6e-8 of 1, which is 3e-6 of the sharpest lobe's deviation, and counts several times where
        // the lobe has fallen off towards a sun.
        EXPECT_LT(prefilter_error(set, sky), 3e-5) << rows;
    }
}

TEST(PrefilterError, SeesAMapThatIsOff) {
    const LatLong sky = sunny_sky(32, 3);
    FilteredSet set = PrefilterRival(2).filter(sky);
    const double before = prefilter_error(set, sky);
    for (float& value : set.irradiance) {
        value *= 1.01F;
    }
    EXPECT_LT(before, 1e-3);
    EXPECT_NEAR(prefilter_error(set, sky), 0.01, 1e-4);
}

TEST(SunnySky, HasSunsBeyondHalfRangeAndDependsOnTheSeedAlone) {
    const LatLong sky = sunny_sky(64, 3);
    EXPECT_EQ(sky.width, 128);
    ASSERT_EQ(sky.rgb.size(), 64U * 128U * 3U);
    EXPECT_GT(*std::max_element(sky.rgb.begin(), sky.rgb.end()), 65504.0F);
    EXPECT_GT(*std::min_element(sky.rgb.begin(), sky.rgb.end()), 0.0F);
    EXPECT_EQ(sky.rgb, sunny_sky(64, 3).rgb);
    EXPECT_NE(sky.rgb, sunny_sky(64, 4).rgb);
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, HostRivalsTest, ::testing::ValuesIn(instruction_sets()), [](const auto& set) {
    std::string name(set.param);
    for (char& letter : name) {
        letter = letter == '-' ? '_' : letter;
    }
    return name;
});

TEST(HostRivals, UnknownInstructionSetsAndLightsAreRefused) {
    const Frame frame = frame_of(BenchLights::point1);
    PlaneSlab output(width, height, 4);
    EXPECT_THROW(HostRivals(frame, output, 1, "z80"), std::invalid_argument);
    EXPECT_THROW((void)distant_lights(frame), std::invalid_argument);
}

TEST(DeviceRivals, NaiveKernelAgreesWithTheReference) {
    Device device = cpu();
    if (!NaiveRival::supported(device)) {
        GTEST_SKIP() << device.info().name << " has no images";
    }
    const Frame frame = frame_of(BenchLights::distant1);
    NaiveRival rival(device, frame);
    EXPECT_GT(rival.run(), 0.0);
    const std::span<const float> pixels = rival.output();
    PlaneSlab picture(width, height, 3);
    for (int p = 0; p < 3; ++p) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                picture.at(p, x, y) = pixels[(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * 4 +
                                             static_cast<std::size_t>(p)];
            }
        }
    }
    EXPECT_LT(difference_from_reference(frame, picture), 1e-4); // as the C++ rivals
}

TEST(DeviceRivals, StreamReadsEveryPlaneAtEveryWidth) {
    Device device = cpu();
    for (const int lanes : {1, 4, 8, 16}) {
        for (const auto& [planes_in, planes_out] : {std::pair(13, 3), std::pair(14, 4)}) {
            Frame frame = frame_of(BenchLights::distant1);
            const auto memory = std::make_shared<PictureMemory>(device, frame, 4);
            StreamRival rival(device, memory, frame.planes.stride(), planes_in, planes_out, lanes);
            EXPECT_GT(rival.run(), 0.0);
            memory->result_buffer.download();
            const PlaneSlab& output = memory->result;
            for (int x = 0; x < width; ++x) {
                double sum = 0.0;
                double size = 0.0;
                for (int p = 0; p < planes_in; ++p) {
                    sum += static_cast<double>(frame.planes.at(p, x, height - 1));
                    size += std::abs(static_cast<double>(frame.planes.at(p, x, height - 1)));
                }
                for (int p = 0; p < planes_out; ++p) {
                    ASSERT_NEAR(output.at(p, x, height - 1), (p + 1) * sum, (p + 1) * 1e-6 * size)
                        << lanes << " lanes, plane " << p;
                }
            }
        }
    }
}

TEST(PictureMemory, KernelsWriteToItInTurns) {
    Device device = cpu();
    Shader shader(device, kernel_sources(), ProgramCache::standard(), {});
    Frame frame = frame_of(BenchLights::distant1);
    const auto memory = std::make_shared<PictureMemory>(device, frame, bench_outputs);
    const std::array<BenchScene, 2> scenes = {
        BenchScene{}, {.materials = {coated(1, FresnelModel::constant, AbsorptionModel::approximated)}}};
    std::vector<PreparedFrame> prepared;
    std::vector<PlaneSlab> expected;
    for (const BenchScene& scene : scenes) {
        apply_scene(frame, scene);
        expected.push_back(std::move(shader.shade(frame).planes));
        prepared.push_back(shader.prepare(frame, memory));
    }
    for (const std::size_t turn : {0, 1, 0}) {
        spoil(*memory);
        prepared[turn].launch();
        EXPECT_GT(prepared[turn].wait_milliseconds(), 0.0);
        memory->result_buffer.download();
        EXPECT_EQ(
            picture_difference(expected[turn], [&memory](int p, int x, int y) { return memory->result.at(p, x, y); }),
            0.0)
            << turn;
        EXPECT_GT(picture_difference(expected[1 - turn],
                                     [&memory](int p, int x, int y) { return memory->result.at(p, x, y); }),
                  0.0);
        memory->result_buffer.upload();
    }
    const auto too_small = std::make_shared<PictureMemory>(device, frame, 3);
    EXPECT_THROW((void)shader.prepare(frame, too_small), std::invalid_argument);
}

TEST(PictureMemory, WhatIsSpoiltIsNoPicture) {
    Device device = cpu();
    Frame frame = frame_of(BenchLights::distant1);
    PictureMemory memory(device, frame, bench_outputs);
    spoil(memory);
    memory.result_buffer.download();
    EXPECT_TRUE(std::isinf(picture_difference(PlaneSlab(width, height, 4),
                                              [&memory](int p, int x, int y) { return memory.result.at(p, x, y); })));
}

TEST(PictureDifference, SeesOneWrongPixelAndNaN) {
    PlaneSlab picture(8, 4, 3);
    EXPECT_EQ(picture_difference(picture, [](int, int, int) { return 0.0; }), 0.0);
    picture.at(2, 7, 3) = 0.5F;
    EXPECT_NEAR(picture_difference(picture, [](int, int, int) { return 0.0; }), 500.0, 1e-9);
    picture.at(1, 0, 0) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isinf(picture_difference(picture, [](int, int, int) { return 0.0; })));
}

} // namespace
} // namespace clshade
