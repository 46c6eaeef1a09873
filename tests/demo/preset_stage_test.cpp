// The stage of the presets' thumbnails.
#include "host/demo/preset_stage.h"

#include <gtest/gtest.h>

#include <cmath>

namespace clshade {
namespace {

TEST(PresetStage, ShowsTheWholeBodyOnAFloor) {
    constexpr int size = 96;
    const DemoFrame stage = render_preset_stage(size, 2);
    ASSERT_EQ(stage.plane_names.size(), static_cast<std::size_t>(stage.planes.count()));
    EXPECT_EQ(stage.plane_names.back(), "MaterialID.V");
    const int id = stage.planes.count() - 1;
    int body = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            glm::dvec3 normal;
            for (int c = 0; c < 3; ++c) {
                normal[c] = static_cast<double>(stage.planes.at(c, x, y));
            }
            EXPECT_NEAR(glm::length(normal), 1.0, 1e-6); // three roundings to float
            const bool on_body = stage.planes.at(id, x, y) == 1.0F;
            body += on_body ? 1 : 0;
            const bool edge = x == 0 || y == 0 || x == size - 1 || y == size - 1;
            EXPECT_FALSE(edge && on_body) << "the body is cut off at (" << x << ", " << y << ")";
            EXPECT_EQ(on_body, stage.planes.at(6, x, y) == 0.0F) << "only the floor has an albedo";
        }
    }
    EXPECT_GT(body, size * size / 4);
    EXPECT_LT(body, size * size / 2);
}

// The camera that comes with the planes is the one that saw them.
TEST(PresetStage, PositionsLieOnThePixelsRays) {
    constexpr int size = 64;
    const DemoFrame stage = render_preset_stage(size, 1);
    const glm::dmat4 to_camera = glm::inverse(stage.camera.matrix_world);
    const double half = std::tan(0.5 * stage.camera.lens_value);
    for (int y = 0; y < size; y += 7) {
        for (int x = 0; x < size; x += 7) {
            glm::dvec4 position(0.0, 0.0, 0.0, 1.0);
            for (int c = 0; c < 3; ++c) {
                position[c] = static_cast<double>(stage.planes.at(3 + c, x, y));
            }
            const glm::dvec4 seen = to_camera * position;
            // Positions are floats of size below 20: 1e-6 of scene units, 1e-5 of a pixel.
            EXPECT_NEAR((seen.x / -seen.z / half + 1.0) * 0.5 * size, x + 0.5, 1e-4);
            EXPECT_NEAR((1.0 - seen.y / -seen.z / half) * 0.5 * size, y + 0.5, 1e-4);
        }
    }
}

TEST(PresetStage, TheThreadsDoNotMatter) {
    const DemoFrame one = render_preset_stage(32, 1);
    const DemoFrame two = render_preset_stage(32, 2);
    EXPECT_TRUE(std::equal(one.planes.all().begin(), one.planes.all().end(), two.planes.all().begin()));
}

TEST(PresetStage, IsLitFromAllSidesAndMostFromTheKey) {
    glm::dvec3 power(0.0);
    glm::dvec3 mean(0.0); // where the light comes from
    for (const Light& light : preset_stage_lights()) {
        ASSERT_EQ(light.type, LightType::distant);
        EXPECT_GT(light.power.x, 0.0);
        power += light.power;
        mean -= light.power.y * light.direction;
    }
    EXPECT_LT(mean.x, 0.0) << "the key stands to the left";
    EXPECT_LT(mean.y, 0.0) << "and on the camera's side";
    EXPECT_GT(mean.z, 0.0);
    EXPECT_NEAR(power.x / power.z, 1.0, 0.1) << "white on the whole";
}

TEST(PresetStage, TheBodyIsThePreset) {
    const std::string text = preset_stage_materials("gold");
    EXPECT_NE(text.find("preset = \"gold\""), std::string::npos);
    EXPECT_NE(text.find("ids = [1]"), std::string::npos);
}

} // namespace
} // namespace clshade
