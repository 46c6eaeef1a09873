// Which of our rows stand beside the deck's tables (models.md section 13), which tell how time grows with layers, and
// what limits of speed there are.
#pragma once

#include "bench/benchmark.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// The deck's tables, by names of our rows.
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

/// The deck's heaviest row, by name of ours: one light and one environment, layered, Oren-Nayar.
inline constexpr double deck_heaviest_ms = 7.82;
[[nodiscard]] std::string heaviest_row();
/// It beside ours, if that was timed at the deck's size.
[[nodiscard]] std::optional<BenchHeadline> headline_of(const std::vector<BenchResult>& results);

/// Limits of speed on what was timed, at the deck's size; rows that were not timed are left out.
[[nodiscard]] std::vector<SpeedLimit> judged_limits(const std::vector<BenchResult>& results);

} // namespace clshade
