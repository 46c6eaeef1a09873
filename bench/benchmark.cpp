#include "bench/benchmark.h"

#include "bench/bench_group.h"
#include "bench/bench_rows.h"
#include "host/base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <list>
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

/// The deck's rows with status and reason, before anything is timed.
std::vector<DeckRow> empty_deck() {
    std::vector<DeckRow> deck;
    for (const DeckEntry& entry : deck_entries()) {
        DeckRow row;
        row.name = entry.name;
        row.baseline = entry.baseline;
        row.deck_ratio = entry.ratio;
        row.status = entry.row.empty() ? BenchStatus::unsupported : BenchStatus::skipped;
        row.reason = entry.row.empty() ? entry.reason : "its kernel was not timed";
        deck.push_back(std::move(row));
    }
    return deck;
}

/// Fills in what a group timed; of several sizes the first that has a ratio counts.
void fill_deck(std::vector<DeckRow>& deck, const BenchGroup& group) {
    const std::vector<DeckEntry> entries = deck_entries();
    const std::string lambert = lambert_row(1, 1).name;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (entries[i].row.empty() || deck[i].ratio) {
            continue;
        }
        deck[i].ratio = group.ratio(entries[i].row, lambert);
        if (deck[i].ratio) {
            deck[i].status = BenchStatus::ok;
            deck[i].reason.clear();
        }
    }
}

} // namespace

BenchReport run_benchmarks(Device& device, const BenchOptions& options, const BenchProgress& progress) {
    const std::vector<BenchRow> rows = select_rows(options);
    if (rows.empty()) {
        BenchOptions every = options;
        every.filter.clear();
        throw UsageError(fmt::format("--filter '{}' matches no kernel; there are {}", options.filter,
                                     fmt::join(benchmark_keys(every), ", ")));
    }
    const std::vector<std::vector<BenchRow>> groups = by_size(rows);
    const int total = static_cast<int>(rows.size() + groups.size());
    int done = 0;
    const auto tell = [&](const std::string& what) {
        if (progress) {
            progress(what, std::min(done, total), total);
        }
        ++done;
    };

    BenchReport report;
    report.deck = empty_deck();
    for (const std::vector<BenchRow>& group_rows : groups) {
        try {
            BenchGroup group(device, options, group_rows);
            group.prepare([&](const std::string& key) { tell("building " + key); });
            tell(fmt::format("timing {}x{}", group_rows.front().width, group_rows.front().height));
            group.run();
            std::vector<BenchResult> results = group.results();
            std::move(results.begin(), results.end(), std::back_inserter(report.results));
            fill_deck(report.deck, group);
        } catch (const UsageError&) {
            throw; // a wrong --kernel-dir or --lanes is the same for every group
        } catch (const std::exception& failure) {
            std::vector<BenchResult> results = failed(group_rows, failure.what());
            std::move(results.begin(), results.end(), std::back_inserter(report.results));
        }
    }
    return report;
}

} // namespace clshade
