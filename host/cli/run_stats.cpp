#include "host/cli/run_stats.h"

#include "host/cli/table.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace clshade::cli {

namespace {

constexpr double megabyte = 1e6;
constexpr double milliseconds_per_second = 1e3;

// Stages of a batch in the order of a frame's way, and those that happen once in a run.
constexpr std::array<std::string_view, 8> known_stages{"device",   "environment", "build",   "read",
                                                       "transfer", "kernel",      "prepare", "write"};
constexpr std::size_t once_in_a_run = 3;

std::size_t place_of(std::string_view stage) {
    return static_cast<std::size_t>(std::find(known_stages.begin(), known_stages.end(), stage) - known_stages.begin());
}

bool happens_once(std::string_view stage) {
    return place_of(stage) < once_in_a_run;
}

// Stages that are not known stay in the order in which they were met, behind the others.
std::vector<std::pair<std::string, double>> in_order(const StageTimes& stages) {
    auto ordered = stages.stages();
    std::stable_sort(ordered.begin(), ordered.end(),
                     [](const auto& a, const auto& b) { return place_of(a.first) < place_of(b.first); });
    return ordered;
}

std::string seconds_text(double milliseconds) {
    constexpr double hundred = 100.0;
    constexpr double ten = 10.0;
    const double seconds = milliseconds / milliseconds_per_second;
    return fmt::format("{:.{}f} s", seconds, seconds >= hundred ? 0 : seconds >= ten ? 1 : 2);
}

std::string rate_of(std::uint64_t bytes, double milliseconds) {
    const double megabytes = static_cast<double>(bytes) / megabyte;
    return fmt::format("{:.1f} MB, {:.1f} MB/s", megabytes, megabytes / milliseconds * milliseconds_per_second);
}

} // namespace

nlohmann::json stages_json(const StageTimes& stages) {
    nlohmann::json times = nlohmann::json::object();
    for (const auto& [stage, milliseconds] : stages.stages()) {
        times[stage] = milliseconds;
    }
    times["total"] = stages.total();
    return times;
}

void RunStats::add(const clshade::FrameOutcome& outcome) {
    if (!outcome.skipped.empty()) {
        ++skipped_;
        return;
    }
    add(outcome.stages);
    add(outcome.kernels);
    busy_milliseconds_ += outcome.busy_milliseconds;
    bytes_read_ += outcome.bytes_read;
    bytes_written_ += outcome.bytes_written;
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

void RunStats::finish(double wall_milliseconds, int threads) {
    wall_milliseconds_ = wall_milliseconds;
    threads_ = std::max(threads, 1);
}

double RunStats::kernel_milliseconds() const {
    double sum = 0.0;
    for (const auto& entry : kernels_) {
        sum += entry.second.milliseconds;
    }
    return sum;
}

double RunStats::decode_encode_milliseconds() const {
    return busy_milliseconds_ / threads_;
}

std::string RunStats::slowest_stage() const {
    const std::array<std::pair<std::string_view, double>, 3> times{
        {{"read", stages_.of("read")},
         {"shade", stages_.of("transfer") + stages_.of("kernel") + stages_.of("prepare")},
         {"write", stages_.of("write")}}};
    const auto slowest =
        std::max_element(times.begin(), times.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    return std::string(slowest->second > 0.0 ? slowest->first : "");
}

std::string RunStats::stage_table() const {
    const double total = stages_.total();
    double every_frame = 0.0;
    Table table({{"stage", Align::left}, {"total [ms]"}, {"per frame [ms]"}, {"share [%]"}});
    const auto add_row = [&](const std::string& name, double milliseconds, const std::string& per_frame) {
        table.add_row({name, format_ms(milliseconds), per_frame,
                       fmt::format("{:.1f}", total > 0.0 ? 100.0 * milliseconds / total : 0.0)});
    };
    const auto per_frame = [&](double milliseconds) { return format_ms(milliseconds / std::max(frames_, 1)); };
    for (const auto& [stage, milliseconds] : in_order(stages_)) {
        const bool once = happens_once(stage);
        every_frame += once ? 0.0 : milliseconds;
        add_row(stage, milliseconds, once ? "once" : per_frame(milliseconds));
    }
    add_row("total", total, per_frame(every_frame));
    return table.text();
}

std::string RunStats::kernel_table() const {
    constexpr std::size_t longest_key = 80;
    Table table({{"kernel", Align::left}, {"launches"}, {"total [ms]"}, {"per launch [ms]"}, {"GB/s"}});
    for (const auto& [key, sum] : kernels_) {
        table.add_row({shortened(key, longest_key), std::to_string(sum.launches), format_ms(sum.milliseconds),
                       format_ms(sum.milliseconds / sum.launches),
                       fmt::format("{:.2f}", sum.bytes / std::max(sum.milliseconds, 1e-9) * 1e-6)});
    }
    return table.text();
}

std::string RunStats::run_lines() const {
    const double wall = wall_milliseconds_;
    std::string text = fmt::format("frames: {} shaded", frames_);
    text += skipped_ > 0 ? fmt::format(", {} skipped\n", skipped_) : "\n";
    text += fmt::format("wall time: {}, {:.2f} frames per second{}\n", seconds_text(wall),
                        frames_ / wall * milliseconds_per_second,
                        stages_.total() > wall ? " (stages of frames in flight overlap)" : "");
    text += fmt::format("read: {}\nwritten: {}\n", rate_of(bytes_read_, wall), rate_of(bytes_written_, wall));
    text += fmt::format("kernels: {:.1f} % of the wall time\n", 100.0 * kernel_milliseconds() / wall);
    if (const double alone = decode_encode_milliseconds(); alone > 0.0) {
        text += fmt::format("decode + encode alone keep {} {} busy for {}: this run took {:.2f} times that\n", threads_,
                            threads_ == 1 ? "thread" : "threads", seconds_text(alone), wall / alone);
    }
    return text;
}

std::string RunStats::text() const {
    std::string text = stage_table();
    text += kernels_.empty() ? "" : '\n' + kernel_table();
    text += '\n';
    text += wall_milliseconds_ > 0.0 ? run_lines() : "";
    constexpr double mebibyte = 1024.0 * 1024.0;
    return text + fmt::format("peak memory: {:.0f} MiB\n", peak_memory() / mebibyte);
}

nlohmann::json RunStats::json() const {
    nlohmann::json kernels = nlohmann::json::object();
    for (const auto& [key, sum] : kernels_) {
        kernels[key] = sum.milliseconds;
    }
    nlohmann::json result = {{"frames", frames_},
                             {"skipped", skipped_},
                             {"stage_ms", stages_json(stages_)},
                             {"kernel_ms", kernels},
                             {"bytes_read", bytes_read_},
                             {"bytes_written", bytes_written_},
                             {"peak_memory", static_cast<std::uint64_t>(peak_memory())}};
    if (wall_milliseconds_ > 0.0) {
        const double alone = decode_encode_milliseconds();
        result["wall_ms"] = wall_milliseconds_;
        result["threads"] = threads_;
        result["fps"] = frames_ / wall_milliseconds_ * milliseconds_per_second;
        result["kernel_share"] = kernel_milliseconds() / wall_milliseconds_;
        result["decode_encode_ms"] = alone;
        result["ratio"] = alone > 0.0 ? nlohmann::json(wall_milliseconds_ / alone) : nlohmann::json();
    }
    return result;
}

double peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024.0; // Linux counts in KiB
}

} // namespace clshade::cli
