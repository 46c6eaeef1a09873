// Views of scene cameras and header attributes.
#include "host/base/error.h"
#include "host/gbuffer/camera.h"
#include "tests/gbuffer/layouts.h"
#include "tests/gbuffer/views.h"

#include <glm/gtc/constants.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace clshade {
namespace {

using testing::camera_at;
using testing::Ray;
using testing::ray_of;

constexpr double exact = 1e-12;     // double precision, a dozen operations
constexpr double six_digits = 2e-5; // header numbers as printed, six digits, some larger than 1
constexpr Window square{0, 0, 127, 127};

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    EXPECT_LE(glm::length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

/// Rows as stored in a file.
glm::dmat4 stored(const std::array<std::array<double, 4>, 4>& rows) {
    glm::dmat4 m(0.0);
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
            m[r][c] = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
        }
    }
    return m;
}

/// v M, as the file's row vectors are multiplied.
glm::dvec4 times(const glm::dvec4& v, const glm::dmat4& rows) {
    glm::dvec4 result(0.0);
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) {
            result[c] += v[r] * rows[r][c];
        }
    }
    return result;
}

ImageLayout layout_with_window(const Window& display) {
    ImageLayout layout = testing::blender_layout();
    layout.display_window = display;
    return layout;
}

/// Header matrices of a camera by the OpenEXR standard: left-handed camera space, NDC 0..1 with y down.
void add_standard_attributes(ImageLayout& layout, const Camera& camera, double half_width, double half_height,
                             bool orthographic) {
    glm::dmat4 to_camera = glm::inverse(camera.matrix_world);
    glm::dmat4 flip(1.0);
    flip[2][2] = -1.0;
    to_camera = flip * to_camera; // +z forward; a column-vector matrix is the stored one's twin
    layout.matrices["worldToCamera"] = to_camera;
    glm::dmat4 image(0.0); // camera to homogeneous NDC: x' = x / (2 half) + 0.5 w, y' = -y / (2 half) + 0.5 w
    image[0][0] = 0.5 / half_width;
    image[1][1] = -0.5 / half_height;
    const int carrier = orthographic ? 3 : 2;
    image[carrier][0] = 0.5;
    image[carrier][1] = 0.5;
    image[carrier][3] = 1.0;
    image[2][2] = 1.0;
    layout.matrices["worldToNDC"] = image * to_camera;
}

TEST(SceneCamera, FieldOfViewSpansTheDisplayWindow) {
    const Window display{0, 0, 199, 99};
    Camera camera; // at the origin, looks along -Z
    camera.lens = Lens::fov_y;
    camera.lens_value = glm::half_pi<double>();
    const View view = view_from_camera(camera, display, display, 1.0);
    ASSERT_TRUE(view.has_rays);
    // Top left corner of the window: half a pixel before the first pixel's centre.
    expect_near(ray_of(view, -0.5, -0.5).direction, {-2.0, 1.0, -1.0}, exact);
    expect_near(ray_of(view, 199.5, 99.5).direction, {2.0, -1.0, -1.0}, exact);
    camera.lens = Lens::fov_x;
    const View wide = view_from_camera(camera, display, display, 1.0);
    expect_near(ray_of(wide, -0.5, -0.5).direction, {-1.0, 0.5, -1.0}, exact);
}

TEST(SceneCamera, PixelAspectWidensX) {
    const Window display{0, 0, 99, 99};
    Camera camera;
    camera.lens = Lens::fov_y;
    camera.lens_value = glm::half_pi<double>();
    const View view = view_from_camera(camera, display, display, 1.5);
    expect_near(ray_of(view, 99.5, -0.5).direction, {1.5, 1.0, -1.0}, exact);
    camera.lens = Lens::fov_x;
    expect_near(ray_of(view_from_camera(camera, display, display, 1.5), 99.5, -0.5).direction, {1.0, 1.0 / 1.5, -1.0},
                exact);
}

