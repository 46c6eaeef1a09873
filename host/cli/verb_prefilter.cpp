#include "host/base/stopwatch.h"
#include "host/cli/log_level.h"
#include "host/cli/options.h"
#include "host/cli/progress.h"
#include "host/cli/report_json.h"
#include "host/cli/run_stats.h"
#include "host/cli/session.h"
#include "host/cli/table.h"
#include "host/cli/thread_limit.h"
#include "host/cli/verb.h"
#include "host/images/environment_file.h"
#include "host/prefilter/grid_mean.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>

namespace clshade::cli {

namespace {

namespace fs = std::filesystem;

struct PrefilterOptions {
    CommonOptions common;
    std::string input;
    std::string output;
};

/// A map of the set and the mean of its radiance: all means are the picture's, or energy was lost.
struct MapMean {
    std::string name;
    int cells = 0;
    glm::dvec3 mean{0.0};
};

std::vector<MapMean> means_of(const FilteredSet& set) {
    std::vector<MapMean> means;
    for (int level = 0; level < radiance_levels; ++level) {
        const int cells = level_cells(level);
        means.push_back({fmt::format("radiance n={:.0f}", level_shininess(level)), cells,
                         grid_mean(set.radiance[static_cast<std::size_t>(level)], cells)});
    }
    means.push_back({"irradiance E/pi", irradiance_cells, grid_mean(set.irradiance, irradiance_cells)});
    return means;
}

double brightness(const glm::dvec3& rgb) {
    return (rgb.r + rgb.g + rgb.b) / 3.0;
}

std::string kept(const glm::dvec3& mean, const glm::dvec3& whole) {
    const double of = brightness(whole);
    return of > 0.0 ? fmt::format("{:.3f}", 100.0 * brightness(mean) / of) : "-";
}

std::string table_of(const FilteredSet& set, const std::vector<MapMean>& means) {
    Table table({{"map", Align::left}, {"vertices"}, {"mean R"}, {"G"}, {"B"}, {"energy kept [%]"}});
    const auto add = [&](const std::string& name, const std::string& size, const glm::dvec3& mean) {
        table.add_row({name, size, fmt::format("{:.5g}", mean.r), fmt::format("{:.5g}", mean.g),
                       fmt::format("{:.5g}", mean.b), kept(mean, set.mean)});
    };
    add("picture", "", set.mean);
    for (const MapMean& map : means) {
        add(map.name, fmt::format("{0}x{0}", map.cells + 1), map.mean);
    }
    return table.text();
}

nlohmann::json json_of(const glm::dvec3& rgb) {
    return {rgb.r, rgb.g, rgb.b};
}

nlohmann::json json_of(const LatLong& image, const FilteredSet& set, const std::vector<MapMean>& means) {
    nlohmann::json result = {{"width", image.width},       {"height", image.height},       {"halvings", image.halvings},
                             {"negative", image.negative}, {"nonfinite", image.nonfinite}, {"hash", set.hash},
                             {"mean", json_of(set.mean)}};
    result["maps"] = nlohmann::json::array();
    for (const MapMean& map : means) {
        result["maps"].push_back({{"map", map.name}, {"vertices", map.cells + 1}, {"mean", json_of(map.mean)}});
    }
    return result;
}

void check_paths(const PrefilterOptions& options) {
    if (options.input.empty()) {
        throw UsageError("prefilter: ENV is missing; write `clshade prefilter ENV -o SET`");
    }
    if (options.output.empty()) {
        throw UsageError("prefilter: where should the maps go? Add -o SET, a folder");
    }
    if (is_filtered_set(options.input)) {
        throw UsageError(fmt::format("{}: is a pre-filtered set already; name it in a scene as it is", options.input));
    }
    const fs::path output(options.output);
    std::error_code unreadable;
    const bool free =
        !fs::exists(output, unreadable) || (fs::is_directory(output, unreadable) && fs::is_empty(output, unreadable));
    if (!free && !is_filtered_set(output)) { // before the work, not after it
        throw RuntimeFailure(
            fmt::format("{}: exists and is no pre-filtered set; name another folder, or remove it", options.output));
    }
}

void warn_about(const LatLong& image, const std::string& file) {
    if (image.halvings > 0) {
        spdlog::warn("{}: halved {} to {}x{} to fit --max-mem", file,
                     image.halvings == 1 ? "once" : fmt::format("{} times", image.halvings), image.width, image.height);
    }
    if (image.nonfinite > 0) {
        spdlog::warn("{}: {} texels with NaN or Inf became black", file, image.nonfinite);
    }
    if (image.negative > 0) {
        spdlog::warn("{}: {} texels had negative channels, set to 0", file, image.negative);
    }
}

ExitCode prefilter(const PrefilterOptions& options, JsonReport& report) {
    check_paths(options);
    Session session(options.common);
    report.set_device(session.info());
    Progress progress(options.common, 1);
    StageTimes stages;
    Stopwatch watch;
    progress.update("reading");
    const LatLong image = read_lat_long(options.input, options.common.max_memory, false);
    warn_about(image, options.input);
    stages.add("read", watch.lap());
    Prefilter& filter = session.prefilter();
    stages.add("device", watch.lap());
    PrefilterReport cost;
    const FilteredSet set = filter.filter(
        image, [&](double share) { progress.update("filtering", share); }, &cost);
    stages.add("filter", watch.lap());
    const AmbientTables ambient = filter.ambient_tables();
    stages.add("ambient", watch.lap());
    progress.update("writing", 1.0);
    write_filtered_set(options.output, set, ambient);
    stages.add("write", watch.lap());
    progress.step();
    progress.clear();

    const std::vector<MapMean> means = means_of(set);
    nlohmann::json result = json_of(image, set, means);
    result["input"] = options.input;
    result["output"] = options.output;
    result["from_cache"] = cost.from_cache;
    result["filter_ms"] = cost.milliseconds;
    result["kernel_ms"] = cost.kernel_milliseconds;
    result["build_ms"] = cost.build_milliseconds;
    result["stage_ms"] = stages_json(stages);
    report.add(std::move(result));
    if (!options.common.quiet) {
        fmt::print("{}{}: {}x{} texels, {} in {} ms -> {}\n", table_of(set, means), options.input, image.width,
                   image.height, cost.from_cache ? "taken from the cache" : "filtered", format_ms(cost.milliseconds),
                   options.output);
    }
    if (options.common.run_stats) {
        RunStats stats;
        stats.add(stages);
        if (!cost.from_cache) {
            stats.add(std::vector<KernelTime>{{"filter_environment", cost.kernel_milliseconds, 0}});
        }
        fmt::print("\n{}", stats.text());
    }
    return ExitCode::ok;
}

} // namespace

Action declare_prefilter(CLI::App& app) {
    auto options = std::make_shared<PrefilterOptions>();
    app.add_option("ENV", options->input, "environment picture, lat-long .hdr or .exr, twice as wide as high");
    app.add_option("-o,--output", options->output, "folder for the set of maps; a set there is replaced")
        ->type_name("SET");
    add_common_options(app, options->common, CommonGroup::running);
    return [options] {
        set_log_level(options->common);
        const auto limit = thread_limit(options->common);
        return with_report(options->common, "prefilter",
                           [&](JsonReport& report) { return prefilter(*options, report); });
    };
}

} // namespace clshade::cli
