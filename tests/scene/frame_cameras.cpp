// Cameras by frame: [camera.frames.N] and side files.
#include "host/scene/frame_camera.h"
#include "tests/device/temporary_folder.h"
#include "tests/scene/support.h"

#include <glm/gtc/constants.hpp>

#include <fstream>
#include <functional>

namespace clshade {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using tests::TemporaryFolder;

const std::string at_origin = "matrix_world = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]\n";
const std::string at_five = "matrix_world = [[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]\n";
const std::string json_at_seven = R"("matrix_world": [[1,0,0,7],[0,1,0,0],[0,0,1,0],[0,0,0,1]])";

double degrees(double value) {
    return value * glm::pi<double>() / 180.0;
}

void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
}

/// x of the camera's place.
double place(const Scene& scene, int frame) {
    return camera_of_frame(scene, frame).value().matrix_world[3].x;
}

/// The message of the error of this type, "another error" or "no error".
template <typename Wanted>
std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Wanted& error) {
        return error.what();
    } catch (const std::exception& error) {
        return std::string("another error: ") + error.what();
    }
    return "no error";
}

TEST(FrameCameras, ScenesWithoutThemAreAsBefore) {
    const Scene one = parse(head + "[camera]\n" + at_five);
    EXPECT_FALSE(has_frame_cameras(one));
    EXPECT_EQ(place(one, 3), 5.0);
    EXPECT_EQ(camera_of_frame(one, std::nullopt)->matrix_world[3].x, 5.0);
    EXPECT_EQ(camera_place(one, 3), "[camera] of scene.toml");
    const Scene none = parse(head);
    EXPECT_FALSE(camera_of_frame(none, 3).has_value());
    EXPECT_FALSE(camera_of_frame(none, std::nullopt).has_value());
    EXPECT_EQ(camera_place(none, 3), "");
    EXPECT_EQ(camera_file_of_frame(none, 3), "");
}

TEST(FrameCameras, ListedFramesTakeTheRestFromTheCamera) {
    const Scene scene =
        parse(head + "[camera]\nfov_y_degrees = 40\n[camera.frames.101]\n" + at_five + "[camera.frames.0102]\n" +
              at_origin + "orthographic_height = 2\n[camera.frames.-3]\n" + at_origin + "fov_y_degrees = 50\n");
    EXPECT_TRUE(has_frame_cameras(scene));
    EXPECT_FALSE(scene.camera.has_value()) << "nothing that every frame could take";
    const Camera first = camera_of_frame(scene, 101).value();
    EXPECT_EQ(first.matrix_world[3].x, 5.0);
    EXPECT_EQ(first.lens, Lens::fov_y);
    EXPECT_DOUBLE_EQ(first.lens_value, degrees(40.0));
    const Camera second = camera_of_frame(scene, 102).value();
    EXPECT_EQ(second.lens, Lens::orthographic) << "in place of the field of view";
    EXPECT_EQ(second.lens_value, 2.0);
    EXPECT_DOUBLE_EQ(camera_of_frame(scene, -3)->lens_value, degrees(50.0));
    EXPECT_EQ(camera_place(scene, 101), "[camera.frames.101] of scene.toml");
    EXPECT_EQ(camera_file_of_frame(scene, 101), "");
    EXPECT_THAT(message_of<UsageError>([&] { (void)camera_of_frame(scene, 103); }),
                AllOf(StartsWith("scene.toml: "), HasSubstr("no camera for frame 103"), HasSubstr("-3, 101, 102"),
                      HasSubstr("write [camera.frames.103]")));
}

