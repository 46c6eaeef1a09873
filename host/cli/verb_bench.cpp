#include "bench/benchmark.h"
#include "host/base/error.h"
#include "host/cli/baseline.h"
#include "host/cli/bench_report.h"
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
    add_bench(report, result);
    if (!flags.common.quiet) {
        fmt::print("{}/{}, driver {}\n\n{}", session.info().platform, session.info().name, session.info().driver,
                   bench_text(result, session.info()));
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
    app.add_option("--filter", flags->filter,
                   "only rows whose key this regular expression finds. Rows of whole runs, from files to files, take "
                   "minutes and write gigabytes into TMPDIR: they take part only where it says `batch`")
        ->type_name("REGEX");
    app.add_option("--size", flags->size,
                   "picture size for every row of shading and of whole runs, in pixels. Default: each row's own")
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
