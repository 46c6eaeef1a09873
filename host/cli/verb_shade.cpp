#include "host/base/error.h"
#include "host/base/frame_range.h"
#include "host/base/suggest.h"
#include "host/batch/frame_output.h"
#include "host/batch/update_check.h"
#include "host/cli/chosen_scene.h"
#include "host/cli/environment_input.h"
#include "host/cli/log_level.h"
#include "host/cli/plan_text.h"
#include "host/cli/report_json.h"
#include "host/cli/shade_run.h"
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

// "NAME" or "NAME:LEVEL" of --compression.
void parse_compression(const std::string& text, ExrSettings& settings) {
    const std::size_t colon = text.find(':');
    settings.compression = text.substr(0, colon);
    if (colon != std::string::npos) {
        settings.level = parse_number("--compression level", text.substr(colon + 1), 0.0);
    }
    check_exr_settings(settings);
}

BatchSettings settings_of(const ShadeOptions& options) {
    BatchSettings settings = batch_settings(options.common);
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
    if (chosen.empty() && !options.common.quiet) {
        fmt::print("chunk {} of {} frames holds none: nothing to do\n", options.chunk, jobs.size());
    }
    return chosen;
}

// A PNG preview has no room for more than a picture.
void refuse_what_png_cannot(const ShadeOptions& options) {
    if (options.aovs.size() + options.keep.size() > 0 && is_png(options.output)) {
        throw UsageError(
            fmt::format("{}: a PNG preview has no room for --aov and --keep; write an .exr", options.output));
    }
}

// -n: what would be done with each frame, in words. Reads headers and the environment's, writes nothing.
ExitCode dry_run(const ShadeOptions& options, const std::vector<FrameJob>& jobs, const RunScene& scene,
                 const BatchSettings& settings, JsonReport& report) {
    Session session(options.common);
    std::optional<EnvironmentInput> environment;
    ExitCode code = ExitCode::ok;
    for (const FrameJob& job : jobs) {
        nlohmann::json result = {{"input", job.input.string()}, {"output", job.output.string()}};
        result["frame"] = job.number ? nlohmann::json(*job.number) : nlohmann::json();
        try {
            refuse_same_file(job.output, job.input);
            std::string reason = reason_to_skip(job, scene, settings, job_identity(scene, settings));
            if (!reason.empty()) {
                fmt::print("would skip {}: {}\n", job.output.string(), reason);
            } else {
                reason = "dry run";
                const PlannedInput input = plan_input(job.input, scene.scene, settings.view, settings.keep, job.number);
                if (scene.scene.environment && !environment) {
                    environment = read_environment(scene.scene, options.common.max_memory);
                    for (const std::string& warning : environment->warnings) {
                        spdlog::warn(warning);
                    }
                }
                fmt::print("{}", plan_text(input, job, scene, environment ? &*environment : nullptr, session.info()));
            }
            report.add(std::move(result), "skipped", reason);
        } catch (const DeviceError&) {
            throw;
        } catch (const Error& error) {
            if (jobs.size() == 1) {
                throw;
            }
            report.add(std::move(result), "error", error.what());
            fmt::print(stderr, "clshade: {}\n", error.what());
            code = ExitCode::some_frames_failed;
        }
    }
    return code;
}

ExitCode shade(const ShadeOptions& options, JsonReport& report) {
    if (options.input.empty()) {
        throw UsageError("shade: INPUT is missing; write `clshade shade INPUT -o OUTPUT`");
    }
    if (options.output.empty()) {
        throw UsageError("shade: -o OUTPUT is missing; write `clshade shade INPUT -o OUTPUT`");
    }
    const std::vector<FrameJob> jobs = jobs_of(options);
    const BatchSettings settings = settings_of(options);
    const RunScene scene = choose_scene(options.scene);
    refuse_what_png_cannot(options);
    require_environment(scene.scene, settings.aovs);
    if (options.dry_run) {
        return dry_run(options, jobs, scene, settings, report);
    }
    Session session(options.common);
    Progress progress(options.common, static_cast<int>(jobs.size()));
    ShadeRun run(options.common, scene, settings, session, progress, report,
                 {options.skip_bad_frames, true, options.dump_kernel});
    return run.run(jobs);
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
                 "skip frames whose output is complete, of the same scene and flags, and newer than its sources");
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
