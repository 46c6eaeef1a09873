#include "host/scene/scene_parameters.h"

#include "host/scene/toml_reader.h"

#include <fmt/format.h>

#include <array>

namespace clshade {

namespace {

constexpr std::array<std::string_view, 4> parameter_keys{"channel", "convert", "scale", "offset"};
constexpr std::array<std::string_view, 4> conversions{"none", "ggx_roughness", "smoothness",
                                                      "oren_nayar_sigma"}; // order of Conversion
constexpr Range shininess_range{"between 0 and 65536", 0.0, 65536.0};
constexpr Range ior_range{"1 or more", 1.0};

/// One or three channels, of a role, a layer or by full name.
std::vector<std::string> read_channels(const TomlValue& value, std::string_view key) {
    std::vector<std::string> channels = as_text_list(value, key);
    if (channels.size() != 1 && channels.size() != 3) {
        fail(value.where, fmt::format("'{}' lists {} channels; write one or three", key, channels.size()));
    }
    return channels;
}

Parameter read_mapping(const TomlValue& value, std::string_view key) {
    const TableReader table(value, fmt::format("parameter '{}'", key), parameter_keys);
    Parameter parameter;
    parameter.channels = read_channels(table.require("channel", "channel = \"roughness\""), "channel");
    if (const TomlEntry* convert = table.find("convert")) {
        parameter.convert = static_cast<Conversion>(as_choice(convert->value, "convert", conversions));
    }
    if (const TomlEntry* scale = table.find("scale")) {
        parameter.scale = as_number(scale->value, "scale", any_number);
    }
    if (const TomlEntry* offset = table.find("offset")) {
        parameter.offset = as_number(offset->value, "offset", any_number);
    }
    return parameter;
}

/// A list of strings names channels; any other list is numbers.
bool names_channels(const TomlValue& value) {
    const TomlArray* list = value.array();
    return value.text() != nullptr || (list != nullptr && !list->empty() && list->front().text() != nullptr);
}

Parameter read_parameter(const TomlValue& value, std::string_view key, const Range& range) {
    Parameter parameter;
    if (value.table() != nullptr) {
        parameter = read_mapping(value, key);
    } else if (names_channels(value)) {
        parameter.channels = read_channels(value, key);
    } else if (std::holds_alternative<bool>(value.data) || std::holds_alternative<TomlDate>(value.data)) {
        fail_type(value, key, "a number, three numbers, a role or layer name, or { channel, convert, scale, offset }");
    } else {
        parameter.constant = as_colour(value, key, range);
    }
    parameter.where = value.where;
    return parameter;
}

} // namespace

Parameter read_reflectance(const TomlValue& value, std::string_view key) {
    Parameter parameter = read_parameter(value, key, unit_range);
    if (parameter.convert != Conversion::none) {
        fail(value.where, fmt::format("convert = \"{}\" makes a shininess, but '{}' is a reflectance; remove 'convert'",
                                      name_of(parameter.convert), key));
    }
    return parameter;
}

Parameter read_shininess(const TomlValue& value, std::string_view key) {
    if (value.array() != nullptr && !names_channels(value)) {
        fail(value.where, fmt::format("'{}' is one number for all colours; write a number or a channel", key));
    }
    Parameter parameter = read_parameter(value, key, shininess_range);
    if (parameter.channels.size() > 1) {
        fail(value.where, fmt::format("'{}' lists {} channels; write one", key, parameter.channels.size()));
    }
    return parameter;
}

Parameter read_ior(const TomlValue& value) {
    // models.md section 5: F0 = ((n - 1) / (n + 1))^2 against air.
    const glm::dvec3 n = as_colour(value, "ior", ior_range);
    const glm::dvec3 ratio = (n - 1.0) / (n + 1.0);
    Parameter parameter = Parameter::of(ratio * ratio);
    parameter.where = value.where;
    return parameter;
}

} // namespace clshade
