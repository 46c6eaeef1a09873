#include "host/scene/scene_parameters.h"

#include "host/scene/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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

void refuse_conversion(const Parameter& parameter, std::string_view key, std::string_view kind) {
    if (parameter.convert != Conversion::none) {
        fail(parameter.where, fmt::format("convert = \"{}\" makes a shininess, but '{}' is {}; remove 'convert'",
                                          name_of(parameter.convert), key, kind));
    }
}

} // namespace

Parameter read_reflectance(const TomlValue& value, std::string_view key) {
    Parameter parameter = read_parameter(value, key, unit_range);
    refuse_conversion(parameter, key, "a reflectance");
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
    if (const TomlTable* table = value.table()) {
        if (const TomlEntry* convert = table->find("convert")) {
            fail(convert->where, "'ior' is converted to a reflectance already; remove 'convert'");
        }
    }
    Parameter parameter = read_parameter(value, "ior", ior_range);
    if (parameter.is_constant()) {
        // models.md section 5: F0 = ((n - 1) / (n + 1))^2 against air.
        const glm::dvec3 ratio = (parameter.constant - 1.0) / (parameter.constant + 1.0);
        parameter.constant = ratio * ratio;
    } else {
        parameter.convert = Conversion::index_of_refraction;
    }
    return parameter;
}

Parameter read_absorption(const TomlValue& value) {
    Parameter parameter = read_parameter(value, "absorption", not_negative);
    refuse_conversion(parameter, "absorption", "an absorption");
    return parameter;
}

Parameter read_tangent(const TomlValue& value) {
    if (const TomlTable* table = value.table()) {
        for (const std::string_view key : {"convert", "scale", "offset"}) {
            if (const TomlEntry* entry = table->find(key)) {
                fail(entry->where, fmt::format("'tangent' is a direction, which '{}' would turn; remove it", key));
            }
        }
    }
    if (value.table() != nullptr || names_channels(value)) {
        return read_parameter(value, "tangent", any_number);
    }
    if (value.array() == nullptr) {
        fail_type(value, "tangent", "three numbers, or a role or layer name");
    }
    const glm::dvec3 written = as_vector(value, "tangent");
    // Divided by the largest component first: the square of a number such as 1e-200 would be 0.
    const double largest = std::max({std::abs(written.x), std::abs(written.y), std::abs(written.z)});
    if (largest == 0.0) {
        fail(value.where, "'tangent' is zero; write a direction such as [0, 0, 1]");
    }
    Parameter parameter = Parameter::of(glm::normalize(written / largest));
    parameter.where = value.where;
    return parameter;
}

} // namespace clshade
