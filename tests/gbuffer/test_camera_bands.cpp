// Cameras of pictures that are seen in bands: the same to the last bit.
#include "host/base/error.h"
#include "host/gbuffer/camera.h"
#include "host/gbuffer/camera_samples.h"
#include "tests/gbuffer/bands.h"
#include "tests/gbuffer/layouts.h"
#include "tests/gbuffer/plans.h"
#include "tests/gbuffer/views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace clshade {
namespace {

using testing::blender_layout;
using testing::blocks;
using testing::camera_at;
using testing::make_frame;
using testing::plain_scene;
using testing::plan_of;
using testing::random_bands;

constexpr Window display{0, 0, 899, 599}; // every second pixel of a coarse lattice

View perspective(const Window& window) {
    return view_from_camera(camera_at({2, -9, 4}, {0, 0, 1}, Lens::fov_x, 1.0), window, window, 1.0);
}

View orthographic(const Window& window) {
    return view_from_camera(camera_at({2, -9, 4}, {0, 0, 1}, Lens::orthographic, 6.0), window, window, 1.0);
}

/// To the last bit.
void expect_identical(const View& a, const View& b) {
    EXPECT_EQ(a.orthographic, b.orthographic);
    EXPECT_EQ(a.has_rays, b.has_rays);
    EXPECT_EQ(a.eye, b.eye);
    EXPECT_EQ(a.view_axis, b.view_axis);
    EXPECT_EQ(a.camera_to_world, b.camera_to_world);
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.origin_dx, b.origin_dx);
    EXPECT_EQ(a.origin_dy, b.origin_dy);
    EXPECT_EQ(a.direction, b.direction);
    EXPECT_EQ(a.direction_dx, b.direction_dx);
    EXPECT_EQ(a.direction_dy, b.direction_dy);
}

/// All five planes in another order than the frame's, and where the roles are then.
const std::vector<int> shuffled_planes{4, 2, 0, 3, 1};
RolePlanes shuffled_roles(const Frame& whole) {
    RolePlanes roles;
    roles.position = {2, 4, 1};
    roles.depth = whole.roles.depth == no_plane ? no_plane : 3;
    roles.coverage = whole.roles.coverage == no_plane ? no_plane : 0;
    return roles;
}

/// What is known of a picture that is read in bands.
Frame without_planes(const Frame& whole) {
    Frame frame;
    frame.data_window = whole.data_window;
    frame.display_window = whole.display_window;
    frame.pixel_aspect = whole.pixel_aspect;
    frame.roles = whole.roles;
    frame.view = whole.view;
    return frame;
}

/// Recovers from the whole and from bands; returns the number of visits.
int expect_same_recovery(const Frame& whole, int tries = 3) {
    const RecoveredView expected = recover_view(whole);
    const double expected_error = reprojection_error(whole);
    int visits = 0;
    for (int i = 0; i < tries; ++i) {
        const VisitRows rows =
            random_bands(whole, shuffled_roles(whole), shuffled_planes, static_cast<unsigned>(i), visits);
        EXPECT_EQ(reprojection_error(without_planes(whole), rows), expected_error);
        visits = 0;
        const RecoveredView recovered = recover_view(without_planes(whole), rows);
        expect_identical(recovered.view, expected.view);
        EXPECT_EQ(recovered.samples, expected.samples);
        EXPECT_EQ(recovered.median_error_px, expected.median_error_px);
        EXPECT_EQ(recovered.p99_error_px, expected.p99_error_px);
        EXPECT_EQ(recovered.inlier_fraction, expected.inlier_fraction);
    }
    return visits;
}

TEST(CameraBands, PerspectiveAndOrthographic) {
    EXPECT_EQ(expect_same_recovery(make_frame(perspective(display), display, display, 1.0, blocks)), 1);
    EXPECT_EQ(expect_same_recovery(make_frame(orthographic(display), display, display, 1.0, blocks)), 1);
}

TEST(CameraBands, SmallPicturesAreSeenOnce) {
    constexpr Window small{0, 0, 199, 99}; // the coarse lattice has every pixel
    EXPECT_EQ(expect_same_recovery(make_frame(perspective(small), small, small, 1.0, blocks)), 1);
    EXPECT_EQ(
        expect_same_recovery(make_frame(perspective(small), small, small, 1.0,
                                        [](int x, int y) { return x % 20 == 3 && y % 20 == 5 ? 5.0 + x : -1.0; })),
        1);
}

