#include "host/batch/frame_stages.h"

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/stopwatch.h"
#include "host/batch/banded_input.h"
#include "host/batch/frame_output.h"
#include "host/batch/memory.h"
#include "host/batch/update_check.h"
#include "host/gbuffer/environment_binding.h"
#include "host/scene/frame_camera.h"
#include "host/shading/material_code.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace clshade {

namespace {

/// Of metals whose curves are not exact; other materials have none.
std::vector<std::string> material_warnings(const Frame& frame) {
    const auto is_spectral = [](const BoundLayer& layer) {
        return layer.specular == SpecularModel::blinn_phong_spectral;
    };
    const bool any = std::any_of(frame.materials.begin(), frame.materials.end(), [&](const BoundMaterial& material) {
        return std::any_of(material.layers.begin(), material.layers.end(), is_spectral);
    });
    return any ? materials_source(frame).warnings : std::vector<std::string>{};
}

double sum_of(const std::vector<KernelTime>& kernels) {
    double sum = 0.0;
    for (const KernelTime& kernel : kernels) {
        sum += kernel.milliseconds;
    }
    return sum;
}

void append(std::vector<std::string>& all, std::vector<std::string> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
}

std::vector<std::string> count_warnings(const std::string& file, const PixelCounts& counts) {
    std::vector<std::string> warnings;
    if (counts.nonfinite > 0) {
        warnings.push_back(fmt::format("{}: {} pixels with NaN or Inf are written as 0", file, counts.nonfinite));
    }
    if (counts.clamped > 0) {
        warnings.push_back(
            fmt::format("{}: {} pixels with a parameter out of its range; it was clamped", file, counts.clamped));
    }
    if (counts.no_tangent > 0) {
        warnings.push_back(
            fmt::format("{}: {} pixels of anisotropic materials have a tangent that is missing or parallel "
                        "to the normal; a frame around the normal stands in",
                        file, counts.no_tangent));
    }
    return warnings;
}

FileState state_of(const std::filesystem::path& file) {
    std::error_code ignored; // whoever reads the file tells what is wrong with it
    FileState state;
    state.size = std::filesystem::file_size(file, ignored);
    state.written = std::filesystem::last_write_time(file, ignored);
    return state;
}

void refuse_filtered_ids(const std::string& file, const PixelCounts& counts) {
    if (counts.fractional_ids > 0) {
        throw UsageError(fmt::format("{}: material ids are filtered: {} pixels hold fractions; give a plane rendered "
                                     "without a filter in [gbuffer] material_id",
                                     file, counts.fractional_ids));
    }
}

} // namespace

FrameStages::FrameStages(const RunScene& scene, const BatchSettings& settings, BatchResources& resources,
                         BatchListener& listener)
    : scene_(scene), settings_(settings), resources_(resources), listener_(listener),
      identity_(job_identity(scene, settings)) {}

void FrameStages::plan(FrameWork& work) const {
    const FrameJob& job = *work.job;
    const Stopwatch watch;
    for (const std::filesystem::path& source :
         {job.input, std::filesystem::path(scene_.file), camera_file_of_frame(scene_.scene, job.number)}) {
        refuse_same_file(job.output, source);
    }
    for (const std::filesystem::path& source : scene_.environment) {
        refuse_same_file(job.output, source);
    }
    check_output_path(job.output);
    work.outcome.skipped = reason_to_skip(job, scene_, settings_, identity_);
    if (!work.outcome.skipped.empty()) {
        work.done = true;
        return;
    }
    work.input = state_of(job.input);
    work.planned = plan_input(job.input, scene_.scene, settings_.view, settings_.keep, job.number);
    work.outcome.width = work.planned.plan.frame.data_window.width();
    work.outcome.height = work.planned.plan.frame.data_window.height();
    work.outcome.camera = work.planned.camera_source;
    work.outcome.stages.add("read", watch.milliseconds());
}

int FrameStages::outputs_of(const FrameWork& work) const {
    AovSelection aovs = settings_.aovs;
    aovs.environment = false; // the planned frame has none yet
    const auto others = static_cast<int>(output_plane_names(work.planned.plan.frame, aovs).size());
    return others + (settings_.aovs.environment ? 3 : 0);
}

