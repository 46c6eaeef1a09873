// OpenCL sources by name, and the expansion of their #include lines on the host.
#include "host/base/error.h"
#include "host/device/program.h"
#include "host/device/whole_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace clshade {

namespace {

constexpr std::size_t expanded_limit = std::size_t{64} << 20; ///< no honest kernel comes near; stops runaway includes

std::string_view without_leading_blanks(std::string_view line) {
    const auto first = line.find_first_not_of(" \t");
    return first == std::string_view::npos ? std::string_view() : line.substr(first);
}

/// What follows "#" and blanks at the start of the line; empty if the line is no directive.
std::string_view directive(std::string_view line) {
    line = without_leading_blanks(line);
    return line.empty() || line.front() != '#' ? std::string_view() : without_leading_blanks(line.substr(1));
}

bool starts_with_word(std::string_view text, std::string_view word) {
    if (text.substr(0, word.size()) != word) {
        return false;
    }
    return text.size() == word.size() ||
           std::string_view(" \t\r\"<(/").find(text[word.size()]) != std::string_view::npos;
}

/// The name in `include "name"`; empty for any other directive.
std::string_view included_name(std::string_view text) {
    if (!starts_with_word(text, "include")) {
        return {};
    }
    text = without_leading_blanks(text.substr(7));
    if (text.empty() || text.front() != '"') {
        return {};
    }
    const auto end = text.find('"', 1);
    return end == std::string_view::npos ? std::string_view() : text.substr(1, end - 1);
}

bool is_pragma_once(std::string_view text) {
    return starts_with_word(text, "pragma") && starts_with_word(without_leading_blanks(text.substr(6)), "once");
}

/// Whether a block comment is open at the end of `line`, if one was (`open`) at its start.
bool comment_open_after(std::string_view line, bool open) {
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const std::string_view two = line.substr(i, 2);
        if (open) {
            if (two == "*/") {
                open = false;
                ++i;
            }
        } else if (quoted) {
            if (line[i] == '\\') {
                ++i;
            } else if (line[i] == '"') {
                quoted = false;
            }
        } else if (two == "//") {
            return false;
        } else if (two == "/*") {
            open = true;
            ++i;
        } else if (line[i] == '"') {
            quoted = true;
        }
    }
    return open;
}

std::string line_directive(std::size_t number, std::string_view path) {
    std::string quoted;
    for (const char c : path) {
        if (c == '"' || c == '\\') {
            quoted += '\\';
        }
        quoted += c;
    }
    return fmt::format("#line {} \"{}\"\n", number, quoted);
}

struct SourceText {
    const std::string* text = nullptr;
    const std::string* path = nullptr;
};

/// One expansion in progress. A file counts as seen only where it was included unconditionally; what stands under an
/// #if is expanded again at its next place, and a guard macro keeps the compiler from seeing it twice.
class Expansion {
  public:
    explicit Expansion(std::map<std::string, SourceText, std::less<>> files) : files_(std::move(files)) {}

    std::string run(const std::string& main) {
        add_file(main, false);
        return std::move(result_);
    }

  private:
    void add_file(const std::string& name, bool conditional) {
        const SourceText source = files_.at(name);
        open_.push_back(name);
        if (!conditional) {
            seen_.insert(name);
        }
        const auto guard = std::distance(files_.begin(), files_.find(name));
        result_ += fmt::format("#ifndef CLSHADE_ONCE_{0}\n#define CLSHADE_ONCE_{0}\n", guard);
        result_ += line_directive(1, *source.path);

        std::string_view rest = *source.text;
        int depth = 0; // of #if ... #endif
        bool in_comment = false;
        for (std::size_t number = 1; !rest.empty(); ++number) {
            const auto end = rest.find('\n');
            const std::string_view line = rest.substr(0, end);
            rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
            add_line(line, number, source, in_comment, conditional || depth > 0);
            if (!in_comment) {
                depth += depth_change(directive(line));
            }
            in_comment = comment_open_after(line, in_comment);
            if (result_.size() > expanded_limit) {
                throw RuntimeFailure(
                    fmt::format("{}:{}: #include lines expand without end; remove the circle", *source.path, number));
            }
        }
        result_ += "#endif\n";
        open_.pop_back();
    }

