// `clshade bench`: every kernel timed with the limit and the rivals beside it, in one process and in turns.
//
// METHOD. All contestants of one picture size (our kernels, the streams, the C++ rivals) read the same planes, write to
// the same memory (from buffer to buffer the time of one and the same kernel differs by up to 7 %) and run in turns,
// each round in a new order, first two warm-up rounds, then at least BenchOptions::rounds rounds and until the time
// budget is spent. Absolute times drift with the machine, so a ratio is taken inside each round and the median of these
// paired ratios is what counts. OpenCL kernels are timed on the device (event profiling), C++ rivals by a steady clock
// around the call on the host: they pay their thread start, and no launch. Contestants that take over ten times as long
// as the kernel they stand against (naive, reference) run in fewer rounds; their ratio is the median over those. Before
// anything is timed, every rival's picture is compared with the device's: one that computes something else is an error.
#pragma once

#include "host/device/device.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

enum class BenchStatus { ok, skipped, unsupported, error };
/// As in the JSON report: "ok", "skipped", "unsupported", "error".
[[nodiscard]] std::string_view name_of(BenchStatus status);

/// One rival of one row. Names: "stream_opencl" (same bytes through a kernel), "stream_cpp" (same bytes through C++
/// non-temporal stores), "openmp_simd" (the compiler's vectorised C++ loop), "hand_simd" (hand-vectorised C++),
/// "naive_opencl" (image2d_t and pow), "reference" (scalar double precision, one thread), the key of another row that
/// this one is measured against, or "mean_alone" (of rows with several materials: the mean of kernels that shade the
/// whole picture with one of them, taken inside each round). Of whole runs (batch_bench.h): "decode_encode" (the same
/// files decoded and encoded by OpenEXR, nothing computed), "oiio" (a straightforward OpenImageIO program).
struct RivalResult {
    std::string name;
    std::string note; ///< which of several ways it goes; empty for most
    BenchStatus status = BenchStatus::ok;
    std::string reason; ///< why not, unless ok
    double median_ms = 0.0;
    double min_ms = 0.0;
    double ratio = 0.0; ///< median over the rounds of (row's kernel time / rival's time): below 1 the kernel wins
    /// Largest difference of the rival's picture from the device's, relative to 1e-3 + value; of a pre-filter as
    /// BenchResult::max_error.
    double max_error = 0.0;
    int rounds = 0;
};

/// Of a whole run, from files to files; sizes are those of the files, per frame.
struct BatchFigures {
    int frames = 0; ///< of one turn
    double frames_per_second = 0.0;
    double bytes_read = 0.0;
    double bytes_written = 0.0;
    double rival_bytes_written = 0.0; ///< by the library, of the same picture; 0: no rival
};

/// One row of the table: one kernel at one size; or pre-filtering one environment (prefilter_bench.h); or a whole run,
/// whose times are those of a frame (batch_bench.h).
struct BenchResult {
    std::string key; ///< stable: "shade.blinn_phong.lambert.distant1.3840x2160", "prefilter.1024x512"; JSON `kernel`
    BenchStatus status = BenchStatus::ok;
    std::string reason; ///< why not, unless ok
    int width = 0;
    int height = 0;
    int lights = 0;
    int environments = 0;
    int layers = 1; ///< of the deepest stack
    int lanes = 0;
    int rounds = 0;
    double median_ms = 0.0;
    double min_ms = 0.0;
    double spread = 0.0;          ///< (90th - 10th percentile) / median
    double bytes_per_pixel = 0.0; ///< planes read and written, each once
    double mpix_per_s = 0.0;
    double gb_per_s = 0.0; ///< 1e9 bytes per second, from bytes_per_pixel
    /// From the frame to the end of a first launch over 64x64 pixels, into an empty binary cache. Not the first build
    /// of the process, which loads the driver's compiler too: one that is thrown away goes before all rows.
    double build_cold_ms = 0.0;
    double build_cached_ms = 0.0; ///< the same from that cache
    /// Of a pre-filter: largest relative error at sampled vertices, against the reference's sums in double precision.
    std::optional<double> max_error;
    std::optional<BatchFigures> batch; ///< of a whole run
    std::vector<RivalResult> against;
};