TEST(CameraBands, FewPixelsNeedEveryPixel) {
    // The lattice of every second pixel starts at 1: even columns are not on it.
    const Frame none = make_frame(perspective(display), display, display, 1.0, [](int x, int y) {
        return x % 30 == 4 && y % 5 < 2 ? 5.0 + (x * 7 + y) % 11 : -1.0;
    });
    EXPECT_EQ(expect_same_recovery(none), 2);
    EXPECT_EQ(recover_view(none).samples, 4000); // of 30 x 240
    const Frame half = make_frame(perspective(display), display, display, 1.0, [](int x, int y) {
        return x % 30 == 5 && y % 20 < 2 ? 5.0 + (x * 7 + y) % 11 : -1.0;
    });
    EXPECT_EQ(expect_same_recovery(half), 2);
    EXPECT_EQ(recover_view(half).samples, 1800); // 900 on the lattice
}

TEST(CameraBands, EdgesCountWhereThereIsLittleElse) {
    Frame frame = make_frame(perspective(display), display, display, 1.0, blocks);
    for (int y = 0; y < frame.planes.height(); ++y) {
        for (float& coverage : frame.planes.row(testing::coverage_plane, y)) {
            coverage *= 0.5F;
        }
    }
    EXPECT_EQ(expect_same_recovery(frame), 2);
    frame.roles.depth = no_plane;
    EXPECT_EQ(expect_same_recovery(frame), 2);
    frame.roles.coverage = no_plane;
    EXPECT_EQ(expect_same_recovery(frame), 1);
}

/// What the samples of a whole picture are, said plainly.
std::vector<CameraSample> plain_samples(const Frame& frame, int step, float least_coverage) {
    std::vector<CameraSample> all;
    for (int y = step / 2; y < frame.planes.height(); y += step) {
        for (int x = step / 2; x < frame.planes.width(); x += step) {
            const auto at = [&](int plane) { return static_cast<double>(frame.planes.at(plane, x, y)); };
            if (frame.planes.at(testing::coverage_plane, x, y) > least_coverage) {
                all.push_back({{x + 0.5, y + 0.5}, {at(0), at(1), at(2)}, at(testing::depth_plane)});
            }
        }
    }
    if (all.size() <= 4000) {
        return all;
    }
    std::vector<CameraSample> some;
    for (std::size_t i = 0; i < 4000; ++i) {
        some.push_back(all[i * all.size() / 4000]);
    }
    return some;
}

void expect_samples(const Frame& frame, const std::vector<CameraSample>& expected) {
    const std::vector<CameraSample> samples = collect_samples(frame.data_window, whole_picture(frame));
    ASSERT_EQ(samples.size(), expected.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        ASSERT_EQ(samples[i].pixel, expected[i].pixel) << i;
        ASSERT_EQ(samples[i].position, expected[i].position) << i;
        ASSERT_EQ(samples[i].depth, expected[i].depth) << i;
    }
}

TEST(CameraSamples, ComeFromTheLatticeThatGivesEnough) {
    constexpr Window large{0, 0, 999, 799}; // sqrt(800000 / 65536) = 3.49: every third pixel
    const View view = perspective(large);
    Frame frame = make_frame(view, large, large, 1.0, [](int x, int y) { return 5.0 + (x / 16 + y / 16) % 7; });
    expect_samples(frame, plain_samples(frame, 3, 0.999F));
    for (int y = 0; y < frame.planes.height(); ++y) { // edges but for 900 whole pixels of the lattice
        for (int x = 0; x < frame.planes.width(); ++x) {
            const bool whole = x % 3 == 1 && y % 3 == 1 && x < 90 && y < 90;
            frame.planes.at(testing::coverage_plane, x, y) = whole ? 1.0F : 0.25F;
        }
    }
    expect_samples(frame, plain_samples(frame, 1, 0.999F)); // the same 900: fewer than 1000, but more than 200
    for (int y = 40; y < frame.planes.height(); ++y) {
        for (float& coverage : frame.planes.row(testing::coverage_plane, y)) {
            coverage = 0.25F;
        }
    }
    for (float& coverage : frame.planes.row(testing::coverage_plane, 1)) {
        coverage = std::min(coverage, 0.25F);
    }
    expect_samples(frame, plain_samples(frame, 1, 0.999F)); // 12 rows of 30
    for (int y = 16; y < 40; ++y) {
        for (float& coverage : frame.planes.row(testing::coverage_plane, y)) {
            coverage = 0.25F;
        }
    }
    expect_samples(frame, plain_samples(frame, 3, 0.0F)); // 4 rows of 30: too few, edges are taken
}

