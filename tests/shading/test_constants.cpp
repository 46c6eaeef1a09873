// Constants at the border: what the kernels read is what the frame holds.
#include "host/gbuffer/random_gbuffer.h"
#include "host/shading/constants.h"

#include <gtest/gtest.h>

#include <cmath>

namespace clshade {
namespace {

TEST(Constants, EyeAndLampsKeepWhatRoundingTakes) {
    Frame frame = random_frame(16, 4, SpecularModel::blinn_phong, DiffuseModel::lambert, 1);
    frame.view.eye = {1.1, -3.7, 2.3};
    const FrameConstants constants = frame_constants(frame);
    const auto lights = light_constants(frame);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(constants.eye_hi[i], static_cast<float>(frame.view.eye[i]));
        EXPECT_NE(constants.eye_lo[i], 0.0F);
        EXPECT_NEAR(static_cast<double>(constants.eye_hi[i]) + static_cast<double>(constants.eye_lo[i]),
                    frame.view.eye[i], 1e-14);
        for (std::size_t l = 0; l < lights.size(); ++l) {
            EXPECT_NEAR(static_cast<double>(lights[l].position_hi[i]) + static_cast<double>(lights[l].position_lo[i]),
                        frame.lights[l].position[i], 1e-13);
        }
    }
}

TEST(Constants, DistantLightsPointToTheLight) {
    Frame frame = random_frame(16, 4, SpecularModel::blinn_phong, DiffuseModel::lambert, 1);
    frame.lights.resize(1);
    frame.lights[0].type = LightType::distant;
    frame.lights[0].direction = {0.0, 0.0, -7.0};
    const auto lights = light_constants(frame);
    EXPECT_EQ(lights[0].direction[2], 1.0F);
    EXPECT_EQ(lights[0].type, LIGHT_DISTANT);
}

TEST(Constants, RotationRowsAreRows) {
    Frame frame = random_frame(16, 4, SpecularModel::blinn_phong, DiffuseModel::lambert, 1);
    const FrameConstants constants = frame_constants(frame);
    const glm::dvec3 camera(0.2, -0.4, 0.7);
    const glm::dvec3 world = frame.view.camera_to_world * camera;
    for (int row = 0; row < 3; ++row) {
        const float* r = constants.camera_to_world + 4 * row;
        const double product = static_cast<double>(r[0]) * camera.x + static_cast<double>(r[1]) * camera.y +
                               static_cast<double>(r[2]) * camera.z;
        EXPECT_NEAR(product, world[row], 1e-6);
    }
}

TEST(Constants, AFrameWithoutLightsStillGivesABuffer) {
    Frame frame = random_frame(16, 4, SpecularModel::blinn_phong, DiffuseModel::lambert, 1);
    frame.lights.clear();
    EXPECT_EQ(light_constants(frame).size(), 1U);
    EXPECT_EQ(frame_constants(frame).light_count, 0);
}

} // namespace
} // namespace clshade
