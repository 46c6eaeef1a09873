#include "host/scene/toml_value.h"

#include "host/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <toml++/toml.h>
#include <tuple>

namespace clshade {

namespace {

SourceLocation location(const toml::source_region& region, const std::string& file) {
    return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

TomlValue convert(const toml::node& node, const std::string& file);

TomlTable convert_table(const toml::table& table, const std::string& file) {
    TomlTable result;
    for (const auto& [key, node] : table) {
        result.entries.push_back({std::string(key.str()), location(key.source(), file), convert(node, file)});
    }
    // The library sorts by key; people read errors and materials in the order they wrote them.
    std::stable_sort(result.entries.begin(), result.entries.end(), [](const TomlEntry& a, const TomlEntry& b) {
        return std::tie(a.where.line, a.where.column) < std::tie(b.where.line, b.where.column);
    });
    return result;
}

TomlValue convert(const toml::node& node, const std::string& file) {
    TomlValue value{TomlDate{}, location(node.source(), file)};
    if (const auto* table = node.as_table()) {
        value.data = convert_table(*table, file);
    } else if (const auto* array = node.as_array()) {
        TomlArray elements;
        for (const toml::node& element : *array) {
            elements.push_back(convert(element, file));
        }
        value.data = std::move(elements);
    } else if (const auto* text = node.as_string()) {
        value.data = text->get();
    } else if (const auto* integer = node.as_integer()) {
        value.data = integer->get();
    } else if (const auto* number = node.as_floating_point()) {
        value.data = number->get();
    } else if (const auto* boolean = node.as_boolean()) {
        value.data = boolean->get();
    }
    return value;
}

} // namespace

const TomlEntry* TomlTable::find(std::string_view key) const {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const TomlEntry& entry) { return entry.key == key; });
    return found == entries.end() ? nullptr : &*found;
}

TomlEntry* TomlTable::find(std::string_view key) {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const TomlEntry& entry) { return entry.key == key; });
    return found == entries.end() ? nullptr : &*found;
}

std::string_view TomlValue::kind() const {
    static constexpr std::array<std::string_view, 7> kinds{"true or false", "a whole number", "a number", "a string",
                                                           "a date",        "a list",         "a table"};
    return kinds.at(data.index());
}

void set_place(TomlValue& value, const SourceLocation& where, Origin origin) {
    value.where = where;
    if (TomlArray* list = value.array()) {
        for (TomlValue& element : *list) {
            set_place(element, where, origin);
        }
    } else if (TomlTable* table = value.table()) {
        for (TomlEntry& entry : table->entries) {
            entry.where = where;
            entry.origin = origin;
            set_place(entry.value, where, origin);
        }
    }
}

TomlTable parse_toml(std::string_view text, const std::string& file) {
    try {
        return convert_table(toml::parse(text), file);
    } catch (const toml::parse_error& error) {
        throw UsageError(fmt::format("{}{}; correct the TOML syntax", message_prefix(location(error.source(), file)),
                                     error.description()));
    }
}

} // namespace clshade