    void add_line(std::string_view line, std::size_t number, const SourceText& source, bool in_comment,
                  bool conditional) {
        const std::string_view text = in_comment ? std::string_view() : directive(line);
        const std::string name(included_name(text));
        if (name.empty()) {
            if (!is_pragma_once(text)) {
                result_ += line;
            }
            result_ += '\n';
            return;
        }
        if (files_.find(name) == files_.end()) {
            throw RuntimeFailure(missing(name, number, *source.path));
        }
        const bool circle = std::find(open_.begin(), open_.end(), name) != open_.end();
        if (!circle && seen_.count(name) == 0) {
            add_file(name, conditional);
        }
        result_ += line_directive(number + 1, *source.path);
    }

    static int depth_change(std::string_view text) {
        if (text.substr(0, 2) == "if") {
            return 1;
        }
        return starts_with_word(text, "endif") ? -1 : 0;
    }

    [[nodiscard]] std::string missing(std::string_view name, std::size_t number, std::string_view path) const {
        std::vector<std::string_view> names;
        for (const auto& [known, unused] : files_) {
            names.push_back(known);
        }
        return fmt::format("{}:{}: no kernel source \"{}\" to include; there are: {}", path, number, name,
                           fmt::join(names, ", "));
    }

    std::map<std::string, SourceText, std::less<>> files_;
    std::vector<std::string> open_; ///< files being expanded, outermost first
    std::set<std::string> seen_;
    std::string result_;
};

} // namespace

void SourceSet::add(const std::string& name, std::string text, const std::string& path) {
    files_[name] = {std::move(text), path.empty() ? name : path};
}

void SourceSet::override_from(const std::filesystem::path& folder) {
    std::error_code failed;
    if (!std::filesystem::is_directory(folder, failed)) {
        throw UsageError(fmt::format("{}: no such folder of kernels; see --kernel-dir", folder.string()));
    }
    std::map<std::string, std::filesystem::path> found;
    bool replaces = false;
    std::filesystem::directory_iterator entry(folder, failed);
    for (; !failed && entry != std::filesystem::directory_iterator(); entry.increment(failed)) {
        const std::filesystem::path& path = entry->path();
        std::error_code unreadable;
        const bool source = path.extension() == ".cl" || path.extension() == ".h";
        if (!source || !entry->is_regular_file(unreadable)) {
            continue;
        }
        found[path.filename().string()] = path;
        replaces = replaces || contains(path.filename().string());
    }
    if (failed) {
        throw UsageError(fmt::format("{}: cannot be read: {}", folder.string(), failed.message()));
    }
    if (!replaces) {
        throw UsageError(fmt::format("{}: holds none of the kernel files {}; see --kernel-dir", folder.string(),
                                     fmt::join(names(), ", ")));
    }
    for (const auto& [name, path] : found) {
        auto text = read_whole_file(path);
        if (!text) {
            throw UsageError(fmt::format("{}: cannot be read", path.string()));
        }
        add(name, std::move(*text), path.string());
    }
}

bool SourceSet::contains(std::string_view name) const {
    return files_.find(name) != files_.end();
}

const std::string& SourceSet::text(std::string_view name) const {
    const auto found = files_.find(name);
    if (found == files_.end()) {
        throw RuntimeFailure(fmt::format("no kernel source \"{}\"", name));
    }
    return found->second.text;
}

std::vector<std::string> SourceSet::names() const {
    std::vector<std::string> result;
    for (const auto& [name, unused] : files_) {
        result.push_back(name);
    }
    return result;
}

std::string SourceSet::expand(const std::string& main) const {
    if (!contains(main)) {
        throw RuntimeFailure(fmt::format("no kernel source \"{}\"; there are: {}", main, fmt::join(names(), ", ")));
    }
    std::map<std::string, SourceText, std::less<>> files;
    for (const auto& [name, file] : files_) {
        files[name] = {&file.text, &file.path};
    }
    return Expansion(std::move(files)).run(main);
}

} // namespace clshade
