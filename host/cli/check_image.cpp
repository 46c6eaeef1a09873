#include "host/cli/check_image.h"

#include "host/base/error.h"
#include "host/batch/frame_input.h"
#include "host/batch/frame_output.h"
#include "host/cli/chosen_scene.h"
#include "host/gbuffer/environment_binding.h"
#include "host/images/image_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace clshade::cli {

namespace {

constexpr int colours = 3;
constexpr std::array<const char*, colours> colour_names{"R", "G", "B"};
constexpr std::array<const char*, 3> kinds{"device", "reference", "error"};

// The planes in the upper left corner of larger ones, zero beyond.
PlaneSlab in_corner(const PlaneSlab& planes, int width, int height) {
    PlaneSlab larger(width, height, planes.count());
    for (int p = 0; p < planes.count(); ++p) {
        for (int y = 0; y < planes.height(); ++y) {
            const auto row = planes.row(p, y);
            std::copy(row.begin(), row.end(), larger.row(p, y).begin());
        }
    }
    return larger;
}

} // namespace

CheckInput read_check_input(const std::filesystem::path& file, const SceneOptions& scene, std::uint64_t max_memory) {
    const RunScene chosen = choose_scene(scene);
    PlannedInput planned = plan_input(file, chosen.scene, scene.view);
    CheckInput input;
    if (chosen.scene.environment) { // before the pixels, which may be many
        input.environment = read_environment(chosen.scene, max_memory);
        input.warnings = input.environment->warnings;
    }
    LoadedFrame loaded = load_frame(std::move(planned));
    if (input.environment) {
        attach_environment(loaded.frame, chosen.scene, input.environment->image, input.environment->maps);
    }
    input.frame = std::move(loaded.frame);
    std::move(loaded.warnings.begin(), loaded.warnings.end(), std::back_inserter(input.warnings));
    return input;
}

void check_dump_path(const std::filesystem::path& file, const std::filesystem::path& input) {
    refuse_same_file(file, input);
    if (file.extension() != ".exr") {
        throw UsageError(fmt::format("{}: --dump writes .exr files only", file.string()));
    }
    check_output_path(file);
}

void ErrorDump::add(const std::string& layer, const Frame& frame, const ShadedImage& shaded,
                    const reference::Image& expected) {
    if (entries_.empty() || expected.width * expected.height > data_window_.width() * data_window_.height()) {
        data_window_ = frame.data_window;
        display_window_ = frame.display_window;
        pixel_aspect_ = frame.pixel_aspect;
    }
    PlaneSlab planes(expected.width, expected.height, colours * static_cast<int>(kinds.size()));
    for (int c = 0; c < colours; ++c) {
        const std::vector<double>& reference = expected.planes[static_cast<std::size_t>(c)];
        for (int y = 0; y < expected.height; ++y) {
            for (int x = 0; x < expected.width; ++x) {
                const double value = reference[static_cast<std::size_t>(y) * static_cast<std::size_t>(expected.width) +
                                               static_cast<std::size_t>(x)];
                const float device = shaded.planes.at(c, x, y);
                planes.at(c, x, y) = device;
                planes.at(colours + c, x, y) = static_cast<float>(value);
                planes.at(2 * colours + c, x, y) = static_cast<float>(static_cast<double>(device) - value);
            }
        }
    }
    entries_.push_back({layer.empty() ? layer : layer + ".", std::move(planes)});
}

void ErrorDump::write(const std::filesystem::path& file) const {
    OutputImage image;
    image.data_window = data_window_;
    image.display_window = display_window_;
    image.pixel_aspect = pixel_aspect_;
    std::vector<PlaneSlab> padded; // of the smaller frames
    padded.reserve(entries_.size());
    for (const Entry& entry : entries_) {
        const bool whole =
            entry.planes.width() == data_window_.width() && entry.planes.height() == data_window_.height();
        if (!whole) {
            padded.push_back(in_corner(entry.planes, data_window_.width(), data_window_.height()));
        }
        const PlaneSlab& planes = whole ? entry.planes : padded.back();
        int plane = 0;
        for (const char* kind : kinds) {
            for (const char* colour : colour_names) {
                image.channels.push_back({fmt::format("{}{}.{}", entry.layer, kind, colour), &planes, plane, true});
                ++plane;
            }
        }
    }
    image.attributes = {{"software", fmt::format("clshade {} check", CLSHADE_VERSION)}};
    ExrSettings settings;
    settings.half = false;
    write_exr(file, image, settings);
}

} // namespace clshade::cli
