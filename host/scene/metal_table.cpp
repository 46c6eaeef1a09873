#include "host/scene/metal_table.h"

#include "host/base/suggest.h"
#include "host/scene/text_file.h"
#include "host/scene/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

namespace clshade {

namespace {

// models.md section 4, "Example data": nanometres, n, k.
constexpr std::array<ComplexIndex, 19> gold{{
    {381.49, 1.6848, 1.9225}, {399.95, 1.6580, 1.9560}, {427.53, 1.6160, 1.9400}, {450.85, 1.5021, 1.8759},
    {476.86, 1.2420, 1.7960}, {506.06, 0.7545, 1.9565}, {527.59, 0.4918, 2.3263}, {539.06, 0.4020, 2.5400},
    {551.04, 0.3455, 2.7306}, {563.56, 0.3060, 2.8800}, {576.67, 0.2676, 2.9406}, {590.40, 0.2360, 2.9700},
    {604.80, 0.2124, 3.0150}, {619.92, 0.1940, 3.0600}, {652.55, 0.1660, 3.1500}, {688.80, 0.1600, 3.8000},
    {729.32, 0.1640, 4.3570}, {774.90, 0.1760, 4.8600}, {799.90, 0.1814, 5.1258},
}};
constexpr std::array<ComplexIndex, 19> copper{{
    {381.49, 1.2000, 2.1216}, {399.95, 1.1750, 2.1300}, {427.53, 1.1750, 2.2890}, {450.85, 1.1653, 2.3976},
    {476.86, 1.1500, 2.5040}, {506.06, 1.1316, 2.5896}, {527.59, 1.0924, 2.5956}, {539.06, 1.0400, 2.5830},
    {551.04, 0.9504, 2.5765}, {563.56, 0.8260, 2.5990}, {576.67, 0.6459, 2.6781}, {590.40, 0.4680, 2.8090},
    {604.80, 0.3513, 3.0108}, {619.92, 0.2720, 3.2400}, {652.55, 0.2140, 3.6700}, {688.80, 0.2130, 4.0500},
    {729.32, 0.2230, 4.4300}, {774.90, 0.2500, 4.8170}, {799.90, 0.2542, 5.0341},
}};
constexpr std::array<std::string_view, 2> metal_names{"gold", "copper"};

// From the far ultraviolet to the far infrared: beyond lies another unit (micrometres, angstrom) or another quantity.
constexpr double shortest = 100.0;
constexpr double longest = 20000.0;
constexpr double visible_from = 380.0;
constexpr double visible_to = 780.0;
// Metals stay below 300 out to the far infrared; keeps n^2 k^2 of the Fresnel formula far from overflow.
constexpr double largest_index = 10000.0;

constexpr std::string_view blanks = " \t\r\v\f";
constexpr std::string_view row_advice = "write wavelength_nm,n,k in each line";

/// A value of a row and the column it starts in, counted from 1.
struct Field {
    std::string_view text;
    int column = 0;
};

/// The values of a line without its comment. Blanks separate, and so does one comma or semicolon, so that two commas
/// enclose an empty value.
std::vector<Field> fields_of(std::string_view line) {
    line = line.substr(0, line.find('#'));
    std::vector<Field> fields;
    const auto skip_blanks = [&](std::size_t from) {
        return std::min(line.find_first_not_of(blanks, from), line.size());
    };
    std::size_t begin = skip_blanks(0);
    while (begin < line.size()) {
        const std::size_t end = std::min(line.find_first_of(" \t\r\v\f,;", begin), line.size());
        fields.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
        begin = skip_blanks(end);
        if (begin < line.size() && (line[begin] == ',' || line[begin] == ';')) {
            begin = skip_blanks(begin + 1);
            if (begin == line.size()) {
                fields.push_back({{}, static_cast<int>(begin) + 1}); // a comma at the end
            }
        }
    }
    return fields;
}

/// Parses all of `text`, with or without a sign; what does not fit is infinite. Absent: not a number ("nan" is one).
std::optional<double> whole_number_in(std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
    }
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc::invalid_argument || end != text.data() + text.size()) {
        return std::nullopt;
    }
    return error == std::errc::result_out_of_range ? std::numeric_limits<double>::infinity() : number;
}

/// A line of words, as spreadsheets write above their columns. "4OO" with two letters O is a mistake, not a word.
bool is_heading(const std::vector<Field>& fields) {
    return std::all_of(fields.begin(), fields.end(), [](const Field& field) {
        return field.text.find_first_of("0123456789+-.") != 0 && !whole_number_in(field.text).has_value();
    });
}

