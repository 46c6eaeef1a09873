#include "host/scene/toml_reader.h"

#include "host/base/error.h"
#include "host/base/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace clshade {

namespace {

const TomlTable& table_of(const TomlValue& value, const std::string& title) {
    if (value.table() == nullptr) {
        fail(value.where, fmt::format("{} is {}; write a table", title, value.kind()));
    }
    return *value.table();
}

} // namespace

void fail(const SourceLocation& where, const std::string& message) {
    std::string line = message_prefix(where) + message;
    // Keys and --set arguments may hold line breaks and worse; an error stays one line of plain text.
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    std::replace_if(line.begin(), line.end(), is_control, '?');
    throw UsageError(line);
}

void fail_type(const TomlValue& value, std::string_view key, std::string_view what) {
    fail(value.where, fmt::format("'{}' is {}; write {}", key, value.kind(), what));
}

std::string quoted_list(std::span<const std::string_view> words) {
    std::string list;
    for (const std::string_view word : words) {
        list += fmt::format("{}'{}'", list.empty() ? "" : ", ", word);
    }
    return list;
}

double as_number(const TomlValue& value, std::string_view key, const Range& range) {
    double number = 0.0;
    if (const auto* whole = std::get_if<std::int64_t>(&value.data)) {
        number = static_cast<double>(*whole);
    } else if (const auto* real = std::get_if<double>(&value.data)) {
        number = *real;
    } else {
        fail_type(value, key, "a number");
    }
    // Kernels work in single precision; the limit leaves room for products such as intensity times colour.
    if (!std::isfinite(number) || std::abs(number) > 1e30) {
        fail(value.where, fmt::format("'{}' is {}; write a finite number of at most 1e30", key, number));
    }
    const bool low_ok = range.low_open ? number > range.low : number >= range.low;
    const bool high_ok = range.high_open ? number < range.high : number <= range.high;
    if (!low_ok || !high_ok) {
        fail(value.where, fmt::format("'{}' is {}; it must be {}", key, number, range.words));
    }
    return number;
}

glm::dvec3 as_colour(const TomlValue& value, std::string_view key, const Range& range) {
    const TomlArray* list = value.array();
    if (list == nullptr) {
        return glm::dvec3(as_number(value, key, range));
    }
    if (list->size() != 3) {
        fail(value.where, fmt::format("'{}' has {} numbers; write one number or three", key, list->size()));
    }
    return {as_number((*list)[0], key, range), as_number((*list)[1], key, range), as_number((*list)[2], key, range)};
}

glm::dvec3 as_vector(const TomlValue& value, std::string_view key) {
    const TomlArray* list = value.array();
    if (list == nullptr) {
        fail_type(value, key, "a list of three numbers");
    }
    if (list->size() != 3) {
        fail(value.where, fmt::format("'{}' has {} numbers; write three: [x, y, z]", key, list->size()));
    }
    return as_colour(value, key, any_number);
}

const std::string& as_text(const TomlValue& value, std::string_view key) {
    const std::string* text = value.text();
    if (text == nullptr) {
        fail_type(value, key, "a string");
    }
    if (text->empty()) {
        fail(value.where, fmt::format("'{}' is empty; write a name or remove the key", key));
    }
    return *text;
}

std::vector<std::string> as_text_list(const TomlValue& value, std::string_view key) {
    if (value.text() != nullptr) {
        return {as_text(value, key)};
    }
    const TomlArray* list = value.array();
    if (list == nullptr) {
        fail_type(value, key, "a string or a list of strings");
    }
    if (list->empty()) {
        fail(value.where, fmt::format("'{}' is an empty list; write a layer or its channels", key));
    }
    std::vector<std::string> texts;
    for (const TomlValue& element : *list) {
        texts.push_back(as_text(element, key));
    }
    return texts;
}

std::size_t as_choice(const TomlValue& value, std::string_view key, std::span<const std::string_view> words) {
    const std::string& text = as_text(value, key);
    const auto found = std::find(words.begin(), words.end(), text);
    if (found == words.end()) {
        std::string advice = did_you_mean(text, words);
        if (advice.empty()) {
            advice = fmt::format("; write one of {}", quoted_list(words));
        }
        fail(value.where, fmt::format("'{}' is '{}', which is unknown{}", key, text, advice));
    }
    return static_cast<std::size_t>(found - words.begin());
}

bool as_bool(const TomlValue& value, std::string_view key) {
    const bool* flag = std::get_if<bool>(&value.data);
    if (flag == nullptr) {
        fail_type(value, key, "true or false");
    }
    return *flag;
}

TableReader::TableReader(const TomlTable& table, SourceLocation where, std::string title,
                         std::span<const std::string_view> known)
    : table_(&table), where_(std::move(where)), title_(std::move(title)) {
    for (const TomlEntry& entry : table.entries) {
        if (std::find(known.begin(), known.end(), entry.key) == known.end()) {
            std::string advice = did_you_mean(entry.key, known);
            if (advice.empty()) {
                advice = fmt::format("; known keys are {}", quoted_list(known));
            }
            fail(entry.where, fmt::format("unknown key '{}' in {}{}", entry.key, title_, advice));
        }
    }
}

TableReader::TableReader(const TomlValue& value, const std::string& title, std::span<const std::string_view> known)
    : TableReader(table_of(value, title), value.where, title, known) {}

const TomlValue& TableReader::require(std::string_view key, std::string_view example) const {
    const TomlEntry* entry = find(key);
    if (entry == nullptr) {
        fail(where_, fmt::format("{} lacks '{}'; write for instance {}", title_, key, example));
    }
    return entry->value;
}

} // namespace clshade
