#include "host/cli/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace clshade::cli {

namespace {

// Length in characters of UTF-8 text: continuation bytes do not count.
std::size_t display_width(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

void append_cell(std::string& line, std::string_view cell, std::size_t width, Align align) {
    const std::size_t gap = width - std::min(width, display_width(cell));
    if (align == Align::right) {
        line.append(gap, ' ');
    }
    line += cell;
    if (align == Align::left) {
        line.append(gap, ' ');
    }
}

} // namespace

void Table::add_row(std::vector<std::string> cells) {
    cells.resize(columns_.size());
    rows_.push_back(std::move(cells));
}

std::string Table::text() const {
    std::vector<std::size_t> widths;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        std::size_t width = display_width(columns_[i].heading);
        for (const auto& row : rows_) {
            width = std::max(width, display_width(row[i]));
        }
        widths.push_back(width);
    }
    std::string text;
    const auto add_line = [&](auto&& cell_of) {
        std::string line;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            line += i > 0 ? "  " : "";
            append_cell(line, cell_of(i), widths[i], columns_[i].align);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    };
    add_line([&](std::size_t i) -> std::string_view { return columns_[i].heading; });
    for (const auto& row : rows_) {
        add_line([&](std::size_t i) -> std::string_view { return row[i]; });
    }
    return text;
}

std::string wrap(std::string_view text, std::size_t width, std::size_t indent) {
    std::string wrapped;
    std::size_t column = 0;
    while (!text.empty()) {
        const std::size_t blank = std::min(text.find(' '), text.size());
        const std::string_view word = text.substr(0, blank);
        if (column > 0 && column + 1 + word.size() > width) {
            wrapped += '\n';
            wrapped.append(indent, ' ');
            column = 0;
        } else if (column > 0) {
            wrapped += ' ';
            ++column;
        }
        wrapped += word;
        column += word.size();
        text.remove_prefix(std::min(blank + 1, text.size()));
    }
    return wrapped;
}

std::string shortened(std::string_view text, std::size_t width) {
    constexpr std::string_view gap = "...";
    if (text.size() <= width) {
        return std::string(text);
    }
    const std::size_t front = (width - gap.size()) / 3;
    const std::size_t back = width - gap.size() - front;
    return fmt::format("{}{}{}", text.substr(0, front), gap, text.substr(text.size() - back));
}

std::string format_ms(double milliseconds) {
    if (milliseconds >= 1000.0) {
        return fmt::format("{:.0f}", milliseconds);
    }
    return milliseconds >= 10.0 ? fmt::format("{:.1f}", milliseconds) : fmt::format("{:.3f}", milliseconds);
}

std::string format_error(double value) {
    return value == 0.0 ? "0" : fmt::format("{:.2e}", value);
}

} // namespace clshade::cli
