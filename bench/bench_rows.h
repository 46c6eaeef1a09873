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

struct BenchRow {
    std::string name; ///< "shade.blinn_phong.lambert.distant1"
    int width = 0;
    int height = 0;
    BenchScene scene;
    std::vector<Rival> rivals;
    bool against_lambert = false; ///< also measured against the one-light Lambert kernel at the same size

    /// "shade.blinn_phong.lambert.distant1.1280x720"
    [[nodiscard]] std::string key() const;
};

/// The one-light Lambert kernel that others are measured against.
[[nodiscard]] BenchRow lambert_row(int width, int height);

/// All rows that the options choose, sizes replaced as the options say, each key once. Throws UsageError for a filter
/// that is no regular expression, or half a size.
[[nodiscard]] std::vector<BenchRow> select_rows(const BenchOptions& options);

/// The deck's direct-light tables (models.md section 13). `row` is the name of ours, or empty: not built yet.
struct DeckEntry {
    std::string_view name;
    std::string_view baseline;
    double ratio;
    std::string_view row;
    std::string_view reason; ///< why there is none
};
[[nodiscard]] std::vector<DeckEntry> deck_entries();

} // namespace clshade
