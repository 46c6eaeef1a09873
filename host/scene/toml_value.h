// A TOML document as plain values that know where they were written. Keeps the TOML library out of everything else and
// lets --set assignments carry their own place.
#pragma once

#include "host/scene/scene.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace clshade {

struct TomlEntry;
struct TomlValue;

/// Dates and times: no key of a scene takes them, so only their presence is kept.
struct TomlDate {};

using TomlArray = std::vector<TomlValue>;

/// Entries in the order of the file.
struct TomlTable {
    std::vector<TomlEntry> entries;

    [[nodiscard]] const TomlEntry* find(std::string_view key) const;
    [[nodiscard]] TomlEntry* find(std::string_view key);
};

struct TomlValue {
    std::variant<bool, std::int64_t, double, std::string, TomlDate, TomlArray, TomlTable> data;
    SourceLocation where;

    [[nodiscard]] const TomlTable* table() const { return std::get_if<TomlTable>(&data); }
    [[nodiscard]] TomlTable* table() { return std::get_if<TomlTable>(&data); }
    [[nodiscard]] const TomlArray* array() const { return std::get_if<TomlArray>(&data); }
    [[nodiscard]] TomlArray* array() { return std::get_if<TomlArray>(&data); }
    [[nodiscard]] const std::string* text() const { return std::get_if<std::string>(&data); }
    /// "a whole number", "a string", ... for messages.
    [[nodiscard]] std::string_view kind() const;
};

struct TomlEntry {
    std::string key;
    SourceLocation where; ///< of the key
    TomlValue value;
};

/// Parses TOML text; `file` names it in messages. Throws UsageError "FILE:LINE:COL: ..." on bad syntax.
[[nodiscard]] TomlTable parse_toml(std::string_view text, const std::string& file);

} // namespace clshade
