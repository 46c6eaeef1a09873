// How an environment stands in the world, and what joins it to a frame.
#include "host/base/error.h"
#include "host/gbuffer/environment_binding.h"
#include "host/gbuffer/random_gbuffer.h"
#include "host/scene/scene_file.h"
#include "tests/gbuffer/plans.h"

#include <glm/gtc/constants.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

namespace clshade {
namespace {

using ::testing::AllOf;
using testing::camera_at;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const glm::dvec3 x_axis(1.0, 0.0, 0.0);
const glm::dvec3 y_axis(0.0, 1.0, 0.0);
const glm::dvec3 z_axis(0.0, 0.0, 1.0);

/// A few roundings of numbers of about 1.
constexpr double rounding = 1e-14;

/// Where the picture shows a direction of its own frame (lat_long.h).
glm::dvec2 place_of(const glm::dvec3& d) {
    return {0.5 - std::atan2(d.y, d.x) / (2.0 * glm::pi<double>()),
            std::acos(std::clamp(d.z, -1.0, 1.0)) / glm::pi<double>()};
}

void expect_place(const glm::dmat3& world_to_image, const glm::dvec3& world, double u, double v) {
    const glm::dvec2 place = place_of(world_to_image * world);
    EXPECT_NEAR(place.x, u, rounding) << world.x << " " << world.y << " " << world.z;
    EXPECT_NEAR(place.y, v, rounding) << world.x << " " << world.y << " " << world.z;
}

double distance(const glm::dmat3& a, const glm::dmat3& b) {
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
        largest = std::max(largest, glm::length(a[i] - b[i]));
    }
    return largest;
}

void expect_rotation(const glm::dmat3& m) {
    EXPECT_LT(distance(glm::transpose(m) * m, glm::dmat3(1.0)), rounding);
    EXPECT_NEAR(glm::determinant(m), 1.0, rounding);
}

// conventions.md section 4: u = 0.5 - atan2(y, x)/2pi, v = acos(z)/pi; centre +X, +Y at u = 0.25.
TEST(WorldToImage, UpZIsBlenders) {
    const glm::dmat3 m = world_to_image(UpAxis::z, 0.0);
    expect_place(m, x_axis, 0.5, 0.5);
    expect_place(m, y_axis, 0.25, 0.5);
    expect_place(m, -y_axis, 0.75, 0.5);
    EXPECT_NEAR((m * z_axis).z, 1.0, rounding); // row 0
    const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, -0.8, 0.4));
    expect_place(m, d, 0.5 - std::atan2(d.y, d.x) / (2.0 * glm::pi<double>()), std::acos(d.z) / glm::pi<double>());
}

// Row 0 = +Y; centre +Z; longitude falls with the columns and is pi/2 at +X: u = 0.5 - atan2(x, z)/2pi.
TEST(WorldToImage, UpYIsOpenExrs) {
    const glm::dmat3 m = world_to_image(UpAxis::y, 0.0);
    expect_place(m, z_axis, 0.5, 0.5);
    expect_place(m, x_axis, 0.25, 0.5);
    expect_place(m, -x_axis, 0.75, 0.5);
    EXPECT_NEAR((m * y_axis).z, 1.0, rounding); // row 0
    const glm::dvec3 d = glm::normalize(glm::dvec3(-0.5, 0.6, -0.2));
    expect_place(m, d, 0.5 - std::atan2(d.x, d.z) / (2.0 * glm::pi<double>()), std::acos(d.y) / glm::pi<double>());
}

/// What stood at azimuth a stands at a + rotation.
TEST(WorldToImage, TurnsCounterClockwise) {
    const double quarter = glm::half_pi<double>();
    const glm::dmat3 z = world_to_image(UpAxis::z, quarter);
    expect_place(z, y_axis, 0.5, 0.5); // the centre stood at +X
    expect_place(z, -x_axis, 0.25, 0.5);
    EXPECT_NEAR((z * z_axis).z, 1.0, rounding);
    const glm::dmat3 y = world_to_image(UpAxis::y, quarter); // about +Y: from +Z to +X
    expect_place(y, x_axis, 0.5, 0.5);
    expect_place(y, -z_axis, 0.25, 0.5);
    EXPECT_NEAR((y * y_axis).z, 1.0, rounding);
    const double azimuth = 0.4;
    const double turn = 0.7;
    const glm::dvec3 before(std::cos(azimuth), std::sin(azimuth), 0.0);
    const glm::dvec3 after(std::cos(azimuth + turn), std::sin(azimuth + turn), 0.0);
    EXPECT_LT(glm::length(world_to_image(UpAxis::z, turn) * after - world_to_image(UpAxis::z, 0.0) * before), rounding);
}