TEST(FrameCameras, OtherFramesTakeACompleteCamera) {
    const Scene scene = parse(head + "[camera]\n" + at_origin + "fov_x_degrees = 60\n[camera.frames.2]\n" + at_five +
                              "[camera.frames.3]\nfov_x_degrees = 70\n");
    EXPECT_EQ(place(scene, 1), 0.0);
    EXPECT_EQ(place(scene, 2), 5.0);
    EXPECT_EQ(place(scene, 3), 0.0);
    EXPECT_DOUBLE_EQ(camera_of_frame(scene, 2)->lens_value, degrees(60.0));
    EXPECT_DOUBLE_EQ(camera_of_frame(scene, 3)->lens_value, degrees(70.0));
    EXPECT_EQ(scene.camera->matrix_world[3].x, 0.0);
    EXPECT_EQ(camera_place(scene, 1), "[camera] of scene.toml");
}

TEST(FrameCameras, ARunWithoutFrameNumbersIsRefused) {
    const std::string text = head + "[camera]\n" + at_origin + "[camera.frames.2]\n" + at_five;
    EXPECT_THAT(message_of<UsageError>([&] { (void)camera_of_frame(parse(text), std::nullopt); }),
                AllOf(StartsWith("scene.toml: "), HasSubstr("no frame number"), HasSubstr("--frames N")));
}

TEST(FrameCameras, AreReachedBySet) {
    const Scene scene =
        parse(head + "[camera]\n" + at_origin + "[camera.frames.2]\n" + at_five,
              {"camera.frames.2.fov_y_degrees=30", "camera.frames.7.fov_y_degrees=35", "camera.file=c.####.json"});
    EXPECT_DOUBLE_EQ(camera_of_frame(scene, 2)->lens_value, degrees(30.0));
    EXPECT_EQ(place(scene, 2), 5.0);
    EXPECT_DOUBLE_EQ(camera_of_frame(scene, 7)->lens_value, degrees(35.0));
    EXPECT_EQ(camera_file_of_frame(scene, 12), "c.0012.json");
    const Scene bare = default_scene(std::vector<std::string>{"camera.file=c.%d.toml"}, {});
    EXPECT_EQ(camera_file_of_frame(bare, 12), "c.12.toml");
}

class BadFrameCameras : public testing::TestWithParam<Mistake> {};

TEST_P(BadFrameCameras, AreNamedWithTheirPlace) {
    expect_mistake(error_of(head + GetParam().text), GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Everywhere, BadFrameCameras,
    testing::Values(
        Mistake{"unknown_key", "[camera]\nfile = 'c.#.json'\nfov = 3\n", "6:1", "unknown key 'fov' in [camera]"},
        Mistake{"unknown_key_of_frame", "[camera.frames.7]\nfov_y = 3\n", "5:1",
                "unknown key 'fov_y' in [camera.frames.7]; known keys are"},
        Mistake{"no_number", "[camera.frames.first]\nfov_y_degrees = 3\n", "4:16", "'first' in [camera.frames] is not"},
        Mistake{"too_large", "[camera.frames.99999999999]\nfov_y_degrees = 3\n", "4:16", "is not a frame number"},
        Mistake{"twice", "[camera]\n" + at_origin + "[camera.frames.7]\n[camera.frames.007]\n", "7:16",
                "frame 7 stands in [camera.frames] twice"},
        Mistake{"no_matrix", "[camera.frames.7]\nfov_y_degrees = 3\n", "4:16",
                "[camera.frames.7] lacks 'matrix_world', and so does [camera]"},
        Mistake{"no_frames", "[camera]\n" + at_origin + "frames = {}\n", "6:1", "holds no table"},
        Mistake{"list", "[camera]\n" + at_origin + "frames = [3]\n", "6:1", "holds no table"},
        Mistake{"not_a_table", "[camera]\n" + at_origin + "frames = { 7 = 3 }\n", "6:16", "write a table"},
        Mistake{"two_lenses", "[camera.frames.7]\n" + at_origin + "fov_x_degrees = 3\nfov_y_degrees = 3\n", "7:1",
                "[camera.frames.7] has more than one of"},
        Mistake{"no_place", "[camera]\nfile = 'camera.json'\n", "5:8", "without a place for the frame number"},
        Mistake{"two_places", "[camera]\nfile = '#/camera.#.json'\n", "5:8", "two places for the frame number"},
        Mistake{"kind", "[camera]\nfile = 'camera.#.abc'\n", "5:8", "name .json or .toml files"},
        Mistake{"no_text", "[camera]\nfile = 3\n", "5:8", "write a string"}),
    name_of_mistake);

/// A scene in a folder of its own, whose frames have side files.
class SideFiles : public testing::Test {
  protected:
    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }

    /// The scene with this [camera].
    [[nodiscard]] Scene scene(const std::string& camera) const {
        return parse_scene(head + "[camera]\n" + camera, file("scene.toml").string(), {}, {});
    }

    /// The error for frame 7, whose side file is this text.
    [[nodiscard]] std::string error_for(const std::string& extension, const std::string& text) const {
        write(file("c.7." + extension), text);
        const Scene read = scene("file = 'c.%d." + extension + "'\n");
        std::string message = message_of<RuntimeFailure>([&] { (void)camera_of_frame(read, 7); });
        EXPECT_THAT(message, AllOf(StartsWith(file("c.7." + extension).string() + ":"), HasSubstr("frame 7"),
                                   HasSubstr("; "), testing::Not(HasSubstr("\n"))));
        return message;
    }

  private:
    TemporaryFolder folder_;
};

