// Cameras of real pictures, recovered from bands: the same to the last bit.
#include "host/gbuffer/camera.h"
#include "host/gbuffer/frame_builder.h"
#include "host/images/image_reader.h"
#include "host/scene/scene_file.h"
#include "tests/gbuffer/bands.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace clshade {
namespace {

FramePlan plan_of(const ImageLayout& layout) {
    const Scene scene = default_scene();
    return plan_frame(layout, assign_roles(layout, scene.gbuffer, ""), scene);
}

TEST(CameraBands, OfBlendersPictures) {
    for (const std::string name : {"suzanne_crop.exr", "room_crop.exr", "crypto_crop.exr"}) {
        SCOPED_TRACE(name);
        const std::filesystem::path file = std::filesystem::path(CLSHADE_TEST_DATA) / name;
        const ImageLayout layout = read_layout(file);
        FramePlan whole = plan_of(layout);
        ASSERT_TRUE(whole.recover_camera);
        allocate_planes(whole);
        read_planes(file, layout, whole, 1);
        for (unsigned seed = 0; seed < 3; ++seed) {
            int visits = 0;
            const VisitRows rows = testing::random_bands(whole, seed, visits);
            const Frame in_bands = finish_frame(plan_of(layout), rows);
            const RecoveredView expected = recover_view(whole.frame);
            EXPECT_GE(visits, 1);
            EXPECT_GT(expected.samples, 500);
            EXPECT_EQ(in_bands.view.eye, expected.view.eye);
            EXPECT_EQ(in_bands.view.camera_to_world, expected.view.camera_to_world);
            EXPECT_EQ(in_bands.view.direction, expected.view.direction);
            EXPECT_EQ(in_bands.view.direction_dx, expected.view.direction_dx);
            EXPECT_EQ(in_bands.view.direction_dy, expected.view.direction_dy);
        }
    }
}

} // namespace
} // namespace clshade