TEST(WorldToImage, IsARotation) {
    for (const UpAxis up : all_up_axes) {
        for (const double rotation : {0.0, 0.3, -2.0, 100.0}) {
            expect_rotation(world_to_image(up, rotation));
        }
    }
}

std::shared_ptr<const LatLong> picture(std::optional<UpAxis> up) {
    LatLong image;
    image.name = "grey";
    image.width = 2;
    image.height = 1;
    image.rgb = {1, 1, 1, 1, 1, 1};
    image.up = up;
    return std::make_shared<const LatLong>(image);
}

Scene scene_with_environment() {
    Scene scene;
    scene.environment.emplace();
    return scene;
}

Frame frame_with_rays() {
    Frame frame;
    frame.file = "room.exr";
    frame.view.has_rays = true;
    return frame;
}

glm::dmat3 attached_matrix(const Scene& scene, std::optional<UpAxis> up_of_picture) {
    Frame frame = frame_with_rays();
    attach_environment(frame, scene, picture(up_of_picture), nullptr);
    return frame.environment.value().world_to_image;
}

TEST(AttachEnvironment, TakesTheScenesValues) {
    Frame frame = frame_with_rays();
    Scene scene = scene_with_environment();
    scene.environment->intensity = {1.0, 0.5, 2.0};
    scene.environment->diffuse = AmbientSource::irradiance_map;
    const auto image = picture(std::nullopt);
    const auto maps = std::make_shared<const FilteredSet>();
    attach_environment(frame, scene, image, maps);
    ASSERT_TRUE(frame.environment.has_value());
    EXPECT_EQ(frame.environment->intensity, glm::dvec3(1.0, 0.5, 2.0));
    EXPECT_EQ(frame.environment->diffuse, AmbientSource::irradiance_map);
    EXPECT_FALSE(frame.environment->background);
    EXPECT_EQ(frame.environment->image, image);
    EXPECT_EQ(frame.environment->maps, maps);
    scene.environment.reset();
    attach_environment(frame, scene, image, maps);
    EXPECT_FALSE(frame.environment.has_value());
}

TEST(AttachEnvironment, UpIsTheScenesElseThePicturesElseZ) {
    const glm::dmat3 z = world_to_image(UpAxis::z, 0.3);
    const glm::dmat3 y = world_to_image(UpAxis::y, 0.3);
    Scene scene = scene_with_environment();
    scene.environment->rotation = 0.3;
    EXPECT_EQ(attached_matrix(scene, std::nullopt), z);
    EXPECT_EQ(attached_matrix(scene, UpAxis::z), z);
    EXPECT_EQ(attached_matrix(scene, UpAxis::y), y);
    scene.environment->up = UpAxis::z;
    EXPECT_EQ(attached_matrix(scene, UpAxis::y), z);
    scene.environment->up = UpAxis::y;
    EXPECT_EQ(attached_matrix(scene, UpAxis::z), y);
}

TEST(AttachEnvironment, OfASetUpIsTheScenesElseTheSetsElseZ) {
    Scene scene = scene_with_environment();
    const auto matrix_of = [&](std::optional<UpAxis> up_of_set) {
        FilteredSet set;
        set.up = up_of_set;
        Frame frame; // needs no rays
        attach_environment(frame, scene, nullptr, std::make_shared<const FilteredSet>(set));
        return frame.environment.value().world_to_image;
    };
    EXPECT_EQ(matrix_of(std::nullopt), world_to_image(UpAxis::z, 0.0));
    EXPECT_EQ(matrix_of(UpAxis::y), world_to_image(UpAxis::y, 0.0));
    scene.environment->up = UpAxis::z;
    EXPECT_EQ(matrix_of(UpAxis::y), world_to_image(UpAxis::z, 0.0));
}

