#include "host/cli/baseline.h"

#include "host/base/error.h"
#include "host/cli/report_json.h"
#include "host/cli/table.h"

#include <fmt/format.h>

#include <fstream>

namespace clshade::cli {

Baseline read_baseline(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) {
        throw RuntimeFailure(fmt::format("{}: cannot read the baseline", file.string()));
    }
    const nlohmann::json document = nlohmann::json::parse(stream, nullptr, false);
    const bool is_report = document.is_object() && document.value("command", nlohmann::json()) == "bench" &&
                           document.contains("results") && document["results"].is_array();
    if (!is_report) {
        throw RuntimeFailure(fmt::format("{}: not a report of `clshade bench --json`", file.string()));
    }
    if (document.value("version", nlohmann::json()) != report_version) {
        throw RuntimeFailure(fmt::format("{}: report version {} is not {}; take the baseline again", file.string(),
                                         document.value("version", nlohmann::json()).dump(), report_version));
    }
    Baseline baseline;
    baseline.file = file.string();
    const nlohmann::json device = document.value("device", nlohmann::json());
    baseline.device = device.is_string() ? device.get<std::string>() : "an unknown device";
    for (const nlohmann::json& row : document["results"]) {
        const bool usable = row.is_object() && row.value("status", nlohmann::json()) == "ok" &&
                            row.value("kernel", nlohmann::json()).is_string() &&
                            row.value("median_ms", nlohmann::json()).is_number();
        if (usable) {
            baseline.median_ms[row["kernel"].get<std::string>()] = row["median_ms"].get<double>();
        }
    }
    return baseline;
}

BaselineComparison compare_with(const Baseline& baseline, const BenchReport& bench, double regress_percent) {
    BaselineComparison comparison;
    comparison.json = nlohmann::json::array();
    Table table({{"kernel", Align::left}, {"baseline [ms]"}, {"now [ms]"}, {"change [%]"}, {"", Align::left}});
    int matched = 0;
    for (const BenchResult& row : bench.results) {
        if (row.status != BenchStatus::ok) {
            continue;
        }
        const auto found = baseline.median_ms.find(row.key);
        if (found == baseline.median_ms.end() || !(found->second > 0.0)) {
            table.add_row({row.key, "-", format_ms(row.median_ms), "", "not in the baseline"});
            continue;
        }
        ++matched;
        const double change = 100.0 * (row.median_ms / found->second - 1.0);
        const bool slower = change > regress_percent;
        comparison.regressed += slower ? 1 : 0;
        table.add_row({row.key, format_ms(found->second), format_ms(row.median_ms), fmt::format("{:+.1f}", change),
                       slower ? "SLOWER" : ""});
        comparison.json.push_back({{"kernel", row.key},
                                   {"baseline_ms", found->second},
                                   {"median_ms", row.median_ms},
                                   {"change_percent", change},
                                   {"pass", !slower}});
    }
    if (matched == 0) {
        throw UsageError(fmt::format("{}: no kernel of this run is in the baseline; use the same --filter and --size",
                                     baseline.file));
    }
    comparison.text = table.text() + fmt::format("{} of {} kernels slower than {} by more than {} %\n",
                                                 comparison.regressed, matched, baseline.file, regress_percent);
    return comparison;
}

} // namespace clshade::cli
