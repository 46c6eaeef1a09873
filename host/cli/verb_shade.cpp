#include "host/base/error.h"
#include "host/base/frame_range.h"
#include "host/base/suggest.h"
#include "host/cli/log_level.h"
#include "host/cli/report_json.h"
#include "host/cli/shade_frame.h"
#include "host/cli/verb.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <memory>

namespace clshade::cli {

namespace {

constexpr std::array<std::string_view, 4> aov_names{"diffuse", "specular", "lights", "environment"};

struct ShadeOptions {
    CommonOptions common;
    SceneOptions scene;
    std::string input;
    std::string output;
    std::string frames;
    std::string data_type = "half";
    std::string compression = "zip";
    std::string aovs;
    std::string keep;
    std::string chunk;
    std::string dump_kernel;
    bool update_only = false;
    bool no_clobber = false;
    bool skip_bad_frames = false;
    bool dry_run = false;
};

ShadeSettings settings_of(const ShadeOptions& options) {
    ShadeSettings settings;
    for (const std::string& name : split_list(options.aovs)) {
        const std::size_t which = parse_choice("--aov", name, aov_names);
        settings.aovs.diffuse = settings.aovs.diffuse || which == 0;
        settings.aovs.specular = settings.aovs.specular || which == 1;
        settings.aovs.lights = settings.aovs.lights || which == 2;
        settings.aovs.environment = settings.aovs.environment || which == 3;
    }
    constexpr std::array<std::string_view, 2> types{"half", "float"};
    settings.exr.half = parse_choice("-d", options.data_type, types) == 0;
    parse_compression(options.compression, settings.exr);
    settings.keep = split_list(options.keep);
    settings.view = options.scene.view;
    settings.update_only = options.update_only;
    settings.no_clobber = options.no_clobber;
    settings.dry_run = options.dry_run;
    settings.threads = options.common.host_threads();
    settings.exr.threads = settings.threads;
    return settings;
}

std::vector<FrameJob> single_job(const ShadeOptions& options, const std::optional<SequencePath>& output) {
    if (!options.frames.empty()) {
        throw UsageError(fmt::format("--frames: {} has no place for the frame number; write # or %04d", options.input));
    }
    if (output) {
        throw UsageError(fmt::format("{}: INPUT {} is one file, so the output has no frame number; leave # or %04d out",
                                     options.output, options.input));
    }
    return {{std::nullopt, options.input, options.output, {}}};
}

// Everything to be done, in order.
std::vector<FrameJob> jobs_of(const ShadeOptions& options) {
    const std::optional<SequencePath> input = SequencePath::parse(options.input);
    const std::optional<SequencePath> output = SequencePath::parse(options.output);
    std::vector<FrameJob> jobs;
    if (!input) {
        jobs = single_job(options, output);
    } else {
        const std::vector<int> frames = options.frames.empty() ? input->existing() : parse_frames(options.frames);
        if (frames.size() > 1 && !output) {
            throw UsageError(fmt::format("{}: {} frames would be written to one file; put # or %04d into its name",
                                         options.output, frames.size()));
        }
        for (const int frame : frames) {
            const std::filesystem::path target = output ? output->at(frame) : std::filesystem::path(options.output);
            jobs.push_back({frame, input->at(frame), target, {}});
        }
    }
    if (options.chunk.empty()) {
        return jobs;
    }
    const Chunk chunk = parse_chunk(options.chunk);
    std::vector<int> positions(jobs.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        positions[i] = static_cast<int>(i);
    }
    std::vector<FrameJob> chosen;
    for (const int position : chunk_of(positions, chunk.index, chunk.count)) {
        chosen.push_back(jobs[static_cast<std::size_t>(position)]);
    }
    return chosen;
}

nlohmann::json json_of(const FrameJob& job) {
    nlohmann::json result = {{"input", job.input.string()}, {"output", job.output.string()}};
    result["frame"] = job.number ? nlohmann::json(*job.number) : nlohmann::json();
    return result;
}

nlohmann::json json_of(const FrameJob& job, const FrameOutcome& outcome) {
    nlohmann::json result = json_of(job);
    nlohmann::json kernels = nlohmann::json::object();
    for (const KernelTime& kernel : outcome.kernels) {
        kernels[kernel.kernel] = kernels.value(kernel.kernel, 0.0) + kernel.milliseconds;
    }
    result["stage_ms"] = stages_json(outcome.stages);
    result["kernel_ms"] = kernels;
    result["pixels"] = static_cast<std::int64_t>(outcome.width) * outcome.height;
    result["nonfinite"] = outcome.counts.nonfinite;
    result["clamped"] = outcome.counts.clamped;
    result["no_tangent"] = outcome.counts.no_tangent;
    result["warnings"] = outcome.warnings;
    return result;
}

std::string label_of(const FrameJob& job) {
    return job.number ? fmt::format("frame {}: ", *job.number) : std::string();
}

// The loop over the frames of one run.
class ShadeRun {
  public:
    ShadeRun(const ShadeOptions& options, JsonReport& report, std::vector<FrameJob> jobs)
        : options_(options), report_(report), settings_(settings_of(options)), scene_(choose_scene(options.scene)),
          environment_(scene_.scene, options.common.max_memory), dump_(options.dump_kernel, options.common.kernel_dir),
          jobs_(std::move(jobs)), session_(options.common), progress_(options.common, static_cast<int>(jobs_.size())) {
        settings_.kernel_dump = options.dump_kernel.empty() ? nullptr : &dump_;
    }

