#include "host/cli/shade_run.h"

#include "host/base/error.h"
#include "host/base/stopwatch.h"
#include "host/batch/update_check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <system_error>

namespace clshade::cli {

namespace {

std::string label_of(const FrameJob& job) {
    return job.number ? fmt::format("frame {}: ", *job.number) : std::string();
}

nlohmann::json json_of(const FrameJob& job) {
    nlohmann::json result = {{"input", job.input.string()}, {"output", job.output.string()}};
    result["frame"] = job.number ? nlohmann::json(*job.number) : nlohmann::json();
    if (!job.preview.empty()) {
        result["preview"] = job.preview.string();
    }
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
    result["bands"] = outcome.bands;
    result["nonfinite"] = outcome.counts.nonfinite;
    result["clamped"] = outcome.counts.clamped;
    result["no_tangent"] = outcome.counts.no_tangent;
    result["camera"] = outcome.camera;
    result["program"] = outcome.program;
    result["input_hash"] = outcome.input_hash;
    result["output_hash"] = outcome.output_hash;
    result["bytes_read"] = outcome.bytes_read;
    result["bytes_written"] = outcome.bytes_written;
    result["warnings"] = outcome.warnings;
    return result;
}

std::vector<std::filesystem::path> tools(const CommonOptions& options) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (!error) {
        files.push_back(program);
    }
    if (!options.kernel_dir.empty()) {
        for (const auto& entry : std::filesystem::directory_iterator(options.kernel_dir, error)) {
            files.push_back(entry.path());
        }
    }
    return files;
}

} // namespace

BatchSettings batch_settings(const CommonOptions& options) {
    BatchSettings settings;
    settings.threads = options.host_threads();
    settings.max_memory = options.max_memory;
    settings.hash_inputs = !options.json_file.empty();
    settings.tools = tools(options);
    return settings;
}

ShadeRun::ShadeRun(const CommonOptions& common, const RunScene& scene, const BatchSettings& settings, Session& session,
                   Progress& progress, JsonReport& report, ShadeRunOptions options)
    : common_(common), scene_(scene), settings_(settings), session_(session), progress_(progress), report_(report),
      options_(std::move(options)), dump_(options_.dump_kernel, common.kernel_dir),
      resources_(scene, settings.aovs, common.max_memory, session, progress,
                 options_.dump_kernel.empty() ? nullptr : &dump_) {}

ExitCode ShadeRun::run(const std::vector<FrameJob>& jobs) {
    const Stopwatch watch;
    jobs_ = jobs.size();
    report_.set("scene", scene_.name);
    report_.set("scene_hash", scene_.hash);
    report_.set("job", job_identity(scene_, settings_));
    run_batch(jobs, scene_, settings_, resources_, *this);
    stats_.finish(watch.milliseconds(), settings_.threads);
    report_.set("run", stats_.json());
    progress_.clear();
    if (repeated_ > 0) {
        spdlog::warn("the same warnings came {} times more in later frames; -v prints them, --json has them by frame",
                     repeated_);
    }
    if (common_.max_memory > 0 && peak_memory() > static_cast<double>(common_.max_memory) && !common_.quiet) {
        spdlog::warn(
            "--max-mem {}: {:.0f} MiB were used at most; program, kernels and the smallest band take that much",
            common_.max_memory >> 20U, peak_memory() / (1 << 20));
    }
    if (common_.run_stats) {
        fmt::print("\n{}", stats_.text());
    }
    return result();
}

void ShadeRun::doing(const FrameJob& job, const std::string& what) {
    // Of a sequence the bar tells how many frames are done; of one frame what is being done.
    if (jobs_ == 1) {
        constexpr double read_ends = 0.3;
        constexpr double shade_ends = 0.6;
        const double part = what == "reading" ? 0.0 : (what == "shading" ? read_ends : shade_ends);
        progress_.update(what + " " + (what == "writing" ? job.output : job.input).filename().string(), part);
    }
}

void ShadeRun::finished(const FrameJob& job, const FrameOutcome& outcome) {
    ++finished_;
    stats_.add(outcome);
    if (!outcome.skipped.empty()) {
        report_.add(json_of(job), "skipped", outcome.skipped);
    } else {
        report_.set_device(session_.info());
        report_.add(json_of(job, outcome));
    }
    progress_.set_slowest(stats_.slowest_stage());
    tell(job, outcome);
    if (outcome.skipped.empty()) {
        progress_.step();
    } else {
        progress_.skip();
    }
}