TEST(CameraBands, MoreThanAreKeptBeside) {
    // Whole pixels everywhere but on the lattice: they are too many to be kept and are looked for again.
    constexpr Window large{0, 0, 999, 799};
    const View view = perspective(large);
    const Frame frame = make_frame(view, large, large, 1.0, [](int x, int y) {
        return x % 3 == 1 && y % 3 == 1 ? -1.0 : 5.0 + (x / 16 + y / 16) % 7 + 0.01 * x;
    });
    EXPECT_EQ(expect_same_recovery(frame), 3);
    expect_samples(frame, plain_samples(frame, 1, 0.999F));
}

TEST(FinishFrameInBands, IsAsFromTheWhole) {
    ImageLayout layout = blender_layout();
    layout.display_window = {0, 0, 319, 199};
    layout.parts[0].data_window = {20, 10, 299, 189};
    for (const bool recovered : {true, false}) {
        Scene scene = plain_scene();
        scene.lights.resize(1);
        scene.lights[0].in_camera_space = true;
        if (recovered) {
            scene.camera.reset();
        }
        FramePlan whole = plan_of(layout, scene);
        FramePlan plan = plan_of(layout, scene);
        const std::vector<int> planes = camera_planes(plan);
        std::vector<std::string> names(planes.size());
        std::transform(planes.begin(), planes.end(), names.begin(),
                       [&](int plane) { return plan.frame.plane_names[static_cast<std::size_t>(plane)]; });
        EXPECT_THAT(names, ::testing::ElementsAre("ViewLayer.Position.X", "ViewLayer.Position.Y",
                                                  "ViewLayer.Position.Z", "ViewLayer.Depth.Z", "ViewLayer.UV.A"));
        EXPECT_EQ(camera_frame(plan).plane_names, names);
        // Another camera's positions, so that there is something to say in both cases.
        const Frame seen = make_frame(view_from_camera(camera_at({2, -9, 4}, {0, 0, 1}, Lens::fov_x, 1.0),
                                                       plan.frame.data_window, plan.frame.display_window, 1.0),
                                      plan.frame.data_window, plan.frame.display_window, 1.0, blocks);
        allocate_planes(whole);
        for (std::size_t i = 0; i < planes.size(); ++i) {
            for (int y = 0; y < seen.planes.height(); ++y) {
                const auto source = seen.planes.row(static_cast<int>(i), y);
                std::copy(source.begin(), source.end(), whole.frame.planes.row(planes[i], y).begin());
            }
        }
        int visits = 0;
        const VisitRows rows = random_bands(whole, 3, visits);
        const Frame in_bands = finish_frame(std::move(plan), rows);
        EXPECT_EQ(in_bands.planes.count(), 0);
        EXPECT_EQ(visits, 1);
        const Frame expected = finish_frame(std::move(whole));
        expect_identical(in_bands.view, expected.view);
        EXPECT_EQ(in_bands.notes, expected.notes);
        EXPECT_EQ(in_bands.warnings, expected.warnings);
        EXPECT_EQ(in_bands.lights[0].direction, expected.lights[0].direction);
        EXPECT_THAT(recovered ? expected.notes : expected.warnings, ::testing::SizeIs(1));
    }
}

TEST(FinishFrameInBands, LooksAtNothingWithoutNeed) {
    const auto never = [](const std::function<void(const Frame&)>& /*visit*/) { FAIL() << "was asked for rows"; };
    // No position.
    FramePlan plan = plan_of(testing::layout_of({testing::layer("N", "XYZ"), testing::layer("Z", "V")}), plain_scene());
    EXPECT_THAT(camera_planes(plan), ::testing::IsEmpty());
    EXPECT_EQ(camera_frame(plan).roles.position[0], no_plane);
    (void)finish_frame(std::move(plan), never);
    // A camera without a lens: nothing to hold against the position.
    Scene scene = plain_scene();
    scene.camera->lens = Lens::unknown;
    plan = plan_of(blender_layout(), scene);
    EXPECT_THAT(camera_planes(plan), ::testing::IsEmpty());
    (void)finish_frame(std::move(plan), never);
}

TEST(FinishFrameInBands, TroubleWithTheRowsIsPassedOn) {
    Scene scene = plain_scene();
    scene.camera.reset();
    const auto broken = [](const std::function<void(const Frame&)>& /*visit*/) {
        throw RuntimeFailure("no such rows");
    };
    EXPECT_THROW((void)finish_frame(plan_of(blender_layout(), scene), broken), RuntimeFailure);
}

} // namespace
} // namespace clshade