    ExitCode run() {
        refuse_what_png_cannot();
        require_environment(scene_.scene, settings_.aovs);
        for (const FrameJob& job : jobs_) {
            shade(job);
            progress_.step();
        }
        progress_.clear();
        if (options_.common.run_stats && !options_.dry_run) {
            fmt::print("\n{}", stats_.text());
        }
        return result();
    }

  private:
    void refuse_what_png_cannot() const {
        const bool more = options_.aovs.size() + options_.keep.size() > 0;
        if (more && is_png(options_.output)) {
            throw UsageError(
                fmt::format("{}: a PNG preview has no room for --aov and --keep; write an .exr", options_.output));
        }
    }

    void shade(const FrameJob& job) {
        try {
            const FrameOutcome outcome = shade_frame(job, scene_, environment_, settings_, session_, progress_);
            if (!outcome.skipped.empty()) {
                report_.add(json_of(job), "skipped", outcome.skipped);
            } else if (options_.dry_run) {
                report_.add(json_of(job), "skipped", "dry run");
            } else {
                report_.set_device(session_.info());
                report_.add(json_of(job, outcome));
                stats_.add(outcome.stages);
                stats_.add(outcome.kernels);
            }
            tell(job, outcome);
        } catch (const DeviceError&) {
            throw; // no frame could do better
        } catch (const Error& error) {
            if (!goes_on_after(job, error)) {
                throw;
            }
        }
    }

    // One frame's failure does not stop a sequence; a job of one frame fails with that frame's own error, and any job
    // with the error of the environment, which all frames share.
    bool goes_on_after(const FrameJob& job, const Error& error) {
        const bool shared = environment_.has_failed();
        const bool skip = options_.skip_bad_frames && !shared && error.exit_code() == ExitCode::runtime_failure;
        report_.add(json_of(job), skip ? "skipped" : "error", error.what());
        progress_.fail(label_of(job) + error.what());
        if (shared || (jobs_.size() == 1 && !skip)) {
            return false;
        }
        first_failure_ = failures_ == 0 ? error.exit_code() : first_failure_;
        ++failures_;
        skipped_bad_ += skip ? 1 : 0;
        if (skip) {
            spdlog::warn("{}skipped: {}", label_of(job), error.what());
        } else {
            fmt::print(stderr, "clshade: {}{}\n", label_of(job), error.what());
        }
        return true;
    }

    void tell(const FrameJob& job, const FrameOutcome& outcome) {
        progress_.clear();
        for (const std::string& warning : outcome.warnings) {
            spdlog::warn("{}{}", label_of(job), warning);
        }
        if (options_.common.quiet) {
            return;
        }
        if (!outcome.plan.empty()) {
            fmt::print("{}", outcome.plan);
        } else if (!outcome.skipped.empty()) {
            fmt::print("{}{} skipped: {}\n", label_of(job), job.output.string(), outcome.skipped);
        } else {
            fmt::print("{}{} -> {}  {}x{}  {}\n", label_of(job), job.input.string(), job.output.string(), outcome.width,
                       outcome.height, format_total(outcome));
        }
        std::fflush(stdout);
    }

