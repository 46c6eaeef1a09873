#include "host/cli/progress.h"

#include <fmt/format.h>
#include <spdlog/sinks/sink.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

namespace clshade::cli {

namespace {

constexpr double draws_per_second = 20.0;
constexpr double draws_at_once = 5.0; // so that short phases in quick succession are all seen

ProgressMode resolved(const CommonOptions& options) {
    if (options.progress != ProgressMode::automatic) {
        return options.progress;
    }
    return isatty(STDERR_FILENO) == 1 && !options.quiet ? ProgressMode::bar : ProgressMode::none;
}

std::size_t terminal_width() {
    constexpr std::size_t usual = 80;
    winsize size{};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : usual;
}

void print_line(const std::string& head, const std::string& text) {
    fmt::print("{}{}\n", head, one_line_of(text, text.size()));
    std::fflush(stdout);
}

// A flag that holds while this lives.
class Raised {
  public:
    explicit Raised(bool& flag) : flag_(flag) { flag_ = true; }
    ~Raised() { flag_ = false; }
    Raised(const Raised&) = delete;
    Raised& operator=(const Raised&) = delete;
    Raised(Raised&&) = delete;
    Raised& operator=(Raised&&) = delete;

  private:
    bool& flag_;
};

// Lines that go round the bar, on their way to where they went before.
class RoundTheBar final : public spdlog::sinks::sink {
  public:
    RoundTheBar(Progress& progress, std::vector<spdlog::sink_ptr> targets)
        : progress_(progress), targets_(std::move(targets)) {}

    void log(const spdlog::details::log_msg& message) override {
        progress_.print([&] {
            for (const spdlog::sink_ptr& target : targets_) {
                if (target->should_log(message.level)) {
                    target->log(message);
                }
            }
        });
    }
    void flush() override {
        for (const spdlog::sink_ptr& target : targets_) {
            target->flush();
        }
    }
    void set_pattern(const std::string& pattern) override {
        for (const spdlog::sink_ptr& target : targets_) {
            target->set_pattern(pattern);
        }
    }
    void set_formatter(std::unique_ptr<spdlog::formatter> formatter) override {
        for (const spdlog::sink_ptr& target : targets_) {
            target->set_formatter(formatter->clone());
        }
    }

  private:
    Progress& progress_;
    std::vector<spdlog::sink_ptr> targets_;
};

} // namespace

// While it lives, the log goes round the bar.
class Progress::LogDetour {
  public:
    explicit LogDetour(Progress& progress)
        : logger_(spdlog::default_logger()), sinks_(logger_ ? logger_->sinks() : std::vector<spdlog::sink_ptr>()) {
        if (logger_) {
            logger_->sinks() = {std::make_shared<RoundTheBar>(progress, sinks_)};
        }
    }
    ~LogDetour() {
        if (logger_) {
            logger_->sinks() = std::move(sinks_);
        }
    }
    LogDetour(const LogDetour&) = delete;
    LogDetour& operator=(const LogDetour&) = delete;
    LogDetour(LogDetour&&) = delete;
    LogDetour& operator=(LogDetour&&) = delete;

  private:
    std::shared_ptr<spdlog::logger> logger_;
    std::vector<spdlog::sink_ptr> sinks_;
};

Progress::Progress(const CommonOptions& options, int total, Steps steps)
    : mode_(resolved(options)), total_(std::max(total, 1)), steps_(steps), draws_allowed_(draws_at_once) {
    if (mode_ == ProgressMode::bar) {
        detour_ = std::make_unique<LogDetour>(*this);
    }
}

Progress::~Progress() {
    clear();
}

double Progress::now() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

ProgressState Progress::state() const {
    return {done_, total_, percent_of(position_, total_), rate_.at(now()), steps_ == Steps::frames, what_, slowest_};
}

void Progress::update(const std::string& what, double part) {
    const std::lock_guard lock(mutex_);
    const bool is_new = what != what_;
    what_ = what;
    advance(std::min(done_ + std::clamp(part, 0.0, 1.0), static_cast<double>(total_)), is_new);
}

void Progress::step() {
    finish_step(true);
}

void Progress::skip() {
    finish_step(false);
}

void Progress::finish_step(bool worked) {
    const std::lock_guard lock(mutex_);
    done_ = std::min(done_ + 1, total_);
    if (worked) {
        rate_.frame(now());
    } else {
        rate_.restart(now());
    }
    advance(done_, false);
    if (mode_ == ProgressMode::plain) {
        ProgressState told = state();
        told.percent = percent_of(done_, total_); // of what the line counts
        print_line("progress: ", progress_words(told));
    }
}

void Progress::set_slowest(std::string stage) {
    const std::lock_guard lock(mutex_);
    slowest_ = std::move(stage); // seen with the next step
}

// What is being done is told while nothing else can be: in jobs of one step, and before the first is done, when kernels
// are built.
void Progress::advance(double position, bool what_is_new) {
    position_ = std::max(position_, position);
    const bool of_interest = what_is_new && (total_ == 1 || done_ == 0);
    if (mode_ == ProgressMode::bar) {
        if (!printing_ && (may_draw() || of_interest)) {
            draw();
        }
    } else if (mode_ == ProgressMode::openjd || mode_ == ProgressMode::alf) {
        tell_farm(of_interest);
    }
}

bool Progress::may_draw() {
    const double time = now();
    draws_allowed_ = std::min(draws_at_once, draws_allowed_ + (time - draws_counted_at_) * draws_per_second);
    draws_counted_at_ = time;
    if (draws_allowed_ < 1.0) {
        return false;
    }
    draws_allowed_ -= 1.0;
    return true;
}

void Progress::draw() {
    // One column stays free: some terminals go to the next line after the last.
    fmt::print(stderr, "\r\033[K{}", bar_line(state(), terminal_width() - 1));
    std::fflush(stderr);
    bar_shown_ = true;
}

void Progress::tell_farm(bool what_is_new) {
    const ProgressState told = state();
    const bool further = told.percent > last_percent_;
    last_percent_ = std::max(told.percent, last_percent_);
    if (mode_ == ProgressMode::alf) {
        if (further) {
            print_line(fmt::format("ALF_PROGRESS {}%", told.percent), "");
        }
        return;
    }
    if (what_is_new) {
        print_line("openjd_status: ", what_);
    }
    if (further) {
        print_line("openjd_progress: ", std::to_string(told.percent));
    }
    if (further && total_ > 1 && done_ > 0) {
        print_line("openjd_status: ", progress_words(told));
    }
}

void Progress::clear() {
    const std::lock_guard lock(mutex_);
    if (bar_shown_) {
        fmt::print(stderr, "\r\033[K");
        std::fflush(stderr);
        bar_shown_ = false;
    }
}

void Progress::print(const std::function<void()>& lines) {
    const std::lock_guard lock(mutex_);
    if (mode_ != ProgressMode::bar || printing_) {
        lines();
        return;
    }
    const bool shown = bar_shown_;
    clear();
    printing_ = true;
    const Raised raised(printing_);
    lines();
    std::fflush(stdout); // before the bar is there again
    if (shown) {
        draw();
    }
}

void Progress::fail(const std::string& reason) {
    const std::lock_guard lock(mutex_);
    clear();
    if (mode_ == ProgressMode::openjd) {
        print_line("openjd_fail: ", reason);
    }
}

} // namespace clshade::cli
