#include "host/base/error.h"
#include "host/cli/check_frame.h"
#include "host/cli/check_image.h"
#include "host/cli/check_suite.h"
#include "host/cli/log_level.h"
#include "host/cli/progress.h"
#include "host/cli/report_json.h"
#include "host/cli/run_stats.h"
#include "host/cli/session.h"
#include "host/cli/stopwatch.h"
#include "host/cli/verb.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <utility>

namespace clshade::cli {

namespace {

struct CheckOptions {
    CommonOptions common;
    SceneOptions scene;
    std::string input;
    std::string rel;
    std::string abs;
    std::string percentile;
    std::string dump;
    std::string size = "192x192";
};

ToleranceOverride override_of(const CheckOptions& options) {
    ToleranceOverride wanted;
    if (!options.rel.empty()) {
        wanted.rel = parse_number("--rel", options.rel, 0.0);
    }
    if (!options.abs.empty()) {
        wanted.abs = parse_number("--abs", options.abs, 0.0);
    }
    if (!options.percentile.empty()) {
        wanted.percentile = parse_number("--percentile", options.percentile, 0.0);
        if (*wanted.percentile > 100.0) {
            throw UsageError(fmt::format("--percentile: {} is more than 100", options.percentile));
        }
    }
    return wanted;
}

// What a frame's only material is called in reports and in --dump. Empty: materials go by their model_key.
struct Naming {
    std::string name;
    std::string layer;
};

// Runs one or many comparisons and tells of them.
class CheckRun {
  public:
    CheckRun(const CheckOptions& options, JsonReport& report)
        : options_(options), report_(report), wanted_(override_of(options)), session_(options.common) {}

    ExitCode run() {
        if (!options_.dump.empty()) {
            check_dump_path(options_.dump, options_.input);
        }
        if (options_.input.empty()) {
            every_model();
        } else {
            input();
        }
        if (!options_.dump.empty()) {
            dump_.write(options_.dump, options_.common.host_threads());
        }
        return tell();
    }

  private:
    void input() {
        Stopwatch watch;
        CheckInput input = read_check_input(options_.input, options_.scene, options_.common.host_threads());
        StageTimes stages;
        stages.add("read", watch.lap());
        Progress progress(options_.common, 1);
        progress.update("comparing " + options_.input);
        compare(input.frame, {}, std::move(stages));
        progress.clear();
        for (const std::string& warning : input.warnings) {
            spdlog::warn(warning);
        }
    }

    void every_model() {
        const Size size = parse_size("--size", options_.size);
        const std::vector<SuiteCase> suite = check_suite(options_.common.seed);
        Progress progress(options_.common, static_cast<int>(suite.size()));
        for (const SuiteCase& suite_case : suite) {
            Stopwatch watch;
            Frame frame = frame_of(suite_case, size.width, size.height, options_.common.seed);
            StageTimes stages;
            stages.add("random G-buffer", watch.lap());
            const std::string name = name_of(suite_case, frame);
            progress.update("comparing " + name);
            compare(frame, {name, layer_of(suite_case, frame)}, std::move(stages));
            progress.step();
        }
    }

    void compare(Frame& frame, const Naming& naming, StageTimes stages) {
        Stopwatch watch;
        Shader& shader = session_.shader({});
        report_.set_device(session_.info());
        stages.add("device", watch.lap());
        const ShadedImage shaded = shader.shade(frame);
        stages.add("shade", watch.lap());
        if (shaded.counts.fractional_ids > 0) {
            throw UsageError(
                fmt::format("{}: material ids are filtered: {} pixels hold fractions; give a plane rendered "
                            "without a filter in [gbuffer] material_id",
                            frame.file, shaded.counts.fractional_ids));
        }
        const int threads = options_.common.host_threads();
        const reference::Image expected = reference::shade(frame, {}, threads);
        stages.add("reference", watch.lap());
        for (CheckResult& result : check_frame(frame, shaded, expected, wanted_, threads)) {
            // Without INPUT the empty pixels of all random frames are the same; they stand in each one's row.
            const bool empty = result.model == "no_surface";
            if (!naming.name.empty() && empty && result.pass) {
                continue;
            }
            if (!naming.name.empty()) {
                result.model = empty ? naming.name + ".no_surface" : naming.name;
            }
            results_.push_back(std::move(result));
        }
        compare_counts(shaded.counts, expected.counts);
        if (!options_.dump.empty()) {
            dump_.add(naming.layer, frame, shaded, expected);
        }
        stages.add("compare", watch.lap());
        stats_.add(stages);
        stats_.add(shaded.kernel_times);
    }

    void compare_counts(const PixelCounts& device, const PixelCounts& reference) {
        const auto compare_one = [this](const char* what, std::uint64_t ours, std::uint64_t expected) {
            if (ours != expected) {
                results_.back().pass = false;
                results_.back().trouble = fmt::format("{}: device {}, reference {}", what, ours, expected);
            }
        };
        compare_one("non-finite pixels", device.nonfinite, reference.nonfinite);
        compare_one("pixels without a tangent", device.no_tangent, reference.no_tangent);
    }

    ExitCode tell() {
        std::size_t failed = 0;
        std::string worst;
        for (const CheckResult& result : results_) {
            report_.add(json_of(result));
            failed += result.pass ? 0 : 1;
            if (!result.pass || options_.common.verbosity > 0) {
                worst += worst_text(result);
            }
        }
        if (!options_.common.quiet) {
            fmt::print("{}/{}, {} lanes, against the double-precision reference\n\n{}", session_.info().platform,
                       session_.info().name, session_.shader({}).lanes(), check_table(results_));
            fmt::print("{}{}\n{} of {} passed\n", worst.empty() ? "" : "\n", worst, results_.size() - failed,
                       results_.size());
        }
        if (options_.common.run_stats) {
            fmt::print("\n{}", stats_.text());
        }
        return failed == 0 && !results_.empty() ? ExitCode::ok : ExitCode::comparison_failed;
    }

    const CheckOptions& options_;
    JsonReport& report_;
    ToleranceOverride wanted_;
    Session session_;
    RunStats stats_;
    std::vector<CheckResult> results_;
    ErrorDump dump_;
};

} // namespace

Action declare_check(CLI::App& app) {
    auto options = std::make_shared<CheckOptions>();
    CheckOptions* o = options.get();
    app.add_option("INPUT", o->input, "G-buffer EXR. Default: random G-buffers for every model there is");
    add_scene_options(app, o->scene);
    app.add_option("--rel", o->rel, "largest relative error; replaces the models' defaults together with --abs")
        ->type_name("X");
    app.add_option("--abs", o->abs, "largest absolute error, in units of radiance. Default: 0 if --rel is given")
        ->type_name("X");
    app.add_option("--percentile", o->percentile, "share of pixels that must be within tolerance. Default: 99.99")
        ->type_name("PERCENT");
    app.add_option("--dump", o->dump, "write device.*, reference.* and error.* planes as EXR")->type_name("FILE");
    app.add_option("--size", o->size, "size of the random G-buffers in pixels. Default: 192x192")->type_name("WxH");
    add_common_options(app, o->common, CommonGroup::running);
    return [options] {
        set_log_level(options->common);
        return with_report(options->common, "check", [&](JsonReport& report) {
            CheckRun run(*options, report);
            return run.run();
        });
    };
}

} // namespace clshade::cli
