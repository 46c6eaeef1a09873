#include "host/demo/demo_letters.h"
#include "host/demo/demo_shapes.h"
#include "host/demo/demo_stage.h"
#include "host/demo/demo_tracer.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace clshade::demo {
namespace {

float nearest_sample(glm::vec2 p, const Stroke& stroke) {
    float nearest = 1e9F;
    constexpr int count = 20000;
    for (int i = 0; i <= count; ++i) {
        const float t = static_cast<float>(i) / count;
        const float angle = stroke.middle + (2.0F * t - 1.0F) * stroke.half_angle;
        const glm::vec2 on = stroke.is_arc ? stroke.a + stroke.radius * glm::vec2(std::cos(angle), std::sin(angle))
                                           : glm::mix(stroke.a, stroke.b, t);
        nearest = std::min(nearest, glm::length(p - on));
    }
    return nearest;
}

TEST(DemoShapes, StrokeDistancesMatchTheirPoints) {
    const std::array<Stroke, 5> strokes{line({0.1F, 0.2F}, {0.9F, -0.4F}), arc({0.5F, 0.5F}, 0.4F, 48.0F, 312.0F),
                                        arc({0.0F, 0.0F}, 0.3F, -90.0F, 90.0F), arc({0.2F, 0.1F}, 0.5F, 195.0F, 270.0F),
                                        arc({0.5F, 0.5F}, 0.4F, 0.0F, 360.0F)};
    std::mt19937 random(7);
    std::uniform_real_distribution<float> spread(-1.0F, 2.0F);
    for (const Stroke& stroke : strokes) {
        for (int i = 0; i < 50; ++i) {
            const glm::vec2 p(spread(random), spread(random));
            // Samples lie at most 2.6 / 20000 apart, so the nearest is at most half of that beyond the true distance.
            EXPECT_NEAR(distance_to_strokes(p, std::span(&stroke, 1)), nearest_sample(p, stroke), 1e-4F)
                << p.x << ' ' << p.y;
        }
    }
}

TEST(DemoShapes, SolidsHaveTheirSizes) {
    const glm::vec3 half(2.0F, 1.0F, 0.5F);
    EXPECT_NEAR(rounded_box({2.0F, 0.0F, 0.0F}, half, 0.1F), 0.0F, 1e-6F);
    EXPECT_NEAR(rounded_box({3.0F, 0.5F, 0.0F}, half, 0.1F), 1.0F, 1e-6F);
    EXPECT_NEAR(rounded_box({0.0F, 0.0F, 0.0F}, half, 0.1F), -0.5F, 1e-6F);
    // The rounding takes (sqrt 3 - 1) radius off a corner.
    EXPECT_NEAR(rounded_box(half, half, 0.1F), 0.1F * (std::sqrt(3.0F) - 1.0F), 1e-6F);
    EXPECT_NEAR(rounded_cylinder({0.0F, 3.0F, 0.0F}, 2.0F, 0.5F, 0.1F), 1.0F, 1e-6F);
    EXPECT_NEAR(rounded_cylinder({0.5F, 0.0F, 0.75F}, 2.0F, 0.5F, 0.1F), 0.25F, 1e-6F);
    EXPECT_NEAR(extruded(0.3F, 0.0F, 0.2F, 0.05F), 0.3F, 1e-6F);
    EXPECT_NEAR(extruded(-1.0F, 0.5F, 0.2F, 0.05F), 0.3F, 1e-6F);
}

TEST(DemoShapes, TheWordHasSevenLettersInsideTheirBoxes) {
    const std::vector<Letter> letters = word();
    ASSERT_EQ(letters.size(), 7U);
    for (const Letter& letter : letters) {
        // Outside the box [0, width] x [0, 1.5] there is no ink, except the rounding error of single precision.
        for (int row = 0; row < 125; ++row) {
            for (int column = 0; column < 100; ++column) {
                const float x = -0.5F + 0.02F * static_cast<float>(column);
                const float y = -0.5F + 0.02F * static_cast<float>(row);
                const bool inside = x > -1e-4F && x < letter.width + 1e-4F && y > -1e-4F && y < 1.5001F;
                const bool ink = distance_to_strokes({x, y}, letter.strokes) < pen;
                EXPECT_TRUE(inside || !ink) << x << ' ' << y;
            }
        }
    }
    const auto ink = [&](std::size_t letter, glm::vec2 p) {
        return distance_to_strokes(p, letters.at(letter).strokes) < pen;
    };
    EXPECT_TRUE(ink(0, {0.1F, 0.5F}) && !ink(0, {0.9F, 0.5F})) << "c is open to the right";
    EXPECT_TRUE(ink(3, {0.1F, 1.3F}) && !ink(3, {0.6F, 1.3F})) << "h has its stem on the left";
    EXPECT_TRUE(ink(5, {0.9F, 1.3F}) && !ink(5, {0.1F, 1.3F})) << "d has its stem on the right";
    EXPECT_TRUE(ink(6, {0.5F, 0.5F}) && !ink(4, {0.5F, 0.5F})) << "e has a bar, a has none";
}

TEST(DemoStage, BoundsHoldTheirObjects) {
    std::mt19937 random(11);
    std::normal_distribution<float> normal(0.0F, 1.0F);
    for (const Object& object : build_stage().objects) {
        for (int i = 0; i < 200; ++i) {
            const glm::vec3 direction = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
            EXPECT_GE(object.distance(object.centre + (object.bound + 1e-4F) * direction), 0.0F);
        }
    }
}

TEST(DemoStage, DistancesNeverOvershoot) {
    // Sphere tracing is right only if no distance changes faster than the point moves.
    std::mt19937 random(13);
    std::uniform_real_distribution<float> spread(-1.5F, 1.5F);
    for (const Object& object : build_stage().objects) {
        for (int i = 0; i < 200; ++i) {
            const auto point = [&] {
                return object.centre + object.bound * glm::vec3(spread(random), spread(random), spread(random));
            };
            const glm::vec3 a = point();
            const glm::vec3 b = point();
            // Rounding: a few units of 1e-6 of the scene's size.
            EXPECT_LE(std::abs(object.distance(a) - object.distance(b)), glm::length(a - b) + 2e-5F);
        }
    }
}

TEST(DemoTracer, MeetsASphereWhereAlgebraSays) {
    Stage stage;
    Object ball;
    ball.centre = {0.5F, 3.0F, -0.25F};
    ball.size = glm::vec3(0.75F);
    ball.bound = 0.75F;
    stage.objects = {ball};
    for (const glm::vec3 direction : {glm::vec3(0.1F, 1.0F, 0.0F), glm::vec3(0.2F, 1.0F, -0.2F)}) {
        const glm::vec3 unit = glm::normalize(direction);
        const float along = glm::dot(ball.centre, unit);
        const float expected = along - std::sqrt(0.75F * 0.75F - glm::dot(ball.centre, ball.centre) + along * along);
        const Hit hit = trace(stage, glm::vec3(0.0F), unit);
        ASSERT_NE(hit.object, nullptr);
        // The march stops within 2e-5 of the surface; at these angles that is at most twice as far along the ray.
        EXPECT_NEAR(hit.distance, expected, 5e-5F);
        EXPECT_NEAR(glm::dot(hit.normal, glm::normalize(hit.point - ball.centre)), 1.0F, 1e-6F);
    }
    EXPECT_EQ(trace(stage, glm::vec3(0.0F), glm::vec3(0.0F, -1.0F, 0.0F)).object, nullptr) << "behind the eye";
    EXPECT_EQ(trace(stage, glm::vec3(0.0F), glm::vec3(0.0F, 0.0F, 1.0F)).object, nullptr) << "beside it";
}

TEST(DemoStage, CornersAreDarkerThanOpenGround) {
    const Stage stage = build_stage();
    const glm::vec3 up(0.0F, 0.0F, 1.0F);
    EXPECT_GT(stage.openness({0.0F, -4.0F, 0.0F}, up), 0.99F);
    EXPECT_LT(stage.openness({0.0F, -2.35F, 0.0F}, up), 0.5F) << "under a ball";
}

} // namespace
} // namespace clshade::demo
