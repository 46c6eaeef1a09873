#include "host/cli/plan_text.h"

#include "host/cli/table.h"

#include <fmt/format.h>

namespace clshade::cli {

std::string roles_text(const PlannedInput& input) {
    Table table({{"role", Align::left}, {"channels", Align::left}, {"rule", Align::left}});
    for (const RoleChoice& choice : input.roles.choices) {
        if (choice.channels.empty()) {
            continue;
        }
        std::string channels;
        for (const int channel : choice.channels) {
            channels += (channels.empty() ? "" : " ") + input.layout.channels[static_cast<std::size_t>(channel)].name;
        }
        table.add_row({std::string(name_of(choice.role)), channels, choice.rule});
    }
    return table.text();
}

std::string plan_text(const PlannedInput& input, const FrameJob& job, const RunScene& scene,
                      const EnvironmentInput* environment, const DeviceInfo& device) {
    const Frame& frame = input.plan.frame;
    std::string text = fmt::format("would shade {} -> {}\n  {}x{} pixels, {} planes read of {} channels\n"
                                   "  camera: {}\n  scene: {}, {} lights\n  device: {}/{}\n",
                                   job.input.string(), job.output.string(), frame.data_window.width(),
                                   frame.data_window.height(), input.plan.channels.size(), input.layout.channels.size(),
                                   input.camera_source, scene.name, frame.lights.size(), device.platform, device.name);
    text += fmt::format("  environment: {}{}\n",
                        environment == nullptr ? "none"
                                               : fmt::format("{}, {}", environment->name, environment->description()),
                        scene.scene.background ? ", shown as background" : "");
    for (const BoundMaterial& material : frame.materials) {
        text += fmt::format("  material {}: {}\n", material.name, model_key(material));
    }
    return text + "\n" + roles_text(input);
}

} // namespace clshade::cli