double number_of(const Field& field, std::string_view what, SourceLocation where) {
    where.column = field.column;
    const std::optional<double> number = whole_number_in(field.text);
    if (!number.has_value()) {
        fail(where, fmt::format("{} is '{}', which is not a number; {}", what, field.text, row_advice));
    }
    if (!std::isfinite(*number)) {
        fail(where, fmt::format("{} is {}; write a finite number", what, field.text));
    }
    return *number;
}

ComplexIndex sample_of(const std::vector<Field>& fields, const SourceLocation& where) {
    if (fields.size() != 3) {
        fail(where,
             fmt::format("the line has {} value{}; {}", fields.size(), fields.size() == 1 ? "" : "s", row_advice));
    }
    const auto at = [&](const Field& field) { return SourceLocation{where.file, where.line, field.column}; };
    const ComplexIndex sample{number_of(fields[0], "the wavelength", where), number_of(fields[1], "n", where),
                              number_of(fields[2], "k", where)};
    if (sample.wavelength < shortest || sample.wavelength > longest) {
        fail(at(fields[0]), fmt::format("the wavelength {} is not within {} and {}; write nanometres",
                                        sample.wavelength, shortest, longest));
    }
    if (!(sample.n > 0.0) || sample.n > largest_index) {
        fail(at(fields[1]), fmt::format("n is {}; it must be more than 0 and at most {}", sample.n, largest_index));
    }
    if (!(sample.k >= 0.0) || sample.k > largest_index) {
        fail(at(fields[2]), fmt::format("k is {}; it must be between 0 and {}", sample.k, largest_index));
    }
    return sample;
}

void check_range(const Metal& metal, const SourceLocation& last_line) {
    if (metal.samples.size() < 2) {
        fail(last_line, fmt::format("the table has {} row{}; write two or more of wavelength_nm,n,k",
                                    metal.samples.size(), metal.samples.size() == 1 ? "" : "s"));
    }
    const double first = metal.samples.front().wavelength;
    const double last = metal.samples.back().wavelength;
    if (last < visible_from || first > visible_to) {
        fail(last_line, fmt::format("the table covers {} to {} nm and nothing that can be seen; add rows between {} "
                                    "and {} nm",
                                    first, last, visible_from, visible_to));
    }
}

} // namespace

std::span<const std::string_view> built_in_metal_names() {
    return metal_names;
}

std::optional<Metal> built_in_metal(std::string_view name) {
    if (name == "gold") {
        return Metal{std::string(name), {gold.begin(), gold.end()}};
    }
    if (name == "copper") {
        return Metal{std::string(name), {copper.begin(), copper.end()}};
    }
    return std::nullopt;
}

Metal parse_metal_table(std::string_view text, const std::string& name, const std::string& file) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text.starts_with(byte_order_mark)) {
        text.remove_prefix(byte_order_mark.size());
    }
    Metal metal{name, {}};
    bool may_be_heading = true;
    SourceLocation where{file, 1, 1};
    SourceLocation last_line = where;
    for (; !text.empty(); ++where.line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::vector<Field> fields = fields_of(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (fields.empty()) {
            continue;
        }
        last_line.line = where.line;
        if (std::exchange(may_be_heading, false) && is_heading(fields)) {
            continue;
        }
        const ComplexIndex sample = sample_of(fields, where);
        if (!metal.samples.empty() && sample.wavelength <= metal.samples.back().wavelength) {
            fail({file, where.line, fields.front().column},
                 fmt::format("the wavelength {} follows {}; sort the rows so that wavelengths rise", sample.wavelength,
                             metal.samples.back().wavelength));
        }
        metal.samples.push_back(sample);
    }
    check_range(metal, last_line);
    return metal;
}

Metal find_metal(const std::string& name, const std::filesystem::path& folder, const SourceLocation& where) {
    if (std::optional<Metal> metal = built_in_metal(name)) {
        return *std::move(metal);
    }
    const std::filesystem::path file = folder / name;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        std::string advice = did_you_mean(name, metal_names);
        if (advice.empty()) {
            advice = fmt::format("; write one of {}, or the path of a table of wavelength_nm,n,k relative to the scene",
                                 quoted_list(metal_names));
        }
        fail(where, fmt::format("metal '{}' is neither built in nor a file ({}){}", name, file.string(), advice));
    }
    const std::string subject = fmt::format("the metal table '{}'", file.string());
    const TextFileWords words{subject, "name a text file with lines wavelength_nm,n,k", "check its permissions"};
    constexpr std::size_t largest_table = 1; // MiB: thousands of times what a metal needs
    return parse_metal_table(read_text_file(file, largest_table, words, where), name, file.string());
}

} // namespace clshade