    [[nodiscard]] std::string format_total(const FrameOutcome& outcome) const {
        std::string text = fmt::format("{:.0f} ms", outcome.stages.total());
        if (options_.common.verbosity > 0) {
            std::string parts;
            for (const auto& [stage, milliseconds] : outcome.stages.stages()) {
                parts += fmt::format("{}{} {:.1f}", parts.empty() ? "" : ", ", stage, milliseconds);
            }
            text += fmt::format(" ({}{}{}{}{})", parts, outcome.build.empty() ? "" : "; kernel ", outcome.build,
                                outcome.environment.empty() ? "" : "; environment ", outcome.environment);
        }
        return text;
    }

    [[nodiscard]] ExitCode result() const {
        if (failures_ == 0) {
            return ExitCode::ok;
        }
        const bool all = failures_ == jobs_.size() && skipped_bad_ == 0;
        fmt::print(stderr, "clshade: {} of {} frames failed\n", failures_, jobs_.size());
        return all ? first_failure_ : ExitCode::some_frames_failed;
    }

    const ShadeOptions& options_;
    JsonReport& report_;
    ShadeSettings settings_;
    ChosenScene scene_;
    RunEnvironment environment_;
    KernelDump dump_;
    std::vector<FrameJob> jobs_;
    Session session_;
    Progress progress_;
    RunStats stats_;
    std::size_t failures_ = 0;
    std::size_t skipped_bad_ = 0;
    ExitCode first_failure_ = ExitCode::ok;
};

ExitCode shade(const ShadeOptions& options, JsonReport& report) {
    if (options.input.empty()) {
        throw UsageError("shade: INPUT is missing; write `clshade shade INPUT -o OUTPUT`");
    }
    if (options.output.empty()) {
        throw UsageError("shade: -o OUTPUT is missing; write `clshade shade INPUT -o OUTPUT`");
    }
    ShadeRun run(options, report, jobs_of(options));
    return run.run();
}

} // namespace

Action declare_shade(CLI::App& app) {
    auto options = std::make_shared<ShadeOptions>();
    ShadeOptions* o = options.get();
    app.add_option("INPUT", o->input, "G-buffer EXR, or a sequence: in.####.exr, in.#.exr, in.%04d.exr");
    app.add_option("-o,--output", o->output, "what to write: .exr (linear) or .png (preview)")->type_name("OUTPUT");
    add_scene_options(app, o->scene);
    app.add_option("--frames", o->frames, "frames of a sequence: 7, 1-100, 1-100x2, 1,5,10-20. Default: those on disk")
        ->type_name("LIST");
    app.add_option("-d", o->data_type, "pixel type: half | float. Default: half; kept ids and positions stay float")
        ->type_name("TYPE");
    app.add_option("--compression", o->compression,
                   "none | rle | zips | zip | piz | pxr24 | b44 | b44a | dwaa | dwab, with a level for zip (1-9) and "
                   "dwa. Default: zip")
        ->type_name("NAME[:LEVEL]");
    app.add_option("--aov", o->aovs,
                   "also write these planes: diffuse,specular,lights,environment (lights: one for each)")
        ->type_name("LIST");
    app.add_option("--keep", o->keep, "input layers passed through to the output, comma-separated")->type_name("LIST");
    app.add_flag("-u,--update", o->update_only,
                 "skip frames whose output is complete and newer than input, scene and environment");
    app.add_flag("--no-clobber", o->no_clobber, "skip frames whose output exists");
    app.add_flag("--skip-bad-frames", o->skip_bad_frames,
                 "count frames with a missing or unreadable file as skipped, with a warning; the exit code is 4");
    app.add_option("--chunk", o->chunk, "shade only part I of N of the frames")->type_name("I/N");
    app.add_option("--dump-kernel", o->dump_kernel,
                   "also write the program as it is built (generated files among them) and options.txt into DIR, to be "
                   "read; existing files are replaced")
        ->type_name("DIR");
    app.add_flag("-n,--dry-run", o->dry_run,
                 "say what would be done and with which channels; write nothing, no kernel either");
    add_common_options(app, o->common, CommonGroup::running);
    return [options] {
        set_log_level(options->common);
        return with_report(options->common, "shade", [&](JsonReport& report) { return shade(*options, report); });
    };
}

} // namespace clshade::cli
