// Typed access to TOML tables for the readers of a scene: every getter checks type and range and fails with the place.
#pragma once

#include "host/scene/toml_value.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// Throws UsageError "FILE:LINE:COL: message".
[[noreturn]] void fail(const SourceLocation& where, const std::string& message);

/// What a number may be. `words` completes "'f0' must be ...".
struct Range {
    std::string_view words;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_open = false; ///< `low` itself is not allowed
    bool high_open = false;
};

inline constexpr Range any_number{"a number"};
inline constexpr Range unit_range{"between 0 and 1", 0.0, 1.0};
inline constexpr Range not_negative{"0 or more", 0.0};
inline constexpr Range positive{"more than 0", 0.0, std::numeric_limits<double>::infinity(), true};

/// A finite number within the range and within +-1e30 (so that single precision holds it); whole numbers count.
[[nodiscard]] double as_number(const TomlValue& value, std::string_view key, const Range& range);
/// One number (standing for three) or a list of three.
[[nodiscard]] glm::dvec3 as_colour(const TomlValue& value, std::string_view key, const Range& range);
/// A list of exactly three finite numbers.
[[nodiscard]] glm::dvec3 as_vector(const TomlValue& value, std::string_view key);
/// A string that is not empty.
[[nodiscard]] const std::string& as_text(const TomlValue& value, std::string_view key);
/// A string, or a list of strings, none of them empty.
[[nodiscard]] std::vector<std::string> as_text_list(const TomlValue& value, std::string_view key);
/// Index of the string in `words`; with a suggestion if it is none of them.
[[nodiscard]] std::size_t as_choice(const TomlValue& value, std::string_view key,
                                    std::span<const std::string_view> words);
/// The value of an enumeration by its name_of; with a suggestion if it is none of them.
template <typename Enum, std::size_t size>
[[nodiscard]] Enum as_enum(const TomlValue& value, std::string_view key, const std::array<Enum, size>& all) {
    std::array<std::string_view, size> names;
    std::transform(all.begin(), all.end(), names.begin(), [](Enum each) { return name_of(each); });
    return all.at(as_choice(value, key, names));
}
[[nodiscard]] bool as_bool(const TomlValue& value, std::string_view key);

/// "'KEY' is KIND; write WHAT".
[[noreturn]] void fail_type(const TomlValue& value, std::string_view key, std::string_view what);

/// "'a', 'b', 'c'".
[[nodiscard]] std::string quoted_list(std::span<const std::string_view> words);

/// One table and the keys it may have.
class TableReader {
  public:
    /// Throws for every key that is not among `known`, with a suggestion. `title` names the table in messages, such as
    /// "[camera]" or "light 'key'".
    TableReader(const TomlTable& table, SourceLocation where, std::string title,
                std::span<const std::string_view> known);
    /// The value must be a table.
    TableReader(const TomlValue& value, const std::string& title, std::span<const std::string_view> known);

    [[nodiscard]] const TomlEntry* find(std::string_view key) const { return table_->find(key); }
    [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
    /// Throws that the key is missing, with `example` as what to write.
    [[nodiscard]] const TomlValue& require(std::string_view key, std::string_view example) const;
    [[nodiscard]] const SourceLocation& where() const { return where_; }
    [[nodiscard]] const std::string& title() const { return title_; }

  private:
    const TomlTable* table_;
    SourceLocation where_;
    std::string title_;
};

} // namespace clshade
