#include "host/cli/options.h"

#include "host/base/error.h"
#include "host/base/suggest.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <thread>

namespace clshade::cli {

namespace {

constexpr std::array<std::string_view, 6> progress_names{"auto", "bar", "plain", "openjd", "alf", "none"};
constexpr std::array<std::string_view, 5> lane_names{"auto", "1", "4", "8", "16"};
constexpr std::array<int, 5> lane_values{0, 1, 4, 8, 16};

// CLI11 takes the text after "in " for the group's heading; the empty group hides an option from help.
constexpr const char* common_group = "Common flags";
constexpr const char* hidden_group = "";

} // namespace

int CommonOptions::host_threads() const {
    return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void add_common_options(CLI::App& app, CommonOptions& options, CommonGroup shown) {
    CommonOptions* o = &options;
    const char* running = shown == CommonGroup::running ? common_group : hidden_group;
    app.add_option("--device", o->device,
                   "device: index, part of 'platform/device', or cpu | gpu; see `clshade devices`. Default: the only "
                   "device, else the only GPU; never a silent choice among several")
        ->group(running)
        ->type_name("SEL");
    app.add_option_function<std::string>(
           "--threads",
           [o](const std::string& text) { o->threads = static_cast<int>(parse_whole("--threads", text, 1, 4096)); },
           "threads for files, reference and CPU devices. Default: all")
        ->group(running)
        ->type_name("N");
    app.add_option_function<std::string>(
           "--max-mem",
           [o](const std::string& text) {
               o->max_memory = static_cast<std::uint64_t>(parse_whole("--max-mem", text, 1, 1 << 30)) << 20;
           },
           "most memory of the process (and of a GPU for planes), in MiB: decides how many frames are under way at "
           "once; "
           "larger frames are shaded in bands, larger environments halved. Default: half of the machine's")
        ->group(running)
        ->type_name("MB");
    app.add_option_function<std::string>(
           "--lanes",
           [o](const std::string& text) { o->lanes = lane_values.at(parse_choice("--lanes", text, lane_names)); },
           "vector width of the kernels: auto | 1 | 4 | 8 | 16. Default: auto (what `bench --tune` stored, else what "
           "the "
           "device prefers)")
        ->group(running)
        ->type_name("WIDTH");
    app.add_option("--kernel-dir", o->kernel_dir, "folder whose *.cl and *.h replace the kernels built in")
        ->group(running)
        ->type_name("DIR");
    app.add_option_function<std::string>(
           "--seed",
           [o](const std::string& text) {
               o->seed =
                   static_cast<std::uint64_t>(parse_whole("--seed", text, 0, std::numeric_limits<std::int64_t>::max()));
           },
           "seed of random G-buffers (check, bench). Default: 1")
        ->group(running)
        ->type_name("N");
    app.add_option_function<std::string>(
           "--progress",
           [o](const std::string& text) {
               o->progress = static_cast<ProgressMode>(parse_choice("--progress", text, progress_names));
           },
           "auto | bar | plain | openjd | alf | none. Default: auto (a bar on a terminal, else none)")
        ->group(running)
        ->type_name("MODE");
    app.add_flag("--runstats", o->run_stats,
                 "time per stage and per kernel, bytes, peak memory, ratio to decoding and encoding alone")
        ->group(running);
    app.add_option("--json", o->json_file, "also write a machine-readable report")
        ->group(common_group)
        ->type_name("FILE");
    app.add_flag("-v,--verbose", o->verbosity, "say more (twice: more still)")->group(common_group);
    app.add_flag("-q,--quiet", o->quiet, "say nothing but errors")->group(common_group);
}

void add_scene_options(CLI::App& app, SceneOptions& options) {
    app.add_option(
           "--scene", options.file,
           "scene file (TOML). Default: materials from the file's own roles, a key light and the built-in studio, "
           "both turned with the camera")
        ->type_name("S.toml");
    app.add_option("--set", options.overrides,
                   "override one key of the scene, e.g. material.default.specular.shininess=32; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    app.add_option("--model", options.model,
                   "specular or diffuse model of the default material; its keys by --set; see `clshade models`")
        ->type_name("NAME");
    app.add_option("--view", options.view, "view of a stereo file. Default: the first")->type_name("NAME");
}

std::size_t parse_choice(std::string_view flag, std::string_view value, std::span<const std::string_view> choices) {
    const auto found = std::find(choices.begin(), choices.end(), value);
    if (found != choices.end()) {
        return static_cast<std::size_t>(found - choices.begin());
    }
    throw UsageError(fmt::format("{}: '{}' is not one of {}{}", flag, value, fmt::join(choices, ", "),
                                 did_you_mean(value, choices)));
}

Size parse_size(std::string_view flag, std::string_view value) {
    const std::size_t cross = value.find('x');
    if (cross == std::string_view::npos) {
        throw UsageError(fmt::format("{}: '{}' is not a size; write WIDTHxHEIGHT, for example 1280x720", flag, value));
    }
    const auto side = [&](std::string_view text) { return static_cast<int>(parse_whole(flag, text, 1, 65536)); };
    return {side(value.substr(0, cross)), side(value.substr(cross + 1))};
}

std::vector<std::string> split_list(std::string_view text) {
    std::vector<std::string> parts;
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        if (comma > 0) {
            parts.emplace_back(text.substr(0, comma));
        }
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return parts;
}

double parse_number(std::string_view flag, std::string_view value, double minimum) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || !std::isfinite(number) || number < minimum) {
        throw UsageError(fmt::format("{}: '{}' is not a number of at least {}", flag, value, minimum));
    }
    return number;
}

std::int64_t parse_whole(std::string_view flag, std::string_view value, std::int64_t minimum, std::int64_t maximum) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || number < minimum || number > maximum) {
        throw UsageError(fmt::format("{}: '{}' is not a whole number from {} to {}", flag, value, minimum, maximum));
    }
    return number;
}

} // namespace clshade::cli
