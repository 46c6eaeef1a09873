// What `bench` found, for the terminal and for --json.
#pragma once

#include "bench/benchmark.h"
#include "host/cli/report_json.h"

#include <string>

namespace clshade::cli {

/// Every table: kernels, rivals, pre-filter, the deck's rows beside ours, layers, limits; then what went wrong.
[[nodiscard]] std::string bench_text(const BenchReport& bench, const DeviceInfo& device);

/// One result per row, and the tables "deck", "layer_growth", "limits" and "headline" beside them.
void add_bench(JsonReport& report, const BenchReport& bench);

} // namespace clshade::cli