TEST_F(SideFiles, AreFoundBesideTheScene) {
    write(file("camera.0007.toml"), at_five);
    write(file("camera.-008.toml"), "[camera]\n" + at_five + "orthographic_height = 3\n");
    const Scene read = scene("file = 'camera.####.toml'\nfov_y_degrees = 40\n[camera.frames.9]\n" + at_origin);
    EXPECT_EQ(camera_file_of_frame(read, 7), file("camera.0007.toml"));
    EXPECT_EQ(camera_place(read, 7), file("camera.0007.toml").string());
    const Camera seventh = camera_of_frame(read, 7).value();
    EXPECT_EQ(seventh.matrix_world[3].x, 5.0);
    EXPECT_EQ(seventh.lens, Lens::fov_y) << "from [camera]";
    EXPECT_DOUBLE_EQ(seventh.lens_value, degrees(40.0));
    EXPECT_EQ(camera_of_frame(read, -8)->lens, Lens::orthographic);
    EXPECT_EQ(place(read, 9), 0.0) << "what is listed wins";
    EXPECT_EQ(camera_file_of_frame(read, 9), "");
    EXPECT_EQ(camera_file_of_frame(read, std::nullopt), "");
    // A folder that looks like a pattern is none.
    std::filesystem::create_directory(file("shot#12"));
    write(file("shot#12/c.7.toml"), at_five);
    const Scene inside =
        parse_scene(head + "[camera]\nfile = 'c.%d.toml'\n", file("shot#12/scene.toml").string(), {}, {});
    EXPECT_EQ(place(inside, 7), 5.0);
    const Scene absolute = scene("file = '" + file("camera.####.toml").string() + "'\n");
    EXPECT_EQ(place(absolute, 7), 5.0);
}

TEST_F(SideFiles, AMissingOneIsAnErrorEvenWithACompleteCamera) {
    const Scene read = scene(at_origin + "file = 'c.%04d.json'\n");
    const std::string message = message_of<RuntimeFailure>([&] { (void)camera_of_frame(read, 7); });
    EXPECT_THAT(message, AllOf(StartsWith(file("c.0007.json").string() + ": cannot open"), HasSubstr("frame 7"),
                               HasSubstr("'file' in [camera]")));
    std::filesystem::create_directory(file("c.0007.json"));
    EXPECT_THAT(message_of<RuntimeFailure>([&] { (void)camera_of_frame(read, 7); }), HasSubstr("is a folder"));
}

