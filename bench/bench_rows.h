// The rows of the table: what is timed, at which size, against whom.
#pragma once

#include "bench/bench_frame.h"
#include "bench/benchmark.h"

#include <string>
#include <string_view>
#include <vector>

namespace clshade {

enum class Rival { stream_opencl, stream_cpp, openmp_simd, hand_simd, naive_opencl, reference };
/// As in RivalResult::name.
[[nodiscard]] std::string_view name_of(Rival rival);

/// Other kernels that a row is measured against: one, or the mean of several taken inside each round.
struct BenchBaseline {
    std::string name; ///< as in RivalResult::name; empty for one kernel: its key
    std::vector<BenchScene> scenes;
};

/// Name of the baseline of rows with several materials.
inline constexpr std::string_view mean_alone = "mean_alone";

struct BenchRow {
    std::string name; ///< "shade.blinn_phong.lambert.distant1"
    int width = 0;
    int height = 0;
    BenchScene scene;
    std::vector<Rival> rivals;
    std::vector<BenchBaseline> baselines;

    /// "shade.blinn_phong.lambert.distant1.1280x720"
    [[nodiscard]] std::string key() const;
};

inline constexpr int deck_width = 1280; ///< the deck's own picture size
inline constexpr int deck_height = 720;

/// "shade.blinn_phong.lambert.distant1"; with a variant "shade.blinn_phong.lambert.constant_f0.distant1"; several
/// materials: "shade.mixed4.tiles.distant1"; in the studio "environment" or "distant1_environment" at the end.
[[nodiscard]] std::string row_name(const BenchScene& scene);

/// The one-light Lambert kernel that others are measured against.
[[nodiscard]] BenchRow lambert_row(int width, int height);

/// All rows of shading that the options choose, sizes replaced as the options say, each key once. Throws UsageError for
/// a filter that is no regular expression, or half a size.
[[nodiscard]] std::vector<BenchRow> select_rows(const BenchOptions& options);

} // namespace clshade