/// A row of the deck's tables (models.md section 13) beside our own; one for every size it was timed at.
struct DeckRow {
    std::string name;     ///< "Blinn-Oren-Nayar, one light"
    std::string baseline; ///< "Blinn-Lambert, one light"
    double deck_ratio = 1.0;
    BenchStatus status = BenchStatus::ok;
    std::string reason;
    int width = 0; ///< 0 unless ok
    int height = 0;
    double median_ms = 0.0;      ///< ours
    std::optional<double> ratio; ///< ours, paired by rounds; only if ok
};

/// How time grows with the layers of a stack: Lambert under 0, 1, 3 and 7 coats that absorb.
struct LayerGrowth {
    int width = 0;
    int height = 0;
    int layers = 1;
    double median_ms = 0.0;
    double ratio = 1.0;     ///< to the single layer, paired by rounds
    double per_layer = 0.0; ///< (ratio - 1) / (layers - 1): what each further layer costs, in single layers; 0 for one
};

/// The deck's heaviest row at the deck's size: on its console's GPU, and here.
struct BenchHeadline {
    std::string key; ///< of our row
    double deck_ms = 0.0;
    double median_ms = 0.0;
};

/// A limit of speed, on one paired ratio or one time.
struct SpeedLimit {
    std::string name;
    bool in_milliseconds = false; ///< else a ratio
    double limit = 0.0;
    double value = 0.0;

    [[nodiscard]] bool met() const { return value <= limit; }
};

struct BenchReport {
    std::vector<BenchResult> results;
    std::vector<DeckRow> deck;
    std::vector<LayerGrowth> layers; ///< sizes together, shallow first; only what was timed
    std::optional<BenchHeadline> headline;
    std::vector<SpeedLimit> limits; ///< only on what was timed, at the deck's size
};

struct BenchOptions {
    /// Regular expression (ECMAScript) searched in the key; empty: every row. Rows of whole runs take part only where
    /// it has the word "batch": they take minutes and write gigabytes.
    std::string filter;
    int width = 0; ///< 0: each row's own size; else every row of shading at this size
    int height = 0;
    int rounds = 15;      ///< at least this many rounds
    double seconds = 1.5; ///< time budget per row; a group of rows that run in turns has the sum
    std::uint64_t seed = 1;
    int threads = 0; ///< of the C++ rivals; 0: as many as the device has compute units
    int lanes = 0;   ///< 1, 4, 8, 16; 0: the best known for the device
    std::filesystem::path kernel_dir;
    bool quick = false; ///< small pictures, three rounds, no 3840x2160: to see that everything runs
};

/// Told before each step: what is being done, and how many of the steps are done.
using BenchProgress = std::function<void(const std::string& what, int done, int total)>;

/// Keys of all rows that the options choose, in the order of the report. Throws UsageError for a filter that is not a
/// regular expression.
[[nodiscard]] std::vector<std::string> benchmark_keys(const BenchOptions& options);

/// Runs the rows. A row that fails has status error and the reason; the others run on. Throws UsageError for a bad
/// filter, or one that no key matches (naming the keys).
[[nodiscard]] BenchReport run_benchmarks(Device& device, const BenchOptions& options,
                                         const BenchProgress& progress = {});

struct LaneTime {
    int lanes = 1;
    BenchStatus status = BenchStatus::ok;
    std::string reason;
    double median_ms = 0.0; ///< one light and eight lights together
};

struct LaneTuning {
    int best = 1;                ///< the width with the smallest sum of paired ratios over the tuning rows
    std::vector<LaneTime> times; ///< 1, 4, 8, 16 lanes
};

/// Measures the vector widths on the one-light and the eight-light kernel at 1280x720 (options.width x height if
/// given). Throws RuntimeFailure if no width builds.
[[nodiscard]] LaneTuning tune_lanes(Device& device, const BenchOptions& options = {},
                                    const BenchProgress& progress = {});

} // namespace clshade
