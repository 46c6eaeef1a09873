#include "host/cli/bench_report.h"

#include "host/cli/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace clshade::cli {

namespace {

/// After an empty line; nothing without rows.
std::string table_text(const Table& table) {
    return table.empty() ? std::string() : fmt::format("\n{}", table.text());
}

std::string ratio_text(const RivalResult& rival) {
    return rival.status == BenchStatus::ok ? fmt::format("{:.3f}", rival.ratio) : std::string(name_of(rival.status));
}

bool is_batch(const BenchResult& row) {
    return row.key.starts_with("batch.");
}

std::string kernels_text(const BenchReport& bench) {
    Table table({{"kernel", Align::left},
                 {"lanes"},
                 {"median [ms]"},
                 {"min [ms]"},
                 {"spread [%]"},
                 {"Mpix/s"},
                 {"B/pix"},
                 {"GB/s"},
                 {"build cold [ms]"},
                 {"cached [ms]"}});
    for (const BenchResult& row : bench.results) {
        if (is_batch(row)) {
            continue; // tables of their own
        }
        if (row.status != BenchStatus::ok) {
            table.add_row({row.key, std::string(name_of(row.status))});
            continue;
        }
        table.add_row({row.key, std::to_string(row.lanes), format_ms(row.median_ms), format_ms(row.min_ms),
                       fmt::format("{:.1f}", 100.0 * row.spread), fmt::format("{:.0f}", row.mpix_per_s),
                       fmt::format("{:.0f}", row.bytes_per_pixel), fmt::format("{:.2f}", row.gb_per_s),
                       format_ms(row.build_cold_ms), format_ms(row.build_cached_ms)});
    }
    return table.empty() ? std::string() : table.text();
}

std::string rivals_text(const BenchReport& bench) {
    Table table({{"kernel", Align::left}, {"against", Align::left}, {"rival median [ms]"}, {"kernel/rival"}});
    for (const BenchResult& row : bench.results) {
        if (is_batch(row)) {
            continue;
        }
        for (const RivalResult& rival : row.against) {
            table.add_row({row.key, rival.name, rival.status == BenchStatus::ok ? format_ms(rival.median_ms) : "",
                           ratio_text(rival)});
        }
    }
    return table_text(table);
}

/// Errors of both sides stand beside the times: only equal results may be compared.
std::string prefilter_text(const BenchReport& bench) {
    Table table({{"pre-filter, all levels", Align::left},
                 {"median [ms]"},
                 {"with build [ms]"},
                 {"from cache [ms]"},
                 {"max error"},
                 {"C++ OpenMP [ms]"},
                 {"max error"},
                 {"ours/theirs"}});
    for (const BenchResult& row : bench.results) {
        if (!row.max_error || row.status != BenchStatus::ok || row.against.empty()) {
            continue;
        }
        const RivalResult& rival = row.against.front();
        const bool timed = rival.status == BenchStatus::ok;
        table.add_row({row.key, format_ms(row.median_ms), format_ms(row.build_cold_ms), format_ms(row.build_cached_ms),
                       format_error(*row.max_error), timed ? format_ms(rival.median_ms) : "",
                       timed ? format_error(rival.max_error) : "", ratio_text(rival)});
    }
    return table_text(table);
}

std::string megabytes(double bytes) {
    return fmt::format("{:.2f}", 1e-6 * bytes);
}

/// Whole runs, then what each compression of an output costs.
std::string batch_text(const BenchReport& bench) {
    Table runs({{"run, from files to files", Align::left},
                {"frames/s"},
                {"read [MB]"},
                {"written [MB]"},
                {"against", Align::left},
                {"frames/s"},
                {"time ours/theirs"},
                {"", Align::left}});
    Table encoding({{"output, forced to the disk", Align::left}, {"median [ms]"}, {"min [ms]"}, {"written [MB]"}});
    for (const BenchResult& row : bench.results) {
        if (!is_batch(row)) {
            continue;
        }
        if (row.status != BenchStatus::ok || !row.batch) {
            runs.add_row({row.key, std::string(name_of(row.status))});
            continue;
        }
        if (row.key.starts_with("batch.encode.")) {
            encoding.add_row(
                {row.key, format_ms(row.median_ms), format_ms(row.min_ms), megabytes(row.batch->bytes_written)});
            continue;
        }
        for (const RivalResult& rival : row.against) {
            const bool timed = rival.status == BenchStatus::ok;
            runs.add_row({row.key, fmt::format("{:.2f}", row.batch->frames_per_second),
                          megabytes(row.batch->bytes_read), megabytes(row.batch->bytes_written), rival.name,
                          timed ? fmt::format("{:.2f}", 1e3 / rival.median_ms) : "", ratio_text(rival), rival.note});
        }
    }
    const char* const note = "Inputs lie in the page cache. Every output of ours is checked and forced to the disk; "
                             "the rivals' are not.\n";
    return table_text(runs) + (runs.empty() ? "" : note) + table_text(encoding);
}

std::string headline_text(const BenchReport& bench, const DeviceInfo& device) {
    if (!bench.headline) {
        return {};
    }
    return fmt::format("\nThe deck's heaviest row (one light and one environment, layered, Oren-Nayar, 1280x720) took "
                       "{:.2f} ms on its console's GPU; here {} ms on {} compute units of {}.\n",
                       bench.headline->deck_ms, format_ms(bench.headline->median_ms), device.compute_units,
                       device.name);
}

std::string limits_text(const BenchReport& bench) {
    Table table({{"limit", Align::left}, {"at most"}, {"here"}, {"", Align::left}});
    for (const SpeedLimit& row : bench.limits) {
        const auto value = [&row](double number) {
            return row.in_milliseconds ? fmt::format("{} ms", format_ms(number)) : fmt::format("{:.3f}", number);
        };
        table.add_row({row.name, value(row.limit), value(row.value), row.met() ? "met" : "MISSED"});
    }
    return table_text(table);
}

std::string size_text(int width, int height) {
    return fmt::format("{}x{}", width, height);
}

std::string deck_text(const BenchReport& bench) {
    Table table({{"row of the deck", Align::left},
                 {"against", Align::left},
                 {"deck"},
                 {"here"},
                 {"here [ms]"},
                 {"size", Align::left}});
    std::size_t skipped = 0;
    for (const DeckRow& row : bench.deck) {
        if (row.status == BenchStatus::ok && row.ratio) {
            table.add_row({row.name, row.baseline, fmt::format("{:.3f}", row.deck_ratio),
                           fmt::format("{:.3f}", *row.ratio), format_ms(row.median_ms),
                           size_text(row.width, row.height)});
        } else {
            ++skipped;
        }
    }
    const bool tell = !table.empty() && skipped > 0;
    return table_text(table) +
           (tell ? fmt::format("{} more rows of the deck: their kernels were not timed\n", skipped) : std::string());
}

std::string layers_text(const BenchReport& bench) {
    Table table({{"layers"}, {"median [ms]"}, {"to one layer"}, {"each further layer"}, {"size", Align::left}});
    for (const LayerGrowth& row : bench.layers) {
        table.add_row({std::to_string(row.layers), format_ms(row.median_ms), fmt::format("{:.3f}", row.ratio),
                       row.layers > 1 ? fmt::format("{:+.3f}", row.per_layer) : "", size_text(row.width, row.height)});
    }
    const bool grows =
        std::any_of(bench.layers.begin(), bench.layers.end(), [](const LayerGrowth& row) { return row.layers > 1; });
    return grows ? table_text(table) : std::string();
}

std::string reasons_text(const BenchReport& bench) {
    std::string text;
    const auto add = [&](const std::string& who, BenchStatus status, const std::string& reason) {
        if (status != BenchStatus::ok) {
            text += fmt::format("{}: {}: {}\n", who, name_of(status), reason);
        }
    };
    for (const BenchResult& row : bench.results) {
        add(row.key, row.status, row.reason);
        for (const RivalResult& rival : row.against) {
            add(row.key + " against " + rival.name, rival.status, rival.reason);
        }
    }
    return text.empty() ? text : fmt::format("\n{}", text);
}

nlohmann::json json_of(const RivalResult& rival) {
    nlohmann::json result = {{"status", name_of(rival.status)}};
    if (rival.status != BenchStatus::ok) {
        result["reason"] = rival.reason;
        return result;
    }
    result["median_ms"] = rival.median_ms;
    result["min_ms"] = rival.min_ms;
    result["ratio"] = rival.ratio;
    result["max_error"] = rival.max_error;
    result["rounds"] = rival.rounds;
    if (!rival.note.empty()) {
        result["note"] = rival.note;
    }
    return result;
}

nlohmann::json json_of(const BenchResult& row) {
    nlohmann::json against = nlohmann::json::object();
    for (const RivalResult& rival : row.against) {
        against[rival.name] = json_of(rival);
    }
    nlohmann::json result = {{"kernel", row.key},
                             {"width", row.width},
                             {"height", row.height},
                             {"lights", row.lights},
                             {"environments", row.environments},
                             {"layers", row.layers},
                             {"lanes", row.lanes},
                             {"rounds", row.rounds},
                             {"median_ms", row.median_ms},
                             {"min_ms", row.min_ms},
                             {"spread", row.spread},
                             {"bytes_per_pixel", row.bytes_per_pixel},
                             {"mpix_per_s", row.mpix_per_s},
                             {"gb_per_s", row.gb_per_s},
                             {"build_cold_ms", row.build_cold_ms},
                             {"build_cached_ms", row.build_cached_ms},
                             {"against", against}};
    if (row.max_error) {
        result["max_error"] = *row.max_error;
    }
    if (row.batch) {
        result["batch"] = {{"frames", row.batch->frames},
                           {"frames_per_second", row.batch->frames_per_second},
                           {"bytes_read", row.batch->bytes_read},
                           {"bytes_written", row.batch->bytes_written},
                           {"rival_bytes_written", row.batch->rival_bytes_written}};
    }
    return result;
}

nlohmann::json json_of(const DeckRow& row) {
    nlohmann::json result = {{"name", row.name},
                             {"baseline", row.baseline},
                             {"deck_ratio", row.deck_ratio},
                             {"status", name_of(row.status)}};
    if (row.status != BenchStatus::ok) {
        result["reason"] = row.reason;
    }
    if (row.ratio) {
        result["width"] = row.width;
        result["height"] = row.height;
        result["median_ms"] = row.median_ms;
        result["ratio"] = *row.ratio;
    }
    return result;
}

nlohmann::json json_of(const LayerGrowth& row) {
    return {{"width", row.width},         {"height", row.height}, {"layers", row.layers},
            {"median_ms", row.median_ms}, {"ratio", row.ratio},   {"per_layer", row.per_layer}};
}

nlohmann::json json_of(const SpeedLimit& row) {
    return {{"name", row.name},
            {"unit", row.in_milliseconds ? "ms" : "ratio"},
            {"limit", row.limit},
            {"value", row.value},
            {"met", row.met()}};
}

} // namespace

