// Progress for people and for farms.
#pragma once

#include "host/cli/options.h"
#include "host/cli/progress_text.h"

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace clshade::cli {

/// What the steps of a job are: only frames have a rate that means something to people.
enum class Steps { frames, other };

/// Tells how far a job of `total` equal steps has come. Every line is flushed at once. Any thread may call anything.
///   bar     one line on stderr, redrawn at most some 20 times a second, removed at the end. Log lines (spdlog's
///   default
///           logger) go round it while it lives; what else is printed goes through print() or follows clear()
///   plain   a line on stdout per finished step: "progress: 185 of 500 (37 %), 8.3 fps, 0:38 left"
///   openjd  "openjd_progress: 37", "openjd_status: text", "openjd_fail: text" on stdout
///   alf     "ALF_PROGRESS 37%" on stdout
///   auto    bar if stderr is a terminal and --quiet is not given, else none
/// openjd and alf speak when the whole percent has grown; it never falls.
class Progress {
  public:
    Progress(const CommonOptions& options, int total, Steps steps = Steps::frames);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    Progress(Progress&&) = delete;
    Progress& operator=(Progress&&) = delete;

    /// What is being done, and how much of the current step is done (0..1).
    void update(const std::string& what, double part = 0.0);
    /// A step is done.
    void step();
    /// A step is over without work: skipped or failed. Counts as done, not for frames per second.
    void skip();
    /// The stage that takes longest so far, for the bar.
    void set_slowest(std::string stage);
    /// Removes the bar before other output. The next of the calls above draws it again.
    void clear();
    /// Runs `lines`, which prints to stdout or stderr, without the bar in its way. Other threads' progress waits.
    void print(const std::function<void()>& lines);
    /// Tells the farm why the job, or a frame of it, failed.
    void fail(const std::string& reason);

  private:
    class LogDetour;

    [[nodiscard]] double now() const; ///< seconds since the start
    [[nodiscard]] ProgressState state() const;
    void finish_step(bool worked);
    void advance(double position, bool what_is_new);
    void draw();
    [[nodiscard]] bool may_draw();
    void tell_farm(bool what_is_new);

    std::recursive_mutex mutex_; ///< recursive: lines printed through print() may be log lines, which take it as well
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    ProgressMode mode_;
    int total_;
    Steps steps_;
    int done_ = 0;
    double position_ = 0.0; ///< steps and parts of them; never falls
    int last_percent_ = -1;
    FrameRate rate_{0.0};
    std::string what_;
    std::string slowest_;
    bool bar_shown_ = false;
    bool printing_ = false;
    double draws_allowed_;
    double draws_counted_at_ = 0.0;
    std::unique_ptr<LogDetour> detour_;
};

} // namespace clshade::cli
