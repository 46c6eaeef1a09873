#include "host/cli/chosen_scene.h"

#include "host/base/hash.h"
#include "host/cli/environment_input.h"
#include "host/scene/metal_table.h"
#include "host/scene/scene_file.h"

#include <fstream>
#include <sstream>

namespace clshade::cli {

namespace {

std::string text_of(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
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

RunScene choose_scene(const SceneOptions& options) {
    RunScene chosen;
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

} // namespace clshade::cli
