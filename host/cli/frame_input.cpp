#include "host/cli/frame_input.h"

#include "host/base/hash.h"
#include "host/cli/environment_input.h"
#include "host/cli/table.h"
#include "host/images/image_reader.h"
#include "host/scene/metal_table.h"
#include "host/scene/scene_file.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

namespace clshade::cli {

namespace {

std::string text_of(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

void append_unique(std::vector<std::string>& all, const std::vector<std::string>& more) {
    for (const std::string& text : more) {
        if (std::find(all.begin(), all.end(), text) == all.end()) {
            all.push_back(text);
        }
    }
}

// Files that metals were read from; relative names start at the scene's folder.
std::vector<std::filesystem::path> metal_files(const Scene& scene) {
    std::vector<std::filesystem::path> files;
    for (const Material& material : scene.materials) {
        for (const Layer& layer : material.layers) {
            const std::string& name = layer.specular.metal.name;
            if (layer.specular.model == SpecularModel::blinn_phong_spectral && !built_in_metal(name)) {
                files.push_back(std::filesystem::path(scene.file).parent_path() / name);
            }
        }
    }
    return files;
}

} // namespace

ChosenScene choose_scene(const SceneOptions& options) {
    ChosenScene chosen;
    chosen.file = options.file;
    chosen.scene = options.file.empty() ? default_scene(options.overrides, options.model)
                                        : read_scene(options.file, options.overrides, options.model);
    chosen.name = options.file.empty() ? "default" : std::filesystem::path(options.file).filename().string();
    std::string identity = options.file.empty() ? "default" : text_of(options.file);
    for (const std::string& assignment : options.overrides) {
        identity += "\n--set " + assignment;
    }
    chosen.tables = metal_files(chosen.scene);
    for (const std::filesystem::path& table : chosen.tables) {
        identity += '\n';
        identity += text_of(table.string());
    }
    chosen.environment = environment_files(chosen.scene);
    chosen.hash = hash_hex(identity + "\n--model " + options.model);
    return chosen;
}

PlannedInput plan_input(const std::filesystem::path& file, const Scene& scene, const std::string& view,
                        const std::vector<std::string>& keep) {
    PlannedInput input;
    input.file = file;
    input.layout = read_layout(file);
    input.roles = assign_roles(input.layout, scene.gbuffer, view);
    input.plan = plan_frame(input.layout, input.roles, scene, keep);
    return input;
}

LoadedFrame load_frame(PlannedInput input, const Scene& scene, int threads) {
    LoadedFrame loaded;
    loaded.camera_source = camera_source(input, scene);
    read_planes(input.file, input.layout, input.plan, threads);
    for (const int plane : input.plan.keep) {
        const ChannelInfo& channel =
            input.layout.channels[static_cast<std::size_t>(input.plan.channels[static_cast<std::size_t>(plane)])];
        loaded.kept.push_back({plane, channel.name, channel.type == SampleType::half});
    }
    loaded.frame = finish_frame(std::move(input.plan));
    append_unique(loaded.warnings, input.layout.warnings);
    append_unique(loaded.warnings, input.roles.warnings);
    append_unique(loaded.warnings, loaded.frame.warnings);
    for (const std::string& note : loaded.frame.notes) {
        spdlog::info("{}: {}", input.file.string(), note);
    }
    loaded.layout = std::move(input.layout);
    return loaded;
}

std::string camera_source(const PlannedInput& input, const Scene& scene) {
    if (scene.camera) {
        return scene.file.empty() ? "--set camera" : "[camera] of " + scene.file;
    }
    return input.plan.recover_camera ? "recovered from the position plane" : "worldToCamera in the header";
}

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

} // namespace clshade::cli