void add_bench(JsonReport& report, const BenchReport& bench) {
    nlohmann::json deck = nlohmann::json::array();
    for (const DeckRow& row : bench.deck) {
        deck.push_back(json_of(row));
    }
    report.set("deck", deck);
    nlohmann::json layers = nlohmann::json::array();
    for (const LayerGrowth& row : bench.layers) {
        layers.push_back(json_of(row));
    }
    report.set("layer_growth", layers);
    nlohmann::json limits = nlohmann::json::array();
    for (const SpeedLimit& row : bench.limits) {
        limits.push_back(json_of(row));
    }
    report.set("limits", limits);
    if (bench.headline) {
        report.set("headline", {{"kernel", bench.headline->key},
                                {"deck_ms", bench.headline->deck_ms},
                                {"median_ms", bench.headline->median_ms}});
    }
    for (const BenchResult& row : bench.results) {
        if (row.status == BenchStatus::ok) {
            report.add(json_of(row));
        } else {
            report.add(json_of(row), name_of(row.status), row.reason);
        }
    }
}

std::string bench_text(const BenchReport& bench, const DeviceInfo& device) {
    return kernels_text(bench) + rivals_text(bench) + prefilter_text(bench) + batch_text(bench) + deck_text(bench) +
           layers_text(bench) + headline_text(bench, device) + limits_text(bench) + reasons_text(bench);
}

} // namespace clshade::cli
