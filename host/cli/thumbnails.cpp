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

using Colour = std::array<float, colours>;

// What a screen can show of a sample: half clipped channel by channel, which bleaches highlights as film does, half
// scaled down as a whole, which keeps the colour of a metal.
Colour on_screen(const ShadedImage& image, int x, int y) {
    Colour colour{};
    for (int c = 0; c < colours; ++c) {
        colour.at(static_cast<std::size_t>(c)) = image.planes.at(c, x, y);
    }
    const float scale = 1.0F / std::max(1.0F, *std::max_element(colour.begin(), colour.end()));
    for (float& value : colour) {
        value = 0.5F * (std::min(value, 1.0F) + scale * value);
    }
    return colour;
}

// Means over squares of samples as the screen shows them, so that edges of highlights are smooth.
PlaneSlab filtered(const ShadedImage& image, int size) {
    constexpr float weight = 1.0F / static_cast<float>(sample_side * sample_side);
    PlaneSlab result(size, size, colours);
    for (int y = 0; y < size * sample_side; ++y) {
        for (int x = 0; x < size * sample_side; ++x) {
            const Colour colour = on_screen(image, x, y);
            for (int c = 0; c < colours; ++c) {
                result.at(c, x / sample_side, y / sample_side) += weight * colour.at(static_cast<std::size_t>(c));
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
