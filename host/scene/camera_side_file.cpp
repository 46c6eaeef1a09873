#include "host/scene/camera_side_file.h"

#include "host/scene/scene_camera.h"
#include "host/scene/text_file.h"
#include "host/scene/toml_reader.h"
#include "host/scene/toml_value.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

namespace {

using Json = nlohmann::json;

constexpr std::size_t largest_file = 4; ///< MiB: exporters may write a whole scene there, but no pictures

/// Other spellings of our keys in JSON files.
struct Alias {
    std::string_view name;
    std::string_view key;
};
constexpr std::array<Alias, 2> aliases{Alias{"fov_x_deg", "fov_x_degrees"}, Alias{"fov_y_deg", "fov_y_degrees"}};

std::string_view key_of(std::string_view name) {
    const auto* found = std::find_if(aliases.begin(), aliases.end(), [&](const Alias& a) { return a.name == name; });
    return found == aliases.end() ? name : found->key;
}

/// JSON tells no places within the file. `depth` levels of lists are enough for a matrix.
TomlValue value_of(const Json& json, std::string_view key, const SourceLocation& where, int depth) {
    TomlValue value{TomlDate{}, where};
    if (json.is_boolean()) {
        value.data = json.get<bool>();
    } else if (json.is_number_integer() && !json.is_number_unsigned()) {
        value.data = json.get<std::int64_t>();
    } else if (json.is_number()) {
        value.data = json.get<double>();
    } else if (json.is_string()) {
        value.data = json.get<std::string>();
    } else if (json.is_object()) {
        value.data = TomlTable{};
    } else if (json.is_array() && depth > 0) {
        TomlArray list;
        for (const Json& element : json.get_ref<const Json::array_t&>()) {
            list.push_back(value_of(element, key, where, depth - 1));
        }
        value.data = std::move(list);
    } else {
        fail(where, fmt::format("'{}' holds {}; write {}", key, json.is_null() ? "null" : "lists in lists in lists",
                                key == "matrix_world" ? "four rows of four numbers" : "a number"));
    }
    return value;
}

void add_key(TomlTable& table, std::string_view name, const Json& json, const SourceLocation& where) {
    const std::string key(key_of(name));
    if (table.find(key) != nullptr) {
        fail(where, fmt::format("'{}' and '{}' are the same key; keep one", name, key));
    }
    table.entries.push_back({key, where, value_of(json, key, where, 2)});
}

/// Keys at top level: ours alone.
CameraKeys keys_at_top(const Json& root, const SourceLocation& where) {
    TomlTable table;
    for (const auto& [name, json] : root.get_ref<const Json::object_t&>()) {
        add_key(table, name, json, where);
    }
    return read_camera_keys(TableReader(table, where, "the side file", camera_key_names()));
}

/// "type" as Blender has it. Empty: not said.
std::string type_of(const Json& camera) {
    const auto found = camera.find("type");
    if (found == camera.end() || !found->is_string()) {
        return {};
    }
    std::string type = found->get<std::string>();
    std::transform(type.begin(), type.end(), type.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return type;
}

/// Keys of an exporter's "camera" object, which may hold much else.
CameraKeys keys_of_object(const Json& camera, const SourceLocation& where) {
    TomlTable table;
    for (const auto& [name, json] : camera.get_ref<const Json::object_t&>()) {
        const auto known = camera_key_names();
        if (!json.is_null() && std::find(known.begin(), known.end(), key_of(name)) != known.end()) {
            add_key(table, name, json, where);
        }
    }
    const auto drop = [&](std::string_view key) {
        std::erase_if(table.entries, [&](const TomlEntry& entry) { return entry.key == key; });
    };
    const std::string type = type_of(camera);
    const bool orthographic = type.starts_with("ORTHO");
    if (type.starts_with("PANO")) {
        fail(where, "the camera is a panorama; give one with type PERSP or ORTHO");
    }
    if (orthographic && table.find("orthographic_height") == nullptr) {
        fail(where, "the camera is orthographic but has no 'orthographic_height'; write it, in scene units over the "
                    "height of the display window");
    }
    if (orthographic) { // exporters write angles all the same
        drop("fov_x_degrees");
        drop("fov_y_degrees");
    } else if (type.starts_with("PERSP")) {
        drop("orthographic_height");
    }
    if (table.find("fov_y_degrees") != nullptr) { // the same lens; which of them fits is up to the pixels' aspect
        drop("fov_x_degrees");
    }
    return read_camera_keys(TableReader(table, where, "\"camera\"", camera_key_names()));
}

CameraKeys read_json(const std::string& text, const SourceLocation& where) {
    Json root;
    try {
        root = Json::parse(text);
    } catch (const Json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
        std::string_view what = error.what();
        what.remove_prefix(std::min(what.find("] ") + 2, what.size()));
        fail(where, fmt::format("{}; correct the JSON syntax", what));
    }
    if (!root.is_object()) {
        fail(where,
             fmt::format("the side file is {}, not an object; write {{\"matrix_world\": ...}}", root.type_name()));
    }
    const auto camera = root.find("camera");
    if (camera == root.end()) {
        return keys_at_top(root, where);
    }
    if (!camera->is_object()) {
        fail(where, fmt::format("\"camera\" is {}; write an object", camera->type_name()));
    }
    return keys_of_object(*camera, where);
}

CameraKeys read_toml(const std::string& text, const SourceLocation& where) {
    const TomlTable root = parse_toml(text, where.file);
    const SourceLocation start{where.file, 1, 1};
    if (const TomlEntry* camera = root.find("camera")) {
        static constexpr std::array<std::string_view, 1> only_camera{"camera"};
        const TableReader table(root, start, "the side file, beside [camera]", only_camera);
        return read_camera_keys(TableReader(camera->value, "[camera]", camera_key_names()));
    }
    return read_camera_keys(TableReader(root, start, "the side file", camera_key_names()));
}

} // namespace

CameraKeys read_camera_side_file(const std::filesystem::path& file) {
    const SourceLocation where{file.string(), 0, 0};
    const TextFileWords words{"the camera's side file", "name a .json or .toml file",
                              "check 'file' in [camera] of the scene, or write the file"};
    const std::string text = read_text_file(file, largest_file, words, where);
    CameraKeys keys = file.extension() == ".json" ? read_json(text, where) : read_toml(text, where);
    keys.where = where;
    return keys;
}

} // namespace clshade
