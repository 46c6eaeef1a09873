#include "host/scene/scene_lights.h"

#include "host/scene/toml_reader.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <set>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 9> light_keys{
    "name", "type", "direction", "irradiance", "color", "position", "intensity", "cone_angle_degrees", "cone_softness"};

constexpr std::array<std::string_view, 3> light_types{"distant", "point", "spot"}; // order of LightType

constexpr Range cone_range{"more than 0 and at most 180 degrees", 0.0, 180.0, true};

/// Which keys a light of a type has beside name, type and color.
bool belongs(std::string_view key, LightType type) {
    if (key == "direction") {
        return type != LightType::point;
    }
    if (key == "irradiance") {
        return type == LightType::distant;
    }
    if (key == "position" || key == "intensity") {
        return type != LightType::distant;
    }
    if (key == "cone_angle_degrees" || key == "cone_softness") {
        return type == LightType::spot;
    }
    return true;
}

std::string_view keys_of(LightType type) {
    switch (type) {
    case LightType::distant:
        return "direction, irradiance and color";
    case LightType::point:
        return "position, intensity and color";
    case LightType::spot:
        return "position, direction, intensity, color, cone_angle_degrees and cone_softness";
    }
    return {};
}

/// Control characters would end up in channel names (light.<name>.R) and on terminals.
void check_name(const TomlValue& value, const std::string& name) {
    const bool printable = std::none_of(name.begin(), name.end(),
                                        [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
    if (!printable) {
        fail(value.where, "'name' of a light holds control characters; write plain text, it names an output layer");
    }
}

Light read_light(const TomlValue& value, std::size_t index) {
    const TableReader table(value, fmt::format("[[light]] number {}", index + 1), light_keys);
    Light light;
    light.where = value.where;
    light.name = fmt::format("light{}", index + 1);
    if (const TomlEntry* name = table.find("name")) {
        light.name = as_text(name->value, "name");
        check_name(name->value, light.name);
    }
    const std::size_t type = as_choice(table.require("type", "type = \"distant\""), "type", light_types);
    light.type = static_cast<LightType>(type);
    for (const std::string_view key : light_keys) {
        const TomlEntry* entry = table.find(key);
        if (entry != nullptr && !belongs(key, light.type)) {
            fail(entry->where, fmt::format("'{}' does not belong to light '{}' of type {}; its keys are {}", key,
                                           light.name, light_types[type], keys_of(light.type)));
        }
    }
    if (light.type != LightType::point) {
        const TomlValue& direction = table.require("direction", "direction = [0.3, -0.5, -0.8]");
        light.direction = as_vector(direction, "direction");
        // Lengths below this cannot be normalised safely; no such light is meant.
        if (glm::length(light.direction) < 1e-12) {
            fail(direction.where, fmt::format("'direction' of light '{}' is zero; write the way its light travels, any "
                                              "length",
                                              light.name));
        }
    }
    if (light.type != LightType::distant) {
        light.position = as_vector(table.require("position", "position = [2.0, 1.0, 3.0]"), "position");
    }
    const std::string_view power_key = light.type == LightType::distant ? "irradiance" : "intensity";
    const double power =
        as_number(table.require(power_key, fmt::format("{} = 3.0", power_key)), power_key, not_negative);
    glm::dvec3 color(1.0);
    if (const TomlEntry* entry = table.find("color")) {
        color = as_colour(entry->value, "color", not_negative);
    }
    light.power = power * color;
    if (std::max({light.power.x, light.power.y, light.power.z}) > 1e30) {
        fail(light.where,
             fmt::format("light '{}': {} times color exceeds 1e30; use smaller numbers", light.name, power_key));
    }
    if (light.type == LightType::spot) {
        const TomlValue& angle = table.require("cone_angle_degrees", "cone_angle_degrees = 30.0");
        // 180 degrees written by hand must not exceed pi by rounding.
        light.cone_angle =
            std::min(glm::radians(as_number(angle, "cone_angle_degrees", cone_range)), glm::pi<double>());
        if (const TomlEntry* softness = table.find("cone_softness")) {
            light.cone_softness = as_number(softness->value, "cone_softness", unit_range);
        }
    }
    return light;
}

} // namespace

std::vector<Light> read_lights(const TomlValue& value) {
    const TomlArray* list = value.array();
    if (list == nullptr) {
        fail(value.where, "'light' is not a list of tables; write [[light]] with two brackets, one table each");
    }
    std::vector<Light> lights;
    std::set<std::string> names;
    for (const TomlValue& element : *list) {
        lights.push_back(read_light(element, lights.size()));
        if (!names.insert(lights.back().name).second) {
            fail(element.where, fmt::format("two lights are called '{}'; give each its own name", lights.back().name));
        }
    }
    return lights;
}

} // namespace clshade
