#include "host/cli/run_stats.h"

#include "host/cli/table.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

namespace clshade::cli {

void StageTimes::add(const std::string& stage, double milliseconds) {
    const auto found =
        std::find_if(stages_.begin(), stages_.end(), [&](const auto& entry) { return entry.first == stage; });
    if (found == stages_.end()) {
        stages_.emplace_back(stage, milliseconds);
    } else {
        found->second += milliseconds;
    }
}

void StageTimes::add(const StageTimes& other) {
    for (const auto& [stage, milliseconds] : other.stages_) {
        add(stage, milliseconds);
    }
}

double StageTimes::total() const {
    double sum = 0.0;
    for (const auto& entry : stages_) {
        sum += entry.second;
    }
    return sum;
}

nlohmann::json StageTimes::json() const {
    nlohmann::json times = nlohmann::json::object();
    for (const auto& [stage, milliseconds] : stages_) {
        times[stage] = milliseconds;
    }
    times["total"] = total();
    return times;
}

void RunStats::add(const StageTimes& stages) {
    stages_.add(stages);
    ++frames_;
}

void RunStats::add(const std::vector<KernelTime>& kernels) {
    for (const KernelTime& kernel : kernels) {
        KernelSum& sum = kernels_[kernel.kernel];
        ++sum.launches;
        sum.milliseconds += kernel.milliseconds;
        sum.bytes += static_cast<double>(kernel.bytes);
    }
}

std::string RunStats::text() const {
    const double total = stages_.total();
    Table stages({{"stage", Align::left}, {"total [ms]"}, {"per frame [ms]"}, {"share [%]"}});
    const auto add_stage = [&](const std::string& name, double milliseconds) {
        stages.add_row({name, format_ms(milliseconds), format_ms(milliseconds / std::max(frames_, 1)),
                        fmt::format("{:.1f}", total > 0.0 ? 100.0 * milliseconds / total : 0.0)});
    };
    for (const auto& [stage, milliseconds] : stages_.stages()) {
        add_stage(stage, milliseconds);
    }
    add_stage("total", total);
    std::string text = stages.text();
    if (!kernels_.empty()) {
        constexpr std::size_t longest_key = 80;
        Table kernels({{"kernel", Align::left}, {"launches"}, {"total [ms]"}, {"per launch [ms]"}, {"GB/s"}});
        for (const auto& [key, sum] : kernels_) {
            kernels.add_row({shortened(key, longest_key), std::to_string(sum.launches), format_ms(sum.milliseconds),
                             format_ms(sum.milliseconds / sum.launches),
                             fmt::format("{:.2f}", sum.bytes / std::max(sum.milliseconds, 1e-9) * 1e-6)});
        }
        text += '\n';
        text += kernels.text();
    }
    constexpr double mebibyte = 1024.0 * 1024.0;
    return text + fmt::format("\npeak memory: {:.0f} MiB\n", peak_memory() / mebibyte);
}

double peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024.0; // Linux counts in KiB
}

} // namespace clshade::cli
