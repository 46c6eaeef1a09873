#include "bench/benchmark.h"
#include "host/base/error.h"
#include "host/cli/baseline.h"
#include "host/cli/lane_store.h"
#include "host/cli/log_level.h"
#include "host/cli/progress.h"
#include "host/cli/report_json.h"
#include "host/cli/session.h"
#include "host/cli/table.h"
#include "host/cli/verb.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

namespace clshade::cli {

namespace {

constexpr double default_regress = 10.0;

struct BenchFlags {
    CommonOptions common;
    std::string filter;
    std::string size;
    std::string baseline;
    std::string regress;
    std::string rounds;
    std::string seconds;
    bool tune = false;
    bool quick = false;
    bool list = false;
};

BenchOptions options_of(const BenchFlags& flags, Session& session) {
    BenchOptions options;
    options.filter = flags.filter;
    if (!flags.size.empty()) {
        const Size size = parse_size("--size", flags.size);
        options.width = size.width;
        options.height = size.height;
    }
    if (!flags.rounds.empty()) {
        options.rounds = static_cast<int>(parse_whole("--rounds", flags.rounds, 1, 100000));
    }
    if (!flags.seconds.empty()) {
        options.seconds = parse_number("--seconds", flags.seconds, 0.0);
    }
    options.seed = flags.common.seed;
    options.threads = flags.common.threads;
    options.kernel_dir = flags.common.kernel_dir;
    options.quick = flags.quick;
    options.lanes = flags.list ? flags.common.lanes : session.lanes();
    return options;
}

std::string ratio_text(const RivalResult& rival) {
    return rival.status == BenchStatus::ok ? fmt::format("{:.3f}", rival.ratio) : std::string(name_of(rival.status));
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
        if (row.status != BenchStatus::ok) {
            table.add_row({row.key, std::string(name_of(row.status))});
            continue;
        }
        table.add_row({row.key, std::to_string(row.lanes), format_ms(row.median_ms), format_ms(row.min_ms),
                       fmt::format("{:.1f}", 100.0 * row.spread), fmt::format("{:.0f}", row.mpix_per_s),
                       fmt::format("{:.0f}", row.bytes_per_pixel), fmt::format("{:.2f}", row.gb_per_s),
                       format_ms(row.build_cold_ms), format_ms(row.build_cached_ms)});
    }
    return table.text();
}

std::string rivals_text(const BenchReport& bench) {
    Table table({{"kernel", Align::left}, {"against", Align::left}, {"rival median [ms]"}, {"kernel/rival"}});
    for (const BenchResult& row : bench.results) {
        for (const RivalResult& rival : row.against) {
            table.add_row({row.key, rival.name, rival.status == BenchStatus::ok ? format_ms(rival.median_ms) : "",
                           ratio_text(rival)});
        }
    }
    return table.empty() ? std::string() : "\n" + table.text();
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
    for (const DeckRow& row : bench.deck) {
        const std::string deck = fmt::format("{:.3f}", row.deck_ratio);
        if (row.status == BenchStatus::ok && row.ratio) {
            table.add_row({row.name, row.baseline, deck, fmt::format("{:.3f}", *row.ratio), format_ms(row.median_ms),
                           size_text(row.width, row.height)});
        } else {
            table.add_row({row.name, row.baseline, deck, std::string(name_of(row.status))});
        }
    }
    return table.empty() ? std::string() : "\n" + table.text();
}

std::string layers_text(const BenchReport& bench) {
    Table table({{"layers"}, {"median [ms]"}, {"to one layer"}, {"each further layer"}, {"size", Align::left}});
    for (const LayerGrowth& row : bench.layers) {
        table.add_row({std::to_string(row.layers), format_ms(row.median_ms), fmt::format("{:.3f}", row.ratio),
                       row.layers > 1 ? fmt::format("{:+.3f}", row.per_layer) : "", size_text(row.width, row.height)});
    }
    const bool grows =
        std::any_of(bench.layers.begin(), bench.layers.end(), [](const LayerGrowth& row) { return row.layers > 1; });
    return grows ? "\n" + table.text() : std::string();
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
    for (const DeckRow& row : bench.deck) {
        add(row.name, row.status, row.reason);
    }
    return text.empty() ? text : "\n" + text;
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
    return result;
}

nlohmann::json json_of(const BenchResult& row) {
    nlohmann::json against = nlohmann::json::object();
    for (const RivalResult& rival : row.against) {
        against[rival.name] = json_of(rival);
    }
    return {{"kernel", row.key},
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

void add_to(JsonReport& report, const BenchReport& bench) {
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
    for (const BenchResult& row : bench.results) {
        if (row.status == BenchStatus::ok) {
            report.add(json_of(row));
        } else {
            report.add(json_of(row), name_of(row.status), row.reason);
        }
    }
}

ExitCode tune(const BenchFlags& flags, Session& session, JsonReport& report) {
    Progress progress(flags.common, 1);
    const LaneTuning tuning =
        tune_lanes(session.device(), options_of(flags, session), [&](const std::string& what, int done, int total) {
            progress.update(what, static_cast<double>(done) / std::max(total, 1));
        });
    progress.clear();
    store_lanes(session.info(), tuning.best);
    Table table({{"lanes"}, {"median [ms]"}, {"", Align::left}});
    for (const LaneTime& time : tuning.times) {
        nlohmann::json result = {{"lanes", time.lanes}, {"median_ms", time.median_ms}};
        if (time.status == BenchStatus::ok) {
            report.add(result);
            table.add_row(
                {std::to_string(time.lanes), format_ms(time.median_ms), time.lanes == tuning.best ? "best" : ""});
        } else {
            report.add(result, name_of(time.status), time.reason);
            table.add_row({std::to_string(time.lanes), std::string(name_of(time.status)), time.reason});
        }
    }
    report.set("best_lanes", tuning.best);
    if (!flags.common.quiet) {
        fmt::print("{}\nstored in {}: --lanes auto now means {} on {}/{}\n", table.text(), lane_store_file().string(),
                   tuning.best, session.info().platform, session.info().name);
    }
    return ExitCode::ok;
}

ExitCode bench(const BenchFlags& flags, JsonReport& report) {
    const double regress = flags.regress.empty() ? default_regress : parse_number("--regress", flags.regress, 0.0);
    Session session(flags.common);
    if (flags.list) {
        const std::vector<std::string> keys = benchmark_keys(options_of(flags, session));
        if (keys.empty()) {
            throw UsageError(fmt::format(
                "--filter: no kernel's key is found by '{}'; `clshade bench --list` shows them", flags.filter));
        }
        for (const std::string& key : keys) {
            fmt::print("{}\n", key);
        }
        return ExitCode::ok;
    }
    // A baseline that cannot be read must not cost anybody a benchmark.
    const std::optional<Baseline> baseline =
        flags.baseline.empty() ? std::nullopt : std::optional(read_baseline(flags.baseline));
    report.set_device(session.info());
    if (flags.tune) {
        return tune(flags, session, report);
    }
    Progress progress(flags.common, 1);
    const BenchReport result =
        run_benchmarks(session.device(), options_of(flags, session), [&](const std::string& what, int done, int total) {
            progress.update(what, static_cast<double>(done) / std::max(total, 1));
        });
    progress.clear();
    add_to(report, result);
    if (!flags.common.quiet) {
        fmt::print("{}/{}, driver {}\n\n{}{}{}{}{}", session.info().platform, session.info().name,
                   session.info().driver, kernels_text(result), rivals_text(result), deck_text(result),
                   layers_text(result), reasons_text(result));
    }
    ExitCode code = ExitCode::ok;
    for (const BenchResult& row : result.results) {
        code = row.status == BenchStatus::error ? ExitCode::runtime_failure : code;
    }
    if (baseline) {
        const BaselineComparison comparison = compare_with(*baseline, result, regress);
        report.set("compare", comparison.json);
        if (!flags.common.quiet) {
            fmt::print("\n{}", comparison.text);
        }
        if (baseline->device != session.info().platform + "/" + session.info().name) {
            spdlog::warn("{}: the baseline was taken on {}", flags.baseline, baseline->device);
        }
        code = comparison.regressed > 0 ? ExitCode::comparison_failed : code;
    }
    return code;
}

} // namespace

Action declare_bench(CLI::App& app) {
    auto flags = std::make_shared<BenchFlags>();
    app.add_option("--filter", flags->filter, "only kernels whose key this regular expression finds")
        ->type_name("REGEX");
    app.add_option("--size", flags->size, "picture size for every row, in pixels. Default: each row's own")
        ->type_name("WxH");
    app.add_option("--compare", flags->baseline, "compare with an earlier --json report; exit code 3 if slower")
        ->type_name("BASELINE.json");
    app.add_option("--regress", flags->regress,
                   "how much slower than the baseline is too slow, in percent. Default: 10")
        ->type_name("PERCENT");
    app.add_option("--rounds", flags->rounds, "at least this many rounds. Default: 15")->type_name("N");
    app.add_option("--seconds", flags->seconds, "time for each row in seconds. Default: 1.5")->type_name("S");
    app.add_flag("--quick", flags->quick, "small pictures and few rounds: only to see that everything runs");
    app.add_flag("--list", flags->list, "print the keys and stop");
    app.add_flag("--tune", flags->tune, "measure the vector widths and store the best for --lanes auto");
    add_common_options(app, flags->common, CommonGroup::running);
    return [flags] {
        set_log_level(flags->common);
        return with_report(flags->common, "bench", [&](JsonReport& report) { return bench(*flags, report); });
    };
}

} // namespace clshade::cli