TEST(SceneCamera, DirectionsHaveUnitDepthAndOrthographicRaysAreParallel) {
    const Window display{0, 0, 63, 31};
    const View view = view_from_camera(camera_at({3, -5, 2}, {0, 0, 1}, Lens::fov_x, 1.0), display, display, 1.0);
    for (const int x : {0, 17, 63}) {
        for (const int y : {0, 9, 31}) {
            EXPECT_NEAR(glm::dot(ray_of(view, x, y).direction, view.view_axis), 1.0, exact);
            expect_near(ray_of(view, x, y).origin, {3, -5, 2}, exact);
        }
    }
    const View flat =
        view_from_camera(camera_at({3, -5, 2}, {3, 5, 2}, Lens::orthographic, 4.0), display, display, 1.0);
    EXPECT_TRUE(flat.orthographic);
    expect_near(ray_of(flat, -0.5, -0.5).origin, {3 - 4, -5, 2 + 2}, exact);
    expect_near(ray_of(flat, 63.5, 31.5).origin, {3 + 4, -5, 2 - 2}, exact);
    expect_near(ray_of(flat, 5, 7).direction, {0, 1, 0}, exact);
}

TEST(SceneCamera, ACropSeesWhatTheWholeSees) {
    const Window display{-10, -20, 89, 79};
    const Window crop{20, 30, 59, 49};
    for (const Lens lens : {Lens::fov_y, Lens::orthographic}) {
        const Camera camera = camera_at({1, 2, 3}, {0, 0, 0}, lens, 0.8);
        const View whole = view_from_camera(camera, display, display, 1.2);
        const View part = view_from_camera(camera, crop, display, 1.2);
        const Ray a = ray_of(whole, 30 + 5, 50 + 4); // display starts 30 and 50 pixels before the crop
        const Ray b = ray_of(part, 5, 4);
        expect_near(a.origin, b.origin, exact);
        expect_near(a.direction, b.direction, exact);
    }
}

TEST(SceneCamera, WithoutALensOnlyThePoseIsKnown) {
    const View view = view_from_camera(camera_at({1, 2, 3}, {1, 5, 3}, Lens::unknown, 0.0), square, square, 1.0);
    EXPECT_FALSE(view.has_rays);
    expect_near(view.eye, {1, 2, 3}, exact);
    expect_near(view.view_axis, {0, 1, 0}, exact);
}

TEST(HeaderCamera, AbsentWithoutWorldToCamera) {
    ImageLayout layout = layout_with_window(square);
    EXPECT_FALSE(view_from_header(layout, square).has_value());
    layout.matrices["worldtocamera"] = glm::dmat4(1.0); // as some readers rename an inverted matrix
    layout.numbers["CameraFov"] = 45.0;
    EXPECT_FALSE(view_from_header(layout, square).has_value());
}

TEST(HeaderCamera, StandardAttributesGiveTheCameraBack) {
    const Window display{0, 0, 159, 89};
    const Window crop{10, 20, 99, 69};
    const double half_height = std::tan(0.35);
    const double half_width = half_height * 160.0 * 1.25 / 90.0;
    const Camera camera = camera_at({4, -7, 3}, {0, 0, 1}, Lens::fov_y, 0.7);
    ImageLayout layout = layout_with_window(display);
    layout.pixel_aspect = 1.25;
    add_standard_attributes(layout, camera, half_width, half_height, false);
    const auto view = view_from_header(layout, crop);
    ASSERT_TRUE(view.has_value());
    ASSERT_TRUE(view->has_rays);
    const View expected = view_from_camera(camera, crop, display, 1.25);
    expect_near(view->eye, expected.eye, 1e-11); // a matrix inverse and products of size 10
    EXPECT_LT(testing::worst_angle(*view, expected, crop), 1e-11);
    for (int i = 0; i < 3; ++i) {
        expect_near(view->camera_to_world[i], expected.camera_to_world[i], 1e-11);
    }
}