TEST(AttachEnvironment, TheStudioTurnsWithTheCamera) {
    // The camera looks along the world's +Y, with +Z up: its +X is the world's +X, its +Y the world's +Z.
    const Camera camera = camera_at({0, -5, 0}, {0, 0, 0}, Lens::fov_y, 0.7);
    Frame frame = frame_with_rays();
    frame.view.camera_to_world = glm::dmat3(camera.matrix_world);
    Scene scene = default_scene();
    attach_environment(frame, scene, picture(UpAxis::y), nullptr);
    const glm::dmat3 m = frame.environment.value().world_to_image;
    expect_rotation(m);
    EXPECT_NEAR((m * z_axis).z, 1.0, rounding); // row 0 above the camera
    expect_place(m, -y_axis, 0.5, 0.5);         // the centre is the camera's +Z, behind it
    expect_place(m, x_axis, 0.25, 0.5);         // to its right
    scene.environment->rotation = glm::half_pi<double>();
    attach_environment(frame, scene, picture(UpAxis::y), nullptr);
    expect_place(frame.environment->world_to_image, x_axis, 0.5, 0.5); // from +Z to +X of the camera
}

std::string attach_error(Frame& frame, const Scene& scene, std::shared_ptr<const LatLong> image) {
    try {
        attach_environment(frame, scene, std::move(image), std::make_shared<const FilteredSet>());
    } catch (const UsageError& error) {
        return error.what();
    }
    return "no error";
}

TEST(AttachEnvironment, ABackgroundNeedsRaysAndThePicture) {
    Scene scene = scene_with_environment();
    scene.environment->image = "sky.set";
    scene.background = true;
    Frame frame = frame_with_rays();
    attach_environment(frame, scene, picture(std::nullopt), nullptr);
    EXPECT_TRUE(frame.environment->background);
    EXPECT_THAT(attach_error(frame, scene, nullptr),
                AllOf(StartsWith("room.exr: 'sky.set' is a pre-filtered set"), HasSubstr("; name the picture")));
    frame.view.has_rays = false;
    EXPECT_THAT(attach_error(frame, scene, picture(std::nullopt)),
                AllOf(HasSubstr("the camera of room.exr has no field of view"), HasSubstr("; write [camera]")));
    scene.environment->where = {"shot.toml", 3, 2};
    EXPECT_THAT(attach_error(frame, scene, picture(std::nullopt)), StartsWith("shot.toml:3:2: background = true"));
    scene.background = false;
    EXPECT_EQ(attach_error(frame, scene, picture(std::nullopt)), "no error");
    EXPECT_EQ(attach_error(frame, scene, nullptr), "no error");
}

TEST(RandomEnvironment, IsARotationAndAnIntensity) {
    const auto image = picture(std::nullopt);
    glm::dvec3 mean(0.0);
    constexpr int count = 400;
    for (int seed = 0; seed < count; ++seed) {
        Frame frame;
        add_random_environment(frame, image, AmbientSource::sh3, static_cast<std::uint64_t>(seed));
        ASSERT_TRUE(frame.environment.has_value());
        const BoundEnvironment& environment = *frame.environment;
        expect_rotation(environment.world_to_image);
        mean += environment.world_to_image * glm::normalize(glm::dvec3(1.0, 2.0, 3.0)) / static_cast<double>(count);
        for (int i = 0; i < 3; ++i) {
            EXPECT_GE(environment.intensity[i], 0.5);
            EXPECT_LE(environment.intensity[i], 2.0);
        }
        EXPECT_NE(environment.intensity.x, environment.intensity.y);
        EXPECT_EQ(environment.diffuse, AmbientSource::sh3);
        EXPECT_EQ(environment.image, image);
        EXPECT_EQ(environment.maps, nullptr);
        EXPECT_FALSE(environment.background);
    }
    // Directions all round: their mean has a deviation of 1/sqrt(400) = 0.05 in all.
    EXPECT_LT(glm::length(mean), 0.15);
}

TEST(RandomEnvironment, SameSeedSameValues) {
    const auto matrix_of = [](std::uint64_t seed) {
        Frame frame;
        add_random_environment(frame, picture(std::nullopt), AmbientSource::sh2, seed);
        return frame.environment.value().world_to_image;
    };
    EXPECT_EQ(matrix_of(7), matrix_of(7));
    EXPECT_GT(distance(matrix_of(7), matrix_of(8)), 0.01);
}

} // namespace
} // namespace clshade