TEST_F(SideFiles, JsonHoldsOurKeysAtTopLevel) {
    write(file("c.1.json"), "{" + json_at_seven + R"(, "fov_x_degrees": 30})");
    write(file("c.2.json"), "{" + json_at_seven + R"(, "orthographic_height": 2})");
    write(file("c.3.json"), "{" + json_at_seven + R"(, "fov_y_deg": 25.5})");
    const Scene read = scene("file = 'c.%d.json'\n");
    EXPECT_EQ(place(read, 1), 7.0);
    EXPECT_EQ(camera_of_frame(read, 1)->lens, Lens::fov_x);
    EXPECT_DOUBLE_EQ(camera_of_frame(read, 1)->lens_value, degrees(30.0));
    EXPECT_EQ(camera_of_frame(read, 2)->lens, Lens::orthographic);
    EXPECT_DOUBLE_EQ(camera_of_frame(read, 3)->lens_value, degrees(25.5));
}

TEST_F(SideFiles, ExportersMayWriteMore) {
    const std::string more = R"("frame": 1, "lights": [{"name": "Key"}], "camera": {"name": "Cam", "lens_mm": 32.0, )"
                             R"("view_matrix": [[1]], "note": null, "fov_x_rad": 1.0, )" +
                             json_at_seven;
    write(file("c.1.json"), "{" + more + R"(, "fov_x_deg": 58.7, "fov_y_deg": 35.1, "type": "PERSP"}})");
    write(file("c.2.json"), "{" + more + R"(, "fov_x_deg": 58.7, "fov_y_deg": null}})");
    write(file("c.3.json"), "{" + more + R"(, "fov_y_deg": 35, "orthographic_height": 4, "type": "ORTHO"}})");
    write(file("c.4.json"), "{" + more + R"(, "fov_y_deg": 35, "orthographic_height": 4, "type": "Perspective"}})");
    const Scene read = scene("file = 'c.%d.json'\n");
    EXPECT_EQ(place(read, 1), 7.0);
    EXPECT_EQ(camera_of_frame(read, 1)->lens, Lens::fov_y);
    EXPECT_DOUBLE_EQ(camera_of_frame(read, 1)->lens_value, degrees(35.1));
    EXPECT_EQ(camera_of_frame(read, 2)->lens, Lens::fov_x);
    EXPECT_EQ(camera_of_frame(read, 3)->lens, Lens::orthographic);
    EXPECT_EQ(camera_of_frame(read, 3)->lens_value, 4.0);
    EXPECT_EQ(camera_of_frame(read, 4)->lens, Lens::fov_y);
}

TEST_F(SideFiles, MistakesInTomlAreNamedWithTheirPlace) {
    EXPECT_THAT(error_for("toml", at_five + "fov_y = 3\n"),
                AllOf(HasSubstr(".toml:2:1: unknown key 'fov_y' in the side file"), HasSubstr("'fov_y_degrees'")));
    EXPECT_THAT(error_for("toml", "[camera]\n" + at_five + "fov_y = 3\n"),
                HasSubstr(".toml:3:1: unknown key 'fov_y' in [camera]"));
    EXPECT_THAT(error_for("toml", "fov_y_degrees = 3\n[camera]\n" + at_five), HasSubstr(".toml:1:1: unknown key"));
    EXPECT_THAT(error_for("toml", "fov_y_degrees = 3\n"), HasSubstr("lacks 'matrix_world', and so does [camera]"));
    EXPECT_THAT(error_for("toml", at_five + "fov_y_degrees = 180\n"), HasSubstr(".toml:2:17: "));
    EXPECT_THAT(error_for("toml", "matrix_world = [\n"), HasSubstr("correct the TOML syntax"));
    EXPECT_THAT(error_for("toml", at_five + "fov_x_degrees = 3\nfov_y_degrees = 3\n"), HasSubstr("keep one"));
    EXPECT_THAT(error_for("toml", ""), HasSubstr("lacks 'matrix_world'"));
}

