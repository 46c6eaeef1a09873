#include "host/base/error.h"
#include "host/base/stopwatch.h"
#include "host/cli/check_frame.h"
#include "host/cli/check_image.h"
#include "host/cli/check_suite.h"
#include "host/cli/check_truth.h"
#include "host/cli/log_level.h"
#include "host/cli/progress.h"
#include "host/cli/report_json.h"
#include "host/cli/run_stats.h"
#include "host/cli/session.h"
#include "host/cli/thread_limit.h"
#include "host/cli/verb.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <future>
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
    std::string ground_truth;
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
        : options_(options), report_(report), wanted_(override_of(options)), session_(options.common),
          session_with_aov_(options.common) {}

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
            dump_.write(options_.dump);
        }
        return tell();
    }

  private:
    void input() {
        Stopwatch watch;
        CheckInput input = read_check_input(options_.input, options_.scene, options_.common.max_memory);
        StageTimes stages;
        stages.add("read", watch.lap());
        Progress progress(options_.common, 1);
        if (input.environment) {
            input.frame.environment->maps = filtered(*input.environment, progress, stages);
        }
        progress.update("comparing " + options_.input);
        compare(input.frame, {}, session_, {}, std::move(stages));
        progress.clear();
        for (const std::string& warning : input.warnings) {
            spdlog::warn(warning);
        }
    }

    void every_model() {
        const Size size = parse_size("--size", options_.size);
        const std::vector<SuiteCase> suite = check_suite(options_.common.seed);
        Progress progress(options_.common, static_cast<int>(suite.size()), Steps::other);
        EnvironmentInput surroundings;
        surroundings.name = "studio";
        surroundings.image = std::make_shared<const LatLong>(suite_environment());
        for (const SuiteCase& suite_case : suite) {
            Stopwatch watch;
            StageTimes stages;
            if (suite_case.environment) {
                filtered(surroundings, progress, stages);
                watch.lap();
            }
            Frame frame = frame_of(suite_case, size.width, size.height, options_.common.seed, surroundings.image,
                                   surroundings.maps);
            stages.add("random G-buffer", watch.lap());
            const std::string name = name_of(suite_case, frame);
            progress.update("comparing " + name);
            Session& session = suite_case.environment_aov ? session_with_aov_ : session_;
            compare(frame, {name, layer_of(suite_case, frame)}, session, {.environment = suite_case.environment_aov},
                    std::move(stages));
            progress.step();
        }
    }

    std::shared_ptr<const FilteredSet> filtered(EnvironmentInput& environment, Progress& progress, StageTimes& stages) {
        if (environment.maps == nullptr) {
            Stopwatch watch;
            Shader& shader = session_.shader({});
            stages.add("device", watch.lap());
            const PrefilterReport report = prefilter_environment(environment, shader, progress, 0.0, 0.5);
            spdlog::info("{}: maps {} in {:.0f} ms", environment.name, report.from_cache ? "from the cache" : "built",
                         report.milliseconds);
            stages.add("environment", watch.lap());
        }
        return environment.maps;
    }

    void compare(Frame& frame, const Naming& naming, Session& session, const AovSelection& aovs, StageTimes stages) {
        Stopwatch watch;
        Shader& shader = session.shader(aovs);
        report_.set_device(session_.info());
        stages.add("device", watch.lap());
        const int threads = options_.common.host_threads();
        // The reference works while the driver builds the kernel, which takes one core a second or two.
        std::future<Expectation> reference =
            std::async(std::launch::async, [&frame, &aovs, threads] { return expect(frame, aovs, threads); });
        const ShadedImage shaded = shader.shade(frame);
        spdlog::debug("{}: kernel {} in {:.0f} ms", naming.name.empty() ? frame.file : naming.name,
                      shaded.built_from_cache ? "from the cache" : "built", shaded.build_milliseconds);
        stages.add("shade", watch.lap());
        const Expectation expectation = reference.get();
        const reference::Image& expected = expectation.image;
        stages.add("reference", watch.lap()); // what was left of it
        if (shaded.counts.fractional_ids > 0) {
            throw UsageError(
                fmt::format("{}: material ids are filtered: {} pixels hold fractions; give a plane rendered "
                            "without a filter in [gbuffer] material_id",
                            frame.file, shaded.counts.fractional_ids));
        }
        for (CheckResult& result : check_frame(frame, shaded, expectation, wanted_)) {
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
    Session session_with_aov_; // a shader has one set of outputs
    RunStats stats_;
    std::vector<CheckResult> results_;
    ErrorDump dump_;
};

ExitCode ground_truth(const CheckOptions& options, JsonReport& report) {
    if (!options.dump.empty()) {
        throw UsageError("--ground-truth: compares no pictures, so there is nothing for --dump; leave one of them out");
    }
    constexpr std::int64_t most = 1'000'000;
    const int samples = static_cast<int>(parse_whole("--ground-truth", options.ground_truth, 1, most));
    const TruthOptions wanted{samples, options.common.seed, options.common.host_threads()};
    std::vector<reference::GroundTruthSample> all;
    if (options.input.empty()) {
        const std::vector<TruthCase> cases = truth_cases(options.common.host_threads());
        Progress progress(options.common, static_cast<int>(cases.size()), Steps::other);
        for (const TruthCase& truth_case : cases) {
            progress.update("integrating " + truth_case.name);
            append_samples(all, truth_case.frame, wanted, truth_case.name);
            progress.step();
        }
    } else {
        const CheckInput input = read_check_input(options.input, options.scene, options.common.max_memory);
        Progress progress(options.common, 1);
        progress.update("integrating " + options.input);
        append_samples(all, input.frame, wanted, {});
        progress.clear();
        for (const std::string& warning : input.warnings) {
            spdlog::warn(warning);
        }
    }
    const std::vector<reference::GroundTruthSummary> rows = reference::summarise(all);
    report.set("ground_truth", truth_json(rows));
    if (!options.common.quiet) {
        fmt::print("{}", truth_text(rows));
    }
    return ExitCode::ok;
}

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
    app.add_option("--percentile", o->percentile,
                   "share of pixels that must be within tolerance. Default: 99.99, under an "
                   "environment 99.9")
        ->type_name("PERCENT");
    app.add_option("--dump", o->dump, "write device.*, reference.* and error.* planes as EXR")->type_name("FILE");
    app.add_option("--ground-truth", o->ground_truth,
                   "compare nothing; integrate environment times BRDF by brute force at N pixels and report how far "
                   "the real-time approximation is from that, per model and shininess")
        ->type_name("N");
    app.add_option("--size", o->size,
                   "size of the random G-buffers in pixels; half of that each way under an environment. "
                   "Default: 192x192")
        ->type_name("WxH");
    add_common_options(app, o->common, CommonGroup::running);
    return [options] {
        set_log_level(options->common);
        const auto limit = thread_limit(options->common);
        return with_report(options->common, "check", [&](JsonReport& report) {
            if (!options->ground_truth.empty()) {
                return ground_truth(*options, report);
            }
            CheckRun run(*options, report);
            return run.run();
        });
    };
}

} // namespace clshade::cli
