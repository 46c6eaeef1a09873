#include "host/batch/frame_input.h"

#include "host/images/image_reader.h"
#include "host/scene/frame_camera.h"

#include <algorithm>
#include <utility>

namespace clshade {

namespace {

void append_unique(std::vector<std::string>& all, const std::vector<std::string>& more) {
    for (const std::string& text : more) {
        if (std::find(all.begin(), all.end(), text) == all.end()) {
            all.push_back(text);
        }
    }
}

std::string camera_source(const FramePlan& plan, const Scene& scene, std::optional<int> number) {
    std::string place = camera_place(scene, number);
    if (!place.empty()) {
        return place;
    }
    return plan.recover_camera ? "recovered from the position plane" : "worldToCamera in the header";
}

/// Copies the scene only where frames differ.
FramePlan plan_with_camera(const PlannedInput& input, const Scene& scene, const std::vector<std::string>& keep,
                           std::optional<int> number) {
    if (!has_frame_cameras(scene)) {
        return plan_frame(input.layout, input.roles, scene, keep);
    }
    Scene of_frame = scene;
    of_frame.camera = camera_of_frame(scene, number);
    return plan_frame(input.layout, input.roles, of_frame, keep);
}

} // namespace

PlannedInput plan_input(const std::filesystem::path& file, const Scene& scene, const std::string& view,
                        const std::vector<std::string>& keep, std::optional<int> frame) {
    PlannedInput input;
    input.file = file;
    input.layout = read_layout(file);
    input.roles = assign_roles(input.layout, scene.gbuffer, view);
    input.plan = plan_with_camera(input, scene, keep, frame);
    input.camera_source = camera_source(input.plan, scene, frame);
    return input;
}

LoadedFrame describe(const PlannedInput& input) {
    LoadedFrame loaded;
    loaded.layout = input.layout;
    loaded.camera_source = input.camera_source;
    for (const int plane : input.plan.keep) {
        const ChannelInfo& channel =
            input.layout.channels[static_cast<std::size_t>(input.plan.channels[static_cast<std::size_t>(plane)])];
        loaded.kept.push_back({plane, channel.name, channel.type == SampleType::half});
    }
    append_unique(loaded.warnings, input.layout.warnings);
    append_unique(loaded.warnings, input.roles.warnings);
    return loaded;
}

void accept(LoadedFrame& loaded, Frame frame) {
    append_unique(loaded.warnings, frame.warnings);
    loaded.frame = std::move(frame);
}

LoadedFrame load_frame(PlannedInput input, PlaneSlab planes) {
    Frame& frame = input.plan.frame;
    const Window& window = frame.data_window;
    const auto count = static_cast<int>(input.plan.channels.size());
    const bool fits = planes.width() == window.width() && planes.height() == window.height() && planes.count() == count;
    frame.planes = fits ? std::move(planes) : PlaneSlab(window.width(), window.height(), count);

    LoadedFrame loaded = describe(input);
    PlaneReader reader(input.file, input.layout, input.plan.channels, window);
    reader.read(0, frame.planes);
    loaded.bytes_read = reader.bytes_read();
    loaded.busy_milliseconds = reader.busy_milliseconds();
    accept(loaded, finish_frame(std::move(input.plan)));
    return loaded;
}

} // namespace clshade
