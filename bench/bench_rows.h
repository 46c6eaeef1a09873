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

/// "shade.blinn_phong.lambert.distant1"; with a variant "shade.blinn_phong.lambert.constant_f0.distant1"; several
/// materials: "shade.mixed4.tiles.distant1".
[[nodiscard]] std::string row_name(const BenchScene& scene);

/// The one-light Lambert kernel that others are measured against.
[[nodiscard]] BenchRow lambert_row(int width, int height);

/// All rows that the options choose, sizes replaced as the options say, each key once. Throws UsageError for a filter
/// that is no regular expression, or half a size.
[[nodiscard]] std::vector<BenchRow> select_rows(const BenchOptions& options);

/// The deck's direct-light tables (models.md section 13), by names of our rows.
struct DeckEntry {
    std::string_view name;
    std::string_view baseline;
    double ratio;
    std::string row;
    std::string baseline_row;
};
[[nodiscard]] std::vector<DeckEntry> deck_entries();

/// One Lambert material under 0, 1, 3 and 7 coats: from how time grows with the layers.
struct LayerEntry {
    int layers;
    std::string row;
};
[[nodiscard]] std::vector<LayerEntry> layer_entries();

} // namespace clshade