bool ShadeRun::failed(const FrameJob& job, const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const DeviceError&) {
        return false; // no frame could do better
    } catch (const Error& error) {
        return goes_on_after(job, error);
    } catch (const std::bad_alloc&) {
        return goes_on_after(job, RuntimeFailure(fmt::format("{}: out of memory; use --max-mem", job.input.string())));
    } catch (const std::exception& error) {
        return goes_on_after(job, RuntimeFailure(fmt::format("{}: {}", job.input.string(), error.what())));
    }
}

// One frame's failure does not stop a sequence; a job of one frame fails with that frame's own error, and any job with
// the error of the environment, which all frames share.
bool ShadeRun::goes_on_after(const FrameJob& job, const Error& error) {
    const bool shared = resources_.environment_failed();
    const bool skip = options_.skip_bad_frames && !shared && error.exit_code() == ExitCode::runtime_failure;
    report_.add(json_of(job), skip ? "skipped" : "error", error.what());
    progress_.fail(label_of(job) + error.what());
    if (shared || (jobs_ == 1 && !skip)) {
        return false;
    }
    first_failure_ = failures_.empty() ? error.exit_code() : first_failure_;
    failures_.push_back(job.number ? std::to_string(*job.number) : job.input.string());
    skipped_bad_ += skip ? 1 : 0;
    progress_.print([&] {
        if (skip) {
            spdlog::warn("{}skipped: {}", label_of(job), error.what());
        } else {
            fmt::print(stderr, "clshade: {}{}\n", label_of(job), error.what());
        }
    });
    progress_.skip();
    return true;
}

void ShadeRun::tell(const FrameJob& job, const FrameOutcome& outcome) {
    progress_.print([&] {
        for (const std::string& warning : outcome.warnings) {
            // What a whole sequence suffers from is said once.
            if (told_.insert(warning).second || common_.verbosity > 0) {
                spdlog::warn("{}{}", label_of(job), warning);
            } else {
                ++repeated_;
            }
        }
        for (const std::string& note : outcome.notes) {
            spdlog::info("{}{}: {}", label_of(job), job.input.string(), note);
        }
        if (common_.quiet || !options_.tell_frames) {
            return;
        }
        if (!outcome.skipped.empty()) {
            fmt::print("{}{} skipped: {}\n", label_of(job), job.output.string(), outcome.skipped);
        } else {
            fmt::print("{}{} -> {}  {}x{}  {}\n", label_of(job), job.input.string(), job.output.string(), outcome.width,
                       outcome.height, times_text(outcome));
        }
        std::fflush(stdout);
    });
}

std::string ShadeRun::times_text(const FrameOutcome& outcome) const {
    std::string text = fmt::format("{:.0f} ms", outcome.stages.total());
    if (outcome.bands > 1) {
        text += fmt::format(" in {} bands", outcome.bands);
    }
    if (common_.verbosity > 0) {
        std::string parts;
        for (const auto& [stage, milliseconds] : outcome.stages.stages()) {
            parts += fmt::format("{}{} {:.1f}", parts.empty() ? "" : ", ", stage, milliseconds);
        }
        text += fmt::format(" ({}{}{}{}{})", parts, outcome.build.empty() ? "" : "; kernel ", outcome.build,
                            outcome.environment.empty() ? "" : "; environment ", outcome.environment);
    }
    return text;
}

ExitCode ShadeRun::result() const {
    if (stop_.requested()) {
        report_.set("interrupted", true);
        fmt::print(stderr, "clshade: interrupted: {} of {} frames done; -u goes on from there\n", finished_, jobs_);
        return stop_.exit_code();
    }
    if (failures_.empty()) {
        return ExitCode::ok;
    }
    fmt::print(stderr, "clshade: {} of {} frames failed: {}\n", failures_.size(), jobs_, fmt::join(failures_, ", "));
    const bool all = failures_.size() == jobs_ && skipped_bad_ == 0;
    return all ? first_failure_ : ExitCode::some_frames_failed;
}

} // namespace clshade::cli
