#include "host/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace clshade::cli {

namespace {

constexpr int bar_cells = 30;
constexpr std::size_t most_text = 60;

ProgressMode resolved(const CommonOptions& options) {
    if (options.progress != ProgressMode::automatic) {
        return options.progress;
    }
    return isatty(STDERR_FILENO) == 1 && !options.quiet ? ProgressMode::bar : ProgressMode::none;
}

void print_line(const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
}

} // namespace

Progress::Progress(const CommonOptions& options, int total) : mode_(resolved(options)), total_(std::max(total, 1)) {}

Progress::~Progress() {
    clear();
}

int Progress::percent(double part) const {
    return std::clamp(static_cast<int>(100.0 * (done_ + part) / total_), 0, 100);
}

void Progress::update(const std::string& what, double part) {
    if (mode_ == ProgressMode::openjd && what != what_) {
        print_line("openjd_status: " + what);
    }
    what_ = what;
    show(part);
}

void Progress::step() {
    done_ = std::min(done_ + 1, total_);
    show(0.0);
    if (mode_ == ProgressMode::plain) {
        print_line(fmt::format("progress: {} of {} ({} %)", done_, total_, percent(0.0)));
    }
}

void Progress::show(double part) {
    const int now = percent(part);
    if (mode_ == ProgressMode::bar) {
        const int cells = bar_cells * now / 100;
        std::string text = what_.substr(0, most_text);
        fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {:3} % {}", "", cells, "", bar_cells - cells, now, text);
        std::fflush(stderr);
        bar_shown_ = true;
    } else if (now != last_percent_ && mode_ == ProgressMode::openjd) {
        print_line(fmt::format("openjd_progress: {}", now));
    } else if (now != last_percent_ && mode_ == ProgressMode::alf) {
        print_line(fmt::format("ALF_PROGRESS {}%", now));
    }
    last_percent_ = now;
}

void Progress::clear() {
    if (bar_shown_) {
        fmt::print(stderr, "\r\033[K");
        std::fflush(stderr);
        bar_shown_ = false;
    }
}

void Progress::fail(const std::string& reason) {
    clear();
    if (mode_ == ProgressMode::openjd) {
        print_line("openjd_fail: " + reason);
    }
}

} // namespace clshade::cli
