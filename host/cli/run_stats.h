// Where the time of a run went (--runstats, -v, JSON).
#pragma once

#include "host/base/stage_times.h"
#include "host/batch/frame_outcome.h"
#include "host/shading/shader.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace clshade::cli {

/// {"read": 1.5, ..., "total": 20.0}
[[nodiscard]] nlohmann::json stages_json(const StageTimes& stages);

/// Sums of a whole run. For one thread at a time.
class RunStats {
  public:
    /// A frame of a batch. Of skipped ones only the number counts.
    void add(const clshade::FrameOutcome& outcome);
    /// A step of another verb.
    void add(const StageTimes& stages);
    void add(const std::vector<KernelTime>& kernels);
    /// The whole run took `wall_milliseconds`, on `threads` threads.
    void finish(double wall_milliseconds, int threads);

    /// Tables of stages and kernels, then lines: of a finished run frames, wall time, bytes, the kernels' share and the
    /// ratio to decoding and encoding alone; of any the peak memory of the process.
    [[nodiscard]] std::string text() const;
    /// {"frames", "skipped", "stage_ms", "kernel_ms", "bytes_read", "bytes_written", "peak_memory"} and of a finished
    /// run "wall_ms", "threads", "fps", "kernel_share", "decode_encode_ms", "ratio". Milliseconds, bytes; null for what
    /// cannot be told.
    [[nodiscard]] nlohmann::json json() const;
    /// The one of "read", "shade" and "write" that took longest so far; empty before there is any.
    [[nodiscard]] std::string slowest_stage() const;

  private:
    struct KernelSum {
        int launches = 0;
        double milliseconds = 0.0;
        double bytes = 0.0;
    };

    [[nodiscard]] double kernel_milliseconds() const;
    /// Wall time that decoding and encoding alone would take if they kept all threads busy.
    [[nodiscard]] double decode_encode_milliseconds() const;
    [[nodiscard]] std::string stage_table() const;
    [[nodiscard]] std::string kernel_table() const;
    [[nodiscard]] std::string run_lines() const;

    StageTimes stages_;
    int frames_ = 0;
    int skipped_ = 0;
    std::map<std::string, KernelSum> kernels_;
    double busy_milliseconds_ = 0.0;
    std::uint64_t bytes_read_ = 0;
    std::uint64_t bytes_written_ = 0;
    double wall_milliseconds_ = 0.0; ///< 0: the run is not finished
    int threads_ = 1;
};

/// Largest resident memory of this process so far, in bytes.
[[nodiscard]] double peak_memory();

} // namespace clshade::cli
