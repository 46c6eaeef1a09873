// Aligned text tables for the terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace clshade::cli {

enum class Align { left, right };

struct TableColumn {
    std::string heading; ///< with the unit, where there is one
    Align align = Align::right;
};

/// Rows of text under headings; every column as wide as its widest cell, two blanks between columns.
class Table {
  public:
    explicit Table(std::vector<TableColumn> columns) : columns_(std::move(columns)) {}
    /// Missing cells are empty. `cells` must not have more entries than there are columns.
    void add_row(std::vector<std::string> cells);
    [[nodiscard]] bool empty() const { return rows_.empty(); }
    /// Heading line and rows, each ended by a line break; no blanks at line ends.
    [[nodiscard]] std::string text() const;

  private:
    std::vector<TableColumn> columns_;
    std::vector<std::vector<std::string>> rows_;
};

/// Breaks `text` at blanks into lines of at most `width` characters; lines after the first start with `indent` blanks.
[[nodiscard]] std::string wrap(std::string_view text, std::size_t width, std::size_t indent);

/// `text` with its middle left out for "..." where it is longer than `width` characters (at least 8): a third of what
/// fits comes from the front. ASCII.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t width);

/// Milliseconds with a precision a reader can use: 0.123, 12.3, 1234.
[[nodiscard]] std::string format_ms(double milliseconds);
/// Error sizes: "0" or "1.23e-07".
[[nodiscard]] std::string format_error(double value);

} // namespace clshade::cli
