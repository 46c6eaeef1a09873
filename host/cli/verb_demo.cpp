#include "host/base/error.h"
#include "host/batch/frame_output.h"
#include "host/cli/chosen_scene.h"
#include "host/cli/log_level.h"
#include "host/cli/report_json.h"
#include "host/cli/shade_run.h"
#include "host/cli/signals.h"
#include "host/cli/verb.h"
#include "host/demo/demo_gbuffer.h"
#include "host/environment/lat_long.h"
#include "host/images/image_writer.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>

namespace clshade::cli {

namespace {

struct DemoOptions {
    CommonOptions common;
    std::string folder = "clshade-demo";
    std::string size = "1280x720";
    std::string frames = "3";
};

// The standard's worldToNDC: (0, 0) upper left to (1, 1) lower right of the display window, row vectors.
glm::dmat4 world_to_ndc(const glm::dmat4& to_camera, double fov_y, double aspect) {
    constexpr double near = 0.1;
    constexpr double far = 1000.0;
    const double half_height = std::tan(0.5 * fov_y);
    const double half_width = half_height * aspect;
    glm::dmat4 projection(0.0); // column vectors; the camera looks along +z
    projection[0][0] = 0.5 / half_width;
    projection[1][1] = -0.5 / half_height;
    projection[2] = {0.5, 0.5, far / (far - near), 1.0};
    projection[3][2] = -far * near / (far - near);
    return projection * to_camera;
}

// Geometry and ids lose too much in half.
bool needs_float(std::string_view plane) {
    return plane.starts_with("Position.") || plane.starts_with("Depth.") || plane.starts_with("Normal.") ||
           plane.starts_with("MaterialID.");
}

OutputImage gbuffer_image(const DemoFrame& frame) {
    OutputImage image;
    image.data_window = {0, 0, frame.planes.width() - 1, frame.planes.height() - 1};
    image.display_window = image.data_window;
    for (std::size_t i = 0; i < frame.plane_names.size(); ++i) {
        image.channels.push_back(
            {frame.plane_names[i], &frame.planes, static_cast<int>(i), needs_float(frame.plane_names[i])});
    }
    image.attributes = {{"software", fmt::format("clshade {} demo", CLSHADE_VERSION)}};
    const glm::dmat4& to_world = frame.camera.matrix_world;
    const glm::dmat4 to_camera = world_to_camera(glm::dmat3(to_world), glm::dvec3(to_world[3]));
    image.matrices["worldToCamera"] = to_camera;
    image.matrices["worldToNDC"] =
        world_to_ndc(to_camera, frame.camera.lens_value,
                     static_cast<double>(frame.planes.width()) / static_cast<double>(frame.planes.height()));
    return image;
}

// The picture that the scene's [environment] names. Its sky is the studio's: row 0 is overhead.
void write_studio(const std::filesystem::path& file) {
    const LatLong studio = built_in_studio();
    PlaneSlab planes(studio.width, studio.height, 3);
    OutputImage image;
    image.data_window = {0, 0, studio.width - 1, studio.height - 1};
    image.display_window = image.data_window;
    constexpr std::array<const char*, 3> names{"R", "G", "B"};
    std::size_t i = 0;
    for (int y = 0; y < studio.height; ++y) {
        for (int x = 0; x < studio.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                planes.at(c, x, y) = studio.rgb[i++];
            }
        }
    }
    for (int c = 0; c < 3; ++c) {
        image.channels.push_back({names.at(static_cast<std::size_t>(c)), &planes, c, true});
    }
    image.attributes = {{"software", fmt::format("clshade {} demo", CLSHADE_VERSION)}};
    write_exr(file, image, {});
}

std::vector<FrameJob> make_gbuffers(const std::filesystem::path& folder, const DemoOptions& options,
                                    Progress& progress) {
    const Size size = parse_size("--size", options.size);
    const int count = static_cast<int>(parse_whole("--frames", options.frames, 1, 1000));
    const int threads = options.common.host_threads();
    std::vector<FrameJob> jobs;
    for (int index = 1; index <= count; ++index) {
        const FrameJob job{index, folder / fmt::format("gbuffer.{:04d}.exr", index),
                           folder / fmt::format("shaded.{:04d}.exr", index),
                           folder / fmt::format("shaded.{:04d}.png", index)};
        progress.update("making " + job.input.filename().string());
        const DemoFrame frame = render_demo_frame(size.width, size.height, index, count, threads);
        write_exr(job.input, gbuffer_image(frame), {});
        progress.step();
        jobs.push_back(job);
    }
    return jobs;
}

ExitCode demo(const DemoOptions& options, JsonReport& report) {
    const std::filesystem::path folder = options.folder;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw RuntimeFailure(fmt::format("{}: cannot make the folder: {}", folder.string(), error.message()));
    }
    Session session(options.common);
    report.set_device(session.info()); // no device, no demo: before the G-buffers are made
    const int frames = static_cast<int>(parse_whole("--frames", options.frames, 1, 1000));
    Progress progress(options.common, 2 * frames, Steps::other);
    const std::vector<FrameJob> jobs = make_gbuffers(folder, options, progress);
    const std::filesystem::path scene_file = folder / "scene.toml";
    write_text_file(scene_file, demo_scene_toml());
    write_studio(folder / demo_environment);

    SceneOptions scene_options;
    scene_options.file = scene_file.string();
    const RunScene scene = choose_scene(scene_options);
    const BatchSettings settings = batch_settings(options.common);
    ShadeRun run(options.common, scene, settings, session, progress, report, {false, false, {}});
    const ExitCode code = run.run(jobs);
    if (!options.common.quiet && code == ExitCode::ok) {
        const std::string last = fmt::format("{:04d}", frames);
        fmt::print("{} frames of {} on {}/{}\n\n{}\n"
                   "G-buffers  {}/gbuffer.0001.exr to {}\nscene      {}, {}/{}\nshaded     {}/shaded.0001.exr to {}\n"
                   "previews   {}/shaded.0001.png to {}\n\n"
                   "Again, by hand:\n  clshade shade '{}/gbuffer.####.exr' -o '{}/again.####.exr' --scene {}\n",
                   frames, options.size, session.info().platform, session.info().name, run.stats().text(),
                   folder.string(), last, scene_file.string(), folder.string(), demo_environment, folder.string(), last,
                   folder.string(), last, folder.string(), folder.string(), scene_file.string());
    }
    return code;
}

} // namespace

Action declare_demo(CLI::App& app) {
    auto options = std::make_shared<DemoOptions>();
    app.add_option("DIR", options->folder, "where to put everything. Default: clshade-demo");
    app.add_option("--size", options->size, "width and height in pixels. Default: 1280x720")->type_name("WxH");
    app.add_option("--frames", options->frames, "number of frames. Default: 3")->type_name("N");
    add_common_options(app, options->common, CommonGroup::running);
    return [options] {
        set_log_level(options->common);
        return with_report(options->common, "demo", [&](JsonReport& report) { return demo(*options, report); });
    };
}

} // namespace clshade::cli
