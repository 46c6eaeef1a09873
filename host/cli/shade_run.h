// A run over many frames: what is told of each, the report, the exit code.
#pragma once

#include "host/batch/batch.h"
#include "host/cli/kernel_dump.h"
#include "host/cli/options.h"
#include "host/cli/progress.h"
#include "host/cli/report_json.h"
#include "host/cli/run_resources.h"
#include "host/cli/run_stats.h"
#include "host/cli/session.h"
#include "host/cli/signals.h"

#include <set>
#include <string>
#include <vector>

namespace clshade::cli {

/// How a run behaves beyond its settings.
struct ShadeRunOptions {
    bool skip_bad_frames = false;
    bool tell_frames = true; ///< a line on stdout for each
    std::string dump_kernel; ///< folder; empty: none
};

/// Settings that follow from the common flags: threads, memory, the sources of -u beside a frame's own.
[[nodiscard]] BatchSettings batch_settings(const CommonOptions& options);

class ShadeRun final : private BatchListener {
  public:
    /// Refers to all but the last argument.
    ShadeRun(const CommonOptions& common, const RunScene& scene, const BatchSettings& settings, Session& session,
             Progress& progress, JsonReport& report, ShadeRunOptions options);

    /// Shades the jobs, reports each and the totals. Returns the exit code; throws what fails the whole run.
    [[nodiscard]] ExitCode run(const std::vector<FrameJob>& jobs);
    [[nodiscard]] const RunStats& stats() const { return stats_; }

  private:
    void finished(const FrameJob& job, const FrameOutcome& outcome) override;
    bool failed(const FrameJob& job, const std::exception_ptr& failure) override;
    void doing(const FrameJob& job, const std::string& what) override;
    [[nodiscard]] bool interrupted() const override { return stop_.requested(); }

    [[nodiscard]] bool goes_on_after(const FrameJob& job, const Error& error);
    void tell(const FrameJob& job, const FrameOutcome& outcome);
    [[nodiscard]] std::string times_text(const FrameOutcome& outcome) const;
    [[nodiscard]] ExitCode result() const;

    const CommonOptions& common_;
    const RunScene& scene_;
    const BatchSettings& settings_;
    Session& session_;
    Progress& progress_;
    JsonReport& report_;
    ShadeRunOptions options_;
    KernelDump dump_;
    RunResources resources_;
    GracefulStop stop_;
    RunStats stats_;
    std::size_t jobs_ = 0;
    std::size_t finished_ = 0;
    std::vector<std::string> failures_; ///< frames, in words
    std::size_t skipped_bad_ = 0;
    std::set<std::string> told_; ///< warnings
    std::size_t repeated_ = 0;
    ExitCode first_failure_ = ExitCode::ok;
};

} // namespace clshade::cli