void FrameStages::read(FrameWork& work) {
    listener_.doing(*work.job, "reading");
    const Stopwatch watch;
    if (settings_.hash_inputs) {
        work.outcome.input_hash = file_hash_hex(work.job->input);
    }
    const Window& window = work.planned.plan.frame.data_window;
    PlaneSlab planes = pool_.take(window.width(), window.height(), static_cast<int>(work.planned.plan.channels.size()));
    work.loaded = load_frame(std::move(work.planned), std::move(planes));
    work.outcome.bytes_read = work.loaded.bytes_read;
    work.outcome.busy_milliseconds += work.loaded.busy_milliseconds;
    work.outcome.stages.add("read", watch.milliseconds());
}

Shader& FrameStages::prepare(FrameWork& work) {
    const Stopwatch watch;
    Shader& shader = resources_.shader();
    work.device = &resources_.device();
    work.outcome.stages.add("device", watch.milliseconds());
    work.environment = resources_.environment(work.outcome.stages);
    if (work.environment != nullptr) {
        attach_environment(work.loaded.frame, scene_.scene, work.environment->image, work.environment->maps);
        work.outcome.environment = resources_.take_environment_origin();
        if (!environment_told_) {
            append(work.outcome.warnings, work.environment->warnings);
            environment_told_ = true;
        }
    }
    resources_.about_to_shade(work.loaded.frame);
    listener_.doing(*work.job, "shading");
    append(work.outcome.warnings, material_warnings(work.loaded.frame));
    return shader;
}

void FrameStages::account(FrameWork& work, const ShadedImage& shaded, double elapsed) {
    FrameOutcome& outcome = work.outcome;
    const double kernel = sum_of(shaded.kernel_times);
    const bool first = programs_.insert(shaded.identity).second;
    const double rest = std::max(0.0, elapsed - shaded.transfer_milliseconds - kernel);
    // What the driver compiles, it compiles at the first launch; then come the maps for one exponent each.
    outcome.stages.add("build", first ? rest : 0.0);
    outcome.stages.add("transfer", shaded.transfer_milliseconds);
    outcome.stages.add("kernel", kernel);
    outcome.stages.add("prepare", first ? 0.0 : rest);
    outcome.kernels.insert(outcome.kernels.end(), shaded.kernel_times.begin(), shaded.kernel_times.end());
    outcome.counts.nonfinite += shaded.counts.nonfinite;
    outcome.counts.clamped += shaded.counts.clamped;
    outcome.counts.fractional_ids += shaded.counts.fractional_ids;
    outcome.counts.no_tangent += shaded.counts.no_tangent;
    outcome.program = shaded.identity;
    if (first) {
        outcome.build = shaded.built_from_cache ? "from the cache" : "built";
    }
}

void FrameStages::shade(FrameWork& work) {
    Shader& shader = prepare(work);
    const Stopwatch watch;
    Frame& frame = work.loaded.frame;
    const auto outputs = static_cast<int>(output_plane_names(frame, settings_.aovs).size());
    work.shaded = shader.shade(frame, pool_.take(frame.planes.width(), frame.planes.height(), outputs));
    account(work, work.shaded, watch.milliseconds());
    refuse_filtered_ids(work.job->input.string(), work.outcome.counts);
}

void FrameStages::accept_file(FrameWork& work, const WrittenFile& file, const std::filesystem::path& path) const {
    FrameOutcome& outcome = work.outcome;
    outcome.bytes_written += file.bytes;
    outcome.busy_milliseconds += file.busy_milliseconds;
    if (path == work.job->output) {
        outcome.output_hash = fmt::format("{:016x}", file.hash);
    }
    if (file.existed) {
        outcome.skipped = "another process wrote the output first (--no-clobber)";
    }
    if (file.clamped > 0) {
        outcome.warnings.push_back(fmt::format("{}: {} values beyond 65504 do not fit in half and were clamped; write "
                                               "-d float",
                                               path.string(), file.clamped));
    }
}

