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

/// Who wrote an entry, lowest rank first. Where two entries of one lobe exclude each other (a metal beside a model
/// without one, `f0` beside `ior`), the lower rank gives way; of equal rank they are a mistake.
enum class Origin {
    preset,
    file,
    command_line, ///< --set or --model
};

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
    Origin origin = Origin::file;
};

/// Gives a value and all that it holds one place and one origin.
void set_place(TomlValue& value, const SourceLocation& where, Origin origin);

/// Parses TOML text; `file` names it in messages. Throws UsageError "FILE:LINE:COL: ..." on bad syntax.
[[nodiscard]] TomlTable parse_toml(std::string_view text, const std::string& file);

} // namespace clshade
