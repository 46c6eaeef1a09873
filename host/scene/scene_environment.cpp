#include "host/scene/scene_environment.h"

#include "host/scene/toml_reader.h"

#include <array>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 5> environment_keys{"image", "intensity", "up", "rotation_degrees", "diffuse"};
constexpr std::array<std::string_view, 1> output_keys{"background"};

} // namespace

Environment read_environment(const TomlEntry& entry) {
    const TableReader table(entry.value, "[environment]", environment_keys);
    Environment environment;
    environment.where = entry.where;
    if (const TomlEntry* image = table.find("image")) {
        environment.image = as_text(image->value, "image");
    }
    if (const TomlEntry* intensity = table.find("intensity")) {
        environment.intensity = as_colour(intensity->value, "intensity", not_negative);
    }
    if (const TomlEntry* up = table.find("up")) {
        environment.up = as_enum(up->value, "up", all_up_axes);
    }
    if (const TomlEntry* rotation = table.find("rotation_degrees")) {
        environment.rotation = glm::radians(as_number(rotation->value, "rotation_degrees", any_number));
    }
    if (const TomlEntry* diffuse = table.find("diffuse")) {
        environment.diffuse = as_enum(diffuse->value, "diffuse", all_ambient_sources);
    }
    return environment;
}

bool read_background(const TomlEntry& output, bool has_environment) {
    const TableReader table(output.value, "[output]", output_keys);
    const TomlEntry* background = table.find("background");
    if (background == nullptr || !as_bool(background->value, "background")) {
        return false;
    }
    if (!has_environment) {
        fail(background->where, "'background' of [output] shows the environment, and the scene has none; add "
                                "[environment] with image = \"FILE.hdr\", or an empty [environment] for the built-in "
                                "studio");
    }
    return true;
}

} // namespace clshade
