#include "bench/benchmark.h"

#include "bench/batch_bench.h"
#include "bench/batch_rows.h"
#include "bench/bench_group.h"
#include "bench/bench_rows.h"
#include "bench/build_times.h"
#include "bench/deck_table.h"
#include "bench/prefilter_bench.h"
#include "bench/prefilter_rows.h"
#include "host/base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace clshade {

namespace {

/// Rows by size, sizes in the order they first appear.
std::vector<std::vector<BenchRow>> by_size(const std::vector<BenchRow>& rows) {
    std::vector<std::vector<BenchRow>> groups;
    for (const BenchRow& row : rows) {
        const auto same = std::find_if(groups.begin(), groups.end(), [&row](const std::vector<BenchRow>& group) {
            return group.front().width == row.width && group.front().height == row.height;
        });
        if (same == groups.end()) {
            groups.push_back({row});
        } else {
            same->push_back(row);
        }
    }
    return groups;
}

std::vector<BenchResult> failed(const std::vector<BenchRow>& rows, const std::string& reason) {
    std::vector<BenchResult> results;
    for (const BenchRow& row : rows) {
        BenchResult result;
        result.key = row.key();
        result.width = row.width;
        result.height = row.height;
        result.status = BenchStatus::error;
        result.reason = reason;
        results.push_back(std::move(result));
    }
    return results;
}

/// Adds what a group timed of the deck's rows.
void add_deck(std::vector<DeckRow>& deck, const BenchGroup& group) {
    for (const DeckEntry& entry : deck_entries()) {
        DeckRow row;
        row.ratio = group.ratio(entry.row, entry.baseline_row);
        if (!row.ratio) {
            continue;
        }
        row.name = entry.name;
        row.baseline = entry.baseline;
        row.deck_ratio = entry.ratio;
        row.width = group.width();
        row.height = group.height();
        row.median_ms = group.median_ms(entry.row).value();
        deck.push_back(std::move(row));
    }
}

/// Adds the deck's rows that no group has timed.
void add_missing_deck(std::vector<DeckRow>& deck) {
    for (const DeckEntry& entry : deck_entries()) {
        const bool known =
            std::any_of(deck.begin(), deck.end(), [&entry](const DeckRow& row) { return row.name == entry.name; });
        if (!known) {
            DeckRow row;
            row.name = entry.name;
            row.baseline = entry.baseline;
            row.deck_ratio = entry.ratio;
            row.status = BenchStatus::skipped;
            row.reason = "its kernel was not timed";
            deck.push_back(std::move(row));
        }
    }
}

void add_layers(std::vector<LayerGrowth>& layers, const BenchGroup& group) {
    const std::vector<LayerEntry> entries = layer_entries();
    for (const LayerEntry& entry : entries) {
        const std::optional<double> ratio = group.ratio(entry.row, entries.front().row);
        if (ratio) {
            const double per_layer = entry.layers > 1 ? (*ratio - 1.0) / (entry.layers - 1) : 0.0;
            layers.push_back(
                {group.width(), group.height(), entry.layers, group.median_ms(entry.row).value(), *ratio, per_layer});
        }
    }
}

/// The first build of a process also loads the driver's compiler, which is not what rows report. If it fails, the rows
/// say why.
void load_compiler(Device& device, const BenchOptions& options) {
    try {
        (void)measure_build(device, {}, options.kernel_dir, options.lanes);
    } catch (const RuntimeFailure& failure) {
        spdlog::debug("the build before all others failed: {}", failure.what());
    }
}

} // namespace

std::vector<std::string> benchmark_keys(const BenchOptions& options) {
    std::vector<std::string> keys;
    for (const BenchRow& row : select_rows(options)) {
        keys.push_back(row.key());
    }
    for (const PrefilterRow& row : select_prefilter_rows(options)) {
        keys.push_back(row.key());
    }
    for (const BatchRow& row : select_batch_rows(options)) {
        keys.push_back(row.key());
    }
    return keys;
}

BenchReport run_benchmarks(Device& device, const BenchOptions& options, const BenchProgress& progress) {
    const std::vector<BenchRow> rows = select_rows(options);
    const std::vector<PrefilterRow> prefilter_rows = select_prefilter_rows(options);
    const std::vector<BatchRow> batch_rows = select_batch_rows(options);
    if (rows.empty() && prefilter_rows.empty() && batch_rows.empty()) {
        BenchOptions every = options;
        every.filter.clear();
        throw UsageError(fmt::format("--filter '{}' matches no kernel; there are {}", options.filter,
                                     fmt::join(benchmark_keys(every), ", ")));
    }
    const std::vector<std::vector<BenchRow>> groups = by_size(rows);
    const int total = static_cast<int>(rows.size() + groups.size() + prefilter_rows.size() + batch_rows.size());
    int done = 0;
    const auto tell = [&](const std::string& what) {
        if (progress) {
            progress(what, std::min(done, total), total);
        }
        ++done;
    };

    load_compiler(device, options);
    BenchReport report;
    BenchStudio studio(device, options.kernel_dir, options.lanes);
    for (const std::vector<BenchRow>& group_rows : groups) {
        try {
            BenchGroup group(device, options, studio, group_rows);
            group.prepare([&](const std::string& key) { tell("building " + key); });
            tell(fmt::format("timing {}x{}", group_rows.front().width, group_rows.front().height));
            group.run();
            std::vector<BenchResult> results = group.results();
            std::move(results.begin(), results.end(), std::back_inserter(report.results));
            add_deck(report.deck, group);
            add_layers(report.layers, group);
        } catch (const UsageError&) {
            throw; // a wrong --kernel-dir or --lanes is the same for every group
        } catch (const std::exception& failure) {
            std::vector<BenchResult> results = failed(group_rows, failure.what());
            std::move(results.begin(), results.end(), std::back_inserter(report.results));
        }
    }
    add_missing_deck(report.deck);
    std::vector<BenchResult> filtered = run_prefilter_rows(device, options, prefilter_rows, tell);
    std::move(filtered.begin(), filtered.end(), std::back_inserter(report.results));
    std::vector<BenchResult> batches = run_batch_rows(device, options, batch_rows, tell);
    std::move(batches.begin(), batches.end(), std::back_inserter(report.results));
    report.headline = headline_of(report.results);
    report.limits = judged_limits(report.results);
    const std::vector<SpeedLimit> of_batches = batch_limits(report.results);
    report.limits.insert(report.limits.end(), of_batches.begin(), of_batches.end());
    return report;
}

} // namespace clshade
