#include "host/cli/help.h"

#include "host/cli/table.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace clshade::cli {

namespace {

constexpr std::size_t page_width = 100;
constexpr std::size_t flag_column = 26;

constexpr std::string_view exit_codes =
    "Exit codes: 0 done; 1 run-time failure; 2 bad usage or scene; 3 check or baseline failed; 4 some frames failed,\n"
    "the rest are written; 5 no usable device; 130 / 143 interrupted, with no partial output left behind.\n";

std::string flag_text(const CLI::Option& option) {
    std::string text = option.get_name(false, true); // "-o,--output"
    for (std::size_t at = text.find(','); at != std::string::npos; at = text.find(',', at + 2)) {
        text.insert(at + 1, " ");
    }
    if (option.get_items_expected_max() > 0 && !option.get_type_name().empty()) {
        text += " " + option.get_type_name();
    }
    return text;
}

std::string flag_lines(const CLI::Option& option) {
    std::string text = "  " + flag_text(option);
    if (text.size() + 2 > flag_column) {
        text += '\n';
        text.append(flag_column, ' ');
    } else {
        text.append(flag_column - text.size(), ' ');
    }
    return text + wrap(option.get_description(), page_width - flag_column, flag_column) + '\n';
}

void append_group(std::string& page, const CLI::App& app, const std::string& group, std::string_view heading) {
    std::string lines;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group() == group && !option->get_positional()) {
            lines += flag_lines(*option);
        }
    }
    if (!lines.empty()) {
        page += fmt::format("\n{}:\n{}", heading, lines);
    }
}

} // namespace

std::string overview() {
    std::string page =
        fmt::format("clshade {}: shades G-buffers with the tri-Ace models in OpenCL, times the kernels and "
                    "proves them right\n\nUsage: clshade VERB [flags]\n\nVerbs:\n",
                    CLSHADE_VERSION);
    for (const Verb& verb : verbs()) {
        page += fmt::format("  {:<10} {}\n", verb.name, verb.summary);
    }
    page += "\n`clshade help VERB` (or `clshade VERB --help`) lists a verb's flags; `clshade --version` prints the "
            "version.\n\n"
            "Start here:\n"
            "  clshade demo                         make a G-buffer, shade it, show the times; needs no input\n"
            "  clshade shade in.exr -o out.exr      shade a render's G-buffer with the default scene\n"
            "  clshade inspect in.exr               see which channel plays which role\n\n";
    return page.append(exit_codes);
}

std::string help_page(const Verb& verb, const CLI::App& app) {
    std::string page = fmt::format("Usage: clshade {}{}{}\n\n{}\n", verb.name, verb.synopsis.empty() ? "" : " ",
                                   verb.synopsis, verb.summary);
    std::string positionals;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) {
            positionals += fmt::format("  {:<{}}{}\n", option->get_name(true, false), flag_column - 2,
                                       wrap(option->get_description(), page_width - flag_column, flag_column));
        }
    }
    if (!positionals.empty()) {
        page += "\nArguments:\n" + positionals;
    }
    append_group(page, app, "Options", "Flags");
    append_group(page, app, "Common flags", "Common flags");
    if (!verb.details.empty()) {
        page += fmt::format("\n{}\n", verb.details);
    }
    return page.append("\n").append(exit_codes);
}

} // namespace clshade::cli
