#include "host/cli/thumbnails.h"

#include "host/base/error.h"
#include "host/cli/memory_frame.h"
#include "host/demo/preset_stage.h"
#include "host/images/image_writer.h"
#include "host/scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace clshade::cli {

namespace {

/// Samples along each side of a pixel.
constexpr int sample_side = 3;
constexpr int colours = 3;

// Means over squares of samples. Values beyond white are clamped before, as a screen would: edges of highlights are
// smooth then.
PlaneSlab filtered(const ShadedImage& image, int size) {
    PlaneSlab result(size, size, colours);
    for (int c = 0; c < colours; ++c) {
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                float sum = 0.0F;
                for (int j = 0; j < sample_side; ++j) {
                    for (int i = 0; i < sample_side; ++i) {
                        sum += std::min(image.planes.at(c, x * sample_side + i, y * sample_side + j), 1.0F);
                    }
                }
                result.at(c, x, y) = sum / static_cast<float>(sample_side * sample_side);
            }
        }
    }
    return result;
}

void write_thumbnail(const std::filesystem::path& file, const PlaneSlab& planes) {
    OutputImage image;
    image.data_window = {0, 0, planes.width() - 1, planes.height() - 1};
    image.display_window = image.data_window;
    constexpr std::array<const char*, colours> names{"R", "G", "B"};
    for (int c = 0; c < colours; ++c) {
        image.channels.push_back({names[static_cast<std::size_t>(c)], &planes, c, false});
    }
    write_png(file, image);
}

} // namespace

void write_thumbnails(const std::filesystem::path& folder, std::span<const PresetInfo> presets, Session& session,
                      int threads, const std::function<void(const std::filesystem::path&)>& told) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw RuntimeFailure(fmt::format("{}: cannot make the folder: {}", folder.string(), error.message()));
    }
    Shader& shader = session.shader({});
    const DemoFrame stage = render_preset_stage(thumbnail_size * sample_side, threads);
    for (const PresetInfo& preset : presets) {
        const std::filesystem::path file = thumbnail_file(folder, preset);
        told(file);
        Scene scene = parse_scene(preset_stage_materials(preset.name), "preset stage", {}, {});
        scene.camera = stage.camera;
        scene.lights = preset_stage_lights();
        Frame frame = frame_from_planes(stage.planes, stage.plane_names, scene, "preset stage");
        write_thumbnail(file, filtered(shader.shade(frame), thumbnail_size));
    }
}

} // namespace clshade::cli