TEST(HeaderCamera, StandardOrthographic) {
    const Window display{0, 0, 159, 79};
    const Camera camera = camera_at({4, -7, 3}, {0, 0, 1}, Lens::orthographic, 5.0);
    ImageLayout layout = layout_with_window(display);
    add_standard_attributes(layout, camera, 5.0, 2.5, true);
    const auto view = view_from_header(layout, display);
    ASSERT_TRUE(view.has_value());
    ASSERT_TRUE(view->has_rays);
    EXPECT_TRUE(view->orthographic);
    const View expected = view_from_camera(camera, display, display, 1.0);
    expect_near(ray_of(*view, 3, 70).origin, ray_of(expected, 3, 70).origin, 1e-11);
    expect_near(view->view_axis, expected.view_axis, 1e-11);
}

/// psyop_multichannel.exr: Arnold 5.1 writes screen space into worldToNDC.
ImageLayout arnold_5_layout() {
    ImageLayout layout = layout_with_window(square);
    layout.matrices["worldToCamera"] = stored({{{0.707107, -0.339275, -0.620397, 0},
                                                {0, 0.877374, -0.479807, 0},
                                                {-0.707107, -0.339275, -0.620397, 0},
                                                {2.68221e-07, 0.164701, 3.07752, 1}}});
    layout.matrices["worldToNDC"] = stored({{{1.7071, -0.819081, -0.620413, -0.620397},
                                             {0, 2.11817, -0.47982, -0.479807},
                                             {-1.70711, -0.819081, -0.620413, -0.620397},
                                             {6.47542e-07, 0.397622, 2.97759, 3.07752}}});
    layout.numbers["CameraFov"] = 45.0;
    return layout;
}

TEST(HeaderCamera, Arnold5ScreenSpaceUnderTheNameOfNdc) {
    const ImageLayout layout = arnold_5_layout();
    const auto view = view_from_header(layout, square);
    ASSERT_TRUE(view.has_value());
    ASSERT_TRUE(view->has_rays);
    // The eye is where camera space has its origin.
    expect_near(glm::dvec3(times(glm::dvec4(view->eye, 1.0), layout.matrices.at("worldToCamera"))), {0, 0, 0},
                six_digits);
    // Right-handed world, camera above the ground that looks down and forward.
    EXPECT_NEAR(glm::determinant(view->camera_to_world), 1.0, six_digits);
    EXPECT_GT(view->eye.y, 0.0);
    EXPECT_LT(view->view_axis.y, 0.0);
    // The ray of a pixel's centre falls on that pixel by the file's own matrix: -1..1, y up.
    for (const int x : {0, 40, 127}) {
        for (const int y : {0, 90, 127}) {
            const Ray ray = ray_of(*view, x, y);
            const glm::dvec4 seen =
                times(glm::dvec4(ray.origin + 3.0 * ray.direction, 1.0), layout.matrices.at("worldToNDC"));
            EXPECT_NEAR(seen.x / seen.w, 2.0 * (x + 0.5) / 128.0 - 1.0, 2.0 * six_digits);
            EXPECT_NEAR(seen.y / seen.w, 1.0 - 2.0 * (y + 0.5) / 128.0, 2.0 * six_digits);
            EXPECT_GT(seen.w, 0.0);
        }
    }
    const double half = std::tan(glm::radians(45.0) / 2.0);
    EXPECT_NEAR(glm::length(ray_of(*view, -0.5, 63.5).direction - view->view_axis), half, six_digits);
}

TEST(HeaderCamera, Arnold7WorldToScreen) { // gaffer_arnoldCombinedID.exr
    const Window display{0, 0, 15, 15};
    ImageLayout layout = layout_with_window(display);
    layout.matrices["worldToCamera"] = stored({{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}, {0, 0, 2.18629, 1}}});
    layout.matrices["worldToScreen"] =
        stored({{{2.14451, 0, 0, 0}, {0, 2.14451, 0, 0}, {0, 0, -1, -1}, {0, 0, 2.17629, 2.18629}}});
    layout.numbers["CameraFov"] = 50.0;
    const auto view = view_from_header(layout, display);
    ASSERT_TRUE(view.has_value());
    ASSERT_TRUE(view->has_rays);
    expect_near(view->eye, {0, 0, 2.18629}, exact);
    expect_near(view->view_axis, {0, 0, -1}, exact);
    const double half = std::tan(glm::radians(25.0));
    expect_near(ray_of(*view, -0.5, -0.5).direction, {-half, half, -1.0}, six_digits);
}

