// Progress for people and for farms.
#pragma once

#include "host/cli/options.h"

#include <string>

namespace clshade::cli {

/// Tells how far a job of `total` equal steps has come. Every line is flushed at once.
///   bar     one line on stderr, redrawn, removed at the end
///   plain   a line on stdout per finished step: "progress: 3 of 10 (30 %)"
///   openjd  "openjd_progress: 30", "openjd_status: text", "openjd_fail: text" on stdout
///   alf     "ALF_PROGRESS 30%" on stdout
///   auto    bar if stderr is a terminal and --quiet is not given, else none
class Progress {
  public:
    Progress(const CommonOptions& options, int total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    Progress(Progress&&) = delete;
    Progress& operator=(Progress&&) = delete;

    /// What is being done, and how much of the current step is done (0..1).
    void update(const std::string& what, double part = 0.0);
    /// The current step is done.
    void step();
    /// Clears the bar before other output.
    void clear();
    /// Tells the farm why the job failed.
    void fail(const std::string& reason);

  private:
    void show(double part);
    [[nodiscard]] int percent(double part) const;

    ProgressMode mode_;
    int total_;
    int done_ = 0;
    int last_percent_ = -1;
    bool bar_shown_ = false;
    std::string what_;
};

} // namespace clshade::cli