TEST_F(SideFiles, MistakesInJsonAreNamed) {
    EXPECT_THAT(error_for("json", "{\n" + json_at_seven + ",\n  oops}"),
                AllOf(HasSubstr("line 3, column 3"), HasSubstr("correct the JSON syntax")));
    EXPECT_THAT(error_for("json", ""), HasSubstr("correct the JSON syntax"));
    EXPECT_THAT(error_for("json", "[1]"), HasSubstr("array, not an object"));
    EXPECT_THAT(error_for("json", R"({"camera": 3})"), HasSubstr("\"camera\" is number"));
    EXPECT_THAT(error_for("json", "{" + json_at_seven + R"(, "fov_y": 3})"), HasSubstr("'fov_y_degrees'"));
    EXPECT_THAT(error_for("json", "{" + json_at_seven + R"(, "fov_x_deg": 3, "fov_y_deg": 3})"), HasSubstr("keep one"));
    EXPECT_THAT(error_for("json", "{" + json_at_seven + R"(, "fov_y_degrees": 3, "fov_y_deg": 3})"),
                HasSubstr("the same key"));
    EXPECT_THAT(error_for("json", R"({"fov_y_degrees": 3})"), HasSubstr("lacks 'matrix_world'"));
    EXPECT_THAT(error_for("json", R"({"matrix_world": [[1,0],[0,1]]})"), HasSubstr("has 2 rows"));
    EXPECT_THAT(error_for("json", R"({"matrix_world": [[1,0,0,0],[0,1,0,0],[0,0,1,[[[0]]]],[0,0,0,1]]})"),
                HasSubstr("four rows of four numbers"));
    EXPECT_THAT(error_for("json", "{" + json_at_seven + R"(, "fov_y_degrees": null})"), HasSubstr("holds null"));
    EXPECT_THAT(error_for("json", "{" + json_at_seven + R"(, "fov_y_degrees": 1e999})"), HasSubstr("number overflow"));
    EXPECT_THAT(error_for("json", "{" + json_at_seven + R"(, "fov_y_degrees": "35"})"), HasSubstr("write a number"));
    EXPECT_THAT(error_for("json", R"({"camera": {)" + json_at_seven + R"(, "fov_y_deg": 35, "type": "ORTHO"}})"),
                HasSubstr("write it, in scene units"));
    EXPECT_THAT(error_for("json", R"({"camera": {)" + json_at_seven + R"(, "fov_y_deg": 35, "type": "PANO"}})"),
                HasSubstr("panorama"));
    EXPECT_THAT(
        error_for("json", R"({"camera": {)" + json_at_seven + R"(, "fov_y_deg": 35, "orthographic_height": 2}})"),
        HasSubstr("keep one"));
    EXPECT_THAT(error_for("json", R"({"matrix_world": )" + std::string(200000, '[') + std::string(200000, ']') + "}"),
                HasSubstr("four rows of four numbers"));
    EXPECT_THAT(error_for("json", std::string(5U << 20U, ' ')), HasSubstr("larger than 4 MiB"));
}

TEST_F(SideFiles, BlendersExportIsRead) {
    const std::filesystem::path shared = CLSHADE_SHARED_DATA "/blender";
    if (!std::filesystem::exists(shared / "anim.0001.json")) {
        GTEST_SKIP() << "no anim.0001.json beside the repository";
    }
    const Scene read = scene("file = '" + (shared / "anim.%04d.json").string() + "'\n");
    const Camera camera = camera_of_frame(read, 1).value();
    EXPECT_NEAR(camera.matrix_world[3].y, -9.5, 1e-6);
    EXPECT_EQ(camera.lens, Lens::fov_y);
    EXPECT_NEAR(camera.lens_value, degrees(35.115395930396), 1e-9);
    EXPECT_NE(camera_of_frame(read, 2)->matrix_world, camera.matrix_world);
}

} // namespace
} // namespace clshade