TEST(HeaderCamera, ContradictingAttributesLeaveTheEyeOnly) {
    ImageLayout layout = arnold_5_layout();
    layout.numbers["CameraFov"] = 60.0;
    const auto view = view_from_header(layout, square);
    ASSERT_TRUE(view.has_value());
    EXPECT_FALSE(view->has_rays);
    expect_near(glm::dvec3(times(glm::dvec4(view->eye, 1.0), layout.matrices.at("worldToCamera"))), {0, 0, 0},
                six_digits);
    // A screen that is isotropic on a wide window does not tell which axis spans -1..1.
    ImageLayout wide = arnold_5_layout();
    wide.display_window = {0, 0, 255, 127};
    EXPECT_FALSE(view_from_header(wide, wide.display_window)->has_rays);
}

TEST(HeaderCamera, FieldOfViewAloneNeedsASquarePicture) {
    ImageLayout layout = arnold_5_layout();
    layout.matrices.erase("worldToNDC");
    const View with_matrix = *view_from_header(arnold_5_layout(), square);
    const View with_fov = *view_from_header(layout, square);
    ASSERT_TRUE(with_fov.has_rays);
    EXPECT_LT(testing::worst_angle(with_matrix, with_fov, square), 2.0 * six_digits);
    layout.display_window = {0, 0, 255, 127};
    EXPECT_FALSE(view_from_header(layout, layout.display_window)->has_rays);
}

TEST(HeaderCamera, UselessMatricesAreRefused) {
    ImageLayout layout = arnold_5_layout();
    layout.matrices["worldToCamera"] = glm::dmat4(0.0);
    EXPECT_THROW((void)view_from_header(layout, square), RuntimeFailure);
    layout.matrices["worldToCamera"] = glm::dmat4(1.0);
    layout.matrices["worldToCamera"][1][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)view_from_header(layout, square), RuntimeFailure);
    layout.matrices["worldToCamera"] = glm::dmat4(1.0);
    layout.matrices["worldToCamera"][0][2] = 0.5; // shear
    EXPECT_THROW((void)view_from_header(layout, square), RuntimeFailure);
    layout = arnold_5_layout();
    layout.matrices["worldToNDC"] = glm::dmat4(0.0);
    layout.numbers.clear();
    EXPECT_FALSE(view_from_header(layout, square)->has_rays);
}

TEST(Reprojection, IsZeroForTheCameraThatMadeThePositions) {
    const Window display{0, 0, 159, 119};
    for (const Lens lens : {Lens::fov_y, Lens::orthographic}) {
        const Camera camera = camera_at({4, -7, 3}, {0, 0, 1}, lens, lens == Lens::fov_y ? 0.7 : 5.0);
        const View view = view_from_camera(camera, display, display, 1.0);
        Frame frame = testing::make_frame(view, display, display, 1.0, testing::blocks);
        // Single precision: 24 bits of a position of about 10, in pixels of about 0.05 units.
        EXPECT_LT(reprojection_error(frame), 1e-4);
        EXPECT_GE(reprojection_error(frame), 0.0);
        Camera moved = camera;
        moved.matrix_world[3] += 0.5 * moved.matrix_world[0]; // half a unit to the right
        frame.view = view_from_camera(moved, display, display, 1.0);
        EXPECT_GT(reprojection_error(frame), 5.0);
        frame.view.has_rays = false;
        EXPECT_LT(reprojection_error(frame), 0.0);
    }
}

} // namespace
} // namespace clshade