void FrameStages::write(FrameWork& work) {
    listener_.doing(*work.job, "writing");
    const Stopwatch watch;
    const FrameJob& job = *work.job;
    const OutputImage image = make_output(work.loaded, work.shaded, scene_, work.environment, *work.device, identity_);
    refuse_changed(work);
    accept_file(work, write_output(job.output, image, settings_.exr, replace()), job.output);
    if (!job.preview.empty()) {
        accept_file(work, write_png(job.preview, image, replace()), job.preview);
    }
    work.outcome.stages.add("write", watch.milliseconds());
    finish(work);
}

void FrameStages::shade_in_bands(FrameWork& work, std::uint64_t limit) {
    const FrameJob& job = *work.job;
    if (is_png(job.output) || !job.preview.empty()) {
        throw UsageError(fmt::format("{}: {}x{} pixels do not fit into the memory there is for a frame, and a PNG "
                                     "cannot be written in bands; write an .exr or raise --max-mem",
                                     job.output.string(), work.outcome.width, work.outcome.height));
    }
    if (settings_.hash_inputs) {
        work.outcome.input_hash = file_hash_hex(job.input);
    }
    listener_.doing(job, "reading");
    Stopwatch watch;
    const std::uint64_t now = resident_memory();
    BandedInput input(std::move(work.planned), limit > now ? (limit - now) / 2 : 0, block_rows(settings_.exr));
    work.loaded = input.take();
    work.outcome.stages.add("read", watch.milliseconds());
    Shader& shader = prepare(work);

    Frame& frame = work.loaded.frame;
    const int height = frame.data_window.height();
    const int outputs = static_cast<int>(output_plane_names(frame, settings_.aovs).size());
    std::optional<ExrWriter> writer;
    int rows = input.smallest_band();
    work.outcome.bands = 0;
    for (int first = 0; first < height && !listener_.interrupted(); first += rows) {
        if (work.outcome.bands == 1) { // the kernel is built by now, so that what remains is known
            const std::uint64_t used = resident_memory();
            rows = input.largest_band(limit > used ? limit - used : 0, outputs);
        }
        const int count = std::min(rows, height - first);
        watch.lap();
        input.read(frame, first, count);
        work.outcome.stages.add("read", watch.lap());
        ShadedImage shaded = shader.shade(frame, std::move(work.shaded.planes));
        account(work, shaded, watch.lap());
        refuse_filtered_ids(job.input.string(), work.outcome.counts);
        const OutputImage image = make_output(work.loaded, shaded, scene_, work.environment, *work.device, identity_);
        if (!writer) {
            writer.emplace(job.output, image, settings_.exr, replace());
        }
        writer->write(image.channels, 0, count);
        work.outcome.stages.add("write", watch.lap());
        work.shaded = std::move(shaded);
        ++work.outcome.bands;
    }
    if (listener_.interrupted()) {
        return;
    }
    refuse_changed(work);
    watch.lap();
    accept_file(work, writer->commit(), job.output);
    work.outcome.stages.add("write", watch.lap());
    work.outcome.bytes_read = input.bytes_read();
    work.outcome.busy_milliseconds += input.busy_milliseconds();
    finish(work);
}

void FrameStages::refuse_changed(const FrameWork& work) {
    if (!(state_of(work.job->input) == work.input)) {
        throw RuntimeFailure(fmt::format("{}: was written anew while it was shaded; run again when its writer has "
                                         "finished",
                                         work.job->input.string()));
    }
}

void FrameStages::finish(FrameWork& work) const {
    try {
        refuse_changed(work);
    } catch (const RuntimeFailure&) {
        if (work.outcome.skipped.empty()) { // else the file is another process's
            std::error_code ignored;
            std::filesystem::last_write_time(work.job->output, work.input.written, ignored);
        }
        throw;
    }
    append(work.outcome.warnings, std::move(work.loaded.warnings));
    append(work.outcome.notes, std::move(work.loaded.frame.notes));
    append(work.outcome.warnings, count_warnings(work.job->input.string(), work.outcome.counts));
    work.done = true;
}

void FrameStages::release(FrameWork& work) {
    pool_.give(std::move(work.loaded.frame.planes));
    pool_.give(std::move(work.shaded.planes));
    work.planned = {};
    work.loaded = {};
    work.shaded = {};
}

} // namespace clshade
