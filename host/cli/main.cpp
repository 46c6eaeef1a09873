// clshade: the one place that catches errors, prints them and turns them into exit codes.
#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/cli/help.h"
#include "host/cli/signals.h"
#include "host/cli/verb.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

namespace clshade::cli {

namespace {

void log_to_stderr() {
    auto logger = std::make_shared<spdlog::logger>("clshade", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    logger->set_pattern("clshade: %l: %v");
    logger->set_level(spdlog::level::warn);
    spdlog::set_default_logger(std::move(logger));
}

// Codecs take and give back megabytes for every block of a picture: memory that the process keeps need not be cleared
// by the system again and again (2 to 6 % of a sequence).
void keep_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_TOP_PAD, 16 << 20);
#endif
}

// Flags nobody declared, and arguments too many.
void refuse_extras(const CLI::App& app, const Verb& verb) {
    const std::vector<std::string> extras = app.remaining();
    if (extras.empty()) {
        return;
    }
    // A misspelt flag leaves its value behind as well; the flag is what to tell.
    for (const std::string& extra : extras) {
        if (extra.size() < 2 || extra.front() != '-') {
            continue;
        }
        const std::string word = extra.substr(0, extra.find('='));
        std::vector<std::string> flags;
        for (const CLI::Option* option : app.get_options()) {
            for (const std::string& name : option->get_lnames()) {
                flags.push_back("--" + name);
            }
        }
        throw UsageError(
            fmt::format("unknown flag '{}'{}; see `clshade help {}`", word, did_you_mean(word, flags), verb.name));
    }
    throw UsageError(fmt::format("'{}' is one argument too many; see `clshade help {}`", extras.front(), verb.name));
}

// CLI11's own complaints on one line.
std::string one_line(std::string text) {
    while (!text.empty() && text.back() == '\n') {
        text.pop_back();
    }
    for (char& c : text) {
        c = c == '\n' ? ' ' : c;
    }
    return text;
}

ExitCode run_verb(const Verb& verb, std::vector<std::string> arguments) {
    CLI::App app;
    app.allow_extras();
    const Action action = verb.declare(app);
    try {
        std::vector<std::string> reversed(arguments.rbegin(), arguments.rend()); // as CLI11 wants them
        app.parse(std::move(reversed));
    } catch (const CLI::CallForHelp&) {
        fmt::print("{}", help_page(verb, app));
        return ExitCode::ok;
    } catch (const CLI::ParseError& error) {
        throw UsageError(fmt::format("{}; see `clshade help {}`", one_line(error.what()), verb.name));
    }
    refuse_extras(app, verb);
    return action();
}

ExitCode print_help(const std::vector<std::string>& topics) {
    if (topics.empty()) {
        fmt::print("{}", overview());
        return ExitCode::ok;
    }
    const Verb& verb = find_verb(topics.front());
    CLI::App app;
    const Action unused = verb.declare(app); // its flags' storage
    fmt::print("{}", help_page(verb, app));
    return ExitCode::ok;
}

ExitCode run(std::vector<std::string> arguments) {
    if (arguments.empty()) {
        return print_help({});
    }
    const std::string word = arguments.front();
    arguments.erase(arguments.begin());
    if (word == "help" || word == "--help" || word == "-h") {
        return print_help(arguments);
    }
    if (word == "--version" || word == "version") {
        fmt::print("clshade {}\n", CLSHADE_VERSION);
        return ExitCode::ok;
    }
    if (word.starts_with('-')) {
        throw UsageError(
            fmt::format("'{}' stands before the verb; write `clshade VERB [flags]`, see `clshade help`", word));
    }
    return run_verb(find_verb(word), std::move(arguments));
}

// Whether everything printed has arrived: a report on a full disk must not look like success.
ExitCode flushed(ExitCode code) {
    if (std::fflush(stdout) != 0 && code == ExitCode::ok) {
        throw RuntimeFailure("cannot write to standard output");
    }
    return code;
}

ExitCode report(const char* message, ExitCode code) {
    std::fflush(stdout);
    const std::string line = fmt::format("clshade: {}\n", one_line(message));
    std::fputs(line.c_str(), stderr); // never throws; if nobody can be told, the exit code still tells
    return code;
}

ExitCode guarded(std::vector<std::string> arguments) {
    try {
        return flushed(run(std::move(arguments)));
    } catch (const Error& error) {
        return report(error.what(), error.exit_code());
    } catch (const std::bad_alloc&) {
        return report("out of memory", ExitCode::runtime_failure);
    } catch (const std::exception& error) {
        return report(error.what(), ExitCode::runtime_failure);
    }
}

} // namespace

} // namespace clshade::cli

int main(int argc, char** argv) {
    clshade::cli::keep_freed_memory();
    clshade::cli::log_to_stderr();
    clshade::cli::install_signal_handlers();
    return static_cast<int>(clshade::cli::guarded({argv + 1, argv + argc}));
}
