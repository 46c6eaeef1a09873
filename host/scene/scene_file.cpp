#include "host/scene/scene_file.h"

#include "host/scene/scene_camera.h"
#include "host/scene/scene_environment.h"
#include "host/scene/scene_lights.h"
#include "host/scene/scene_materials.h"
#include "host/scene/scene_overrides.h"
#include "host/scene/scene_presets.h"
#include "host/scene/text_file.h"
#include "host/scene/toml_reader.h"
#include "host/scene/toml_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 8> scene_keys{"version",     "units",  "camera", "gbuffer",
                                                     "environment", "output", "light",  "material"};

/// MiB. Far beyond any scene written by hand or by a script; keeps --scene /dev/zero from eating the memory.
constexpr std::size_t largest_file = 16;

/// Key over the left shoulder, slightly warm; its direction is in camera space.
constexpr std::string_view key_text = R"(version = 1
[[light]]
name = "key"
type = "distant"
direction = [0.45, -0.55, -0.70]
irradiance = 1.5
color = [1.0, 0.96, 0.90]
)";

/// Levels: towards the key the studio's irradiance is some 2.6 times that of its mean radiance of 0.5, since its
/// largest soft box stands there. At half strength it gives a grey (0.5) surface that faces the key about 0.3, the key
/// 0.23.
constexpr std::string_view studio_text = R"([environment]
intensity = 0.5
)";

void check_version(const TomlTable& root, const std::string& file) {
    const TomlEntry* version = root.find("version");
    if (version == nullptr) {
        fail({file, 1, 1}, "the scene lacks 'version'; write version = 1 in its first line");
    }
    const auto* number = std::get_if<std::int64_t>(&version->value.data);
    if (number == nullptr) {
        fail_type(version->value, "version", "the whole number 1");
    }
    if (*number != 1) {
        fail(version->value.where,
             fmt::format("scene version {} is unknown to this clshade; write version = 1", *number));
    }
}

/// Whether [gbuffer] names an emission layer.
bool maps_emission(const GBufferSettings& settings) {
    return std::any_of(settings.roles.begin(), settings.roles.end(), [](const RoleOverride& role) {
        return role.role == "emission" && role.channels != std::vector<std::string>{"none"};
    });
}

bool has_default_material(const TomlTable& root) {
    const TomlEntry* material = root.find("material");
    const TomlTable* table = material == nullptr ? nullptr : material->value.table();
    return table != nullptr && table->find("default") != nullptr;
}

/// Presets are written out before overrides reach into them, and again for what an override brought along. Returns
/// whether the default material is written: by the file or by a preset.
bool apply_overrides(TomlTable& root, std::span<const std::string> overrides, std::string_view model) {
    bool default_written = has_default_material(root);
    for (const std::string& assignment : overrides) {
        if (chooses_preset(assignment)) {
            apply_override(root, assignment);
        }
    }
    default_written |= expand_presets(root);
    if (!model.empty()) {
        apply_model(root, model);
    }
    for (const std::string& assignment : overrides) {
        if (!chooses_preset(assignment)) {
            apply_override(root, assignment);
        }
    }
    default_written |= expand_presets(root);
    return default_written;
}

Scene read_tree(TomlTable root, const std::string& file, std::span<const std::string> overrides,
                std::string_view model) {
    const bool default_written = apply_overrides(root, overrides, model);
    check_version(root, file);
    const TableReader table(root, {file, 1, 1}, "the scene", scene_keys);
    if (const TomlEntry* units = table.find("units")) {
        (void)as_text(units->value, "units"); // a note for people: nothing in shading depends on it
    }
    Scene scene;
    scene.file = file;
    if (const TomlEntry* environment = table.find("environment")) {
        scene.environment = read_environment(*environment);
    }
    if (const TomlEntry* output = table.find("output")) {
        scene.background = read_background(*output, scene.environment.has_value());
    }
    if (const TomlEntry* camera = table.find("camera")) {
        read_camera(*camera, scene);
    }
    if (const TomlEntry* gbuffer = table.find("gbuffer")) {
        scene.gbuffer = read_gbuffer(*gbuffer);
    }
    scene.emission_mapped = maps_emission(scene.gbuffer);
    if (const TomlEntry* lights = table.find("light")) {
        scene.lights = read_lights(lights->value);
    }
    if (scene.lights.empty() && !scene.environment && !scene.emission_mapped) {
        fail({file, 1, 1}, "the scene has no light and would be black; add a [[light]] or an [environment], or map the "
                           "emission role in [gbuffer]");
    }
    read_materials(table.find("material"), default_written, scene);
    return scene;
}

} // namespace

Scene parse_scene(std::string_view text, const std::string& file, std::span<const std::string> overrides,
                  std::string_view model) {
    return read_tree(parse_toml(text, file), file, overrides, model);
}

Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides, std::string_view model) {
    const TextFileWords words{"the scene", "name a TOML file", "check the path of --scene"};
    const std::string text = read_text_file(file, largest_file, words, {file.string(), 0, 0});
    return parse_scene(text, file.string(), overrides, model);
}

Scene default_scene(std::span<const std::string> overrides, std::string_view model) {
    const auto read = [&](const std::string& text) {
        return read_tree(parse_toml(text, "default scene"), "", overrides, model);
    };
    Scene scene = read(fmt::format("{}{}", key_text, studio_text));
    if (scene.environment && !scene.environment->image.empty()) {
        scene = read(std::string(key_text)); // what is chosen for the studio is not for a picture
    }
    for (Light& light : scene.lights) {
        light.in_camera_space = true;
        light.where.file.clear();
    }
    if (scene.environment) {
        scene.environment->where.file.clear();
        // A picture, or a studio that is told where up is, stands in the world.
        scene.environment->in_camera_space = scene.environment->image.empty() && !scene.environment->up;
    }
    return scene;
}

Scene default_scene() {
    return default_scene({}, {});
}

} // namespace clshade
