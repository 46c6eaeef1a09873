#include "host/cli/shade_frame.h"

#include "host/base/error.h"
#include "host/cli/stopwatch.h"
#include "host/shading/material_code.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace clshade::cli {

namespace {

// Why the frame need not be shaded; empty: it must be.
std::string reason_to_skip(const FrameJob& job, const ChosenScene& scene, const ShadeSettings& settings) {
    std::error_code ignored;
    if (settings.no_clobber && std::filesystem::exists(job.output, ignored)) {
        return "the output exists (--no-clobber)";
    }
    std::vector<std::filesystem::path> sources{job.input, scene.file};
    for (const auto& more : {scene.tables, scene.environment}) {
        sources.insert(sources.end(), more.begin(), more.end());
    }
    if (settings.update_only && is_up_to_date(job.output, sources)) {
        return "the output is up to date (-u)";
    }
    return {};
}

std::string plan_text(const PlannedInput& input, const FrameJob& job, const ChosenScene& scene,
                      const EnvironmentInput* environment, const DeviceInfo& device) {
    const Frame& frame = input.plan.frame;
    std::string text =
        fmt::format("would shade {} -> {}\n  {}x{} pixels, {} planes read of {} channels\n"
                    "  camera: {}\n  scene: {}, {} lights\n  device: {}/{}\n",
                    job.input.string(), job.output.string(), frame.data_window.width(), frame.data_window.height(),
                    input.plan.channels.size(), input.layout.channels.size(), camera_source(input, scene.scene),
                    scene.name, frame.lights.size(), device.platform, device.name);
    text += fmt::format("  environment: {}{}\n",
                        environment == nullptr ? "none"
                                               : fmt::format("{}, {}", environment->name, environment->description()),
                        scene.scene.background ? ", shown as background" : "");
    for (const BoundMaterial& material : frame.materials) {
        text += fmt::format("  material {}: {}\n", material.name, model_key(material));
    }
    return text + "\n" + roles_text(input);
}

// Of metals whose curves are not exact; other materials have none.
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

} // namespace

FrameOutcome shade_frame(const FrameJob& job, const ChosenScene& scene, RunEnvironment& environment,
                         const ShadeSettings& settings, Session& session, Progress& progress) {
    FrameOutcome outcome;
    refuse_same_file(job.output, job.input);
    refuse_same_file(job.output, scene.file);
    for (const std::filesystem::path& file : scene.environment) {
        refuse_same_file(job.output, file);
    }
    if (!settings.dry_run) {
        check_output_path(job.output);
    }
    outcome.skipped = reason_to_skip(job, scene, settings);
    if (!outcome.skipped.empty()) {
        return outcome;
    }
    const std::string name = job.input.filename().string();
    Stopwatch watch;
    progress.update("reading " + name, 0.0);
    PlannedInput planned = plan_input(job.input, scene.scene, settings.view, settings.keep);
    outcome.width = planned.plan.frame.data_window.width();
    outcome.height = planned.plan.frame.data_window.height();
    outcome.stages.add("read", watch.lap());
    const EnvironmentInput* surroundings = environment.read(outcome.stages);
    if (settings.dry_run) {
        outcome.plan = plan_text(planned, job, scene, surroundings, session.info());
        outcome.warnings = environment.take_warnings();
        return outcome;
    }
    watch.lap();
    Shader& shader = session.shader(settings.aovs);
    outcome.stages.add("device", watch.lap());
    outcome.environment = environment.prefilter(shader, progress, outcome.stages);
    watch.lap();
    LoadedFrame loaded = load_frame(std::move(planned), scene.scene, settings.threads);
    environment.attach(loaded.frame);
    outcome.stages.add("read", watch.lap());

    progress.update("shading " + name, 0.3);
    if (settings.kernel_dump != nullptr) {
        settings.kernel_dump->add(shader, loaded.frame); // before the build, so that one that fails can be read
        outcome.stages.add("dump", watch.lap());
    }
    std::vector<std::string> of_materials = material_warnings(loaded.frame);
    const ShadedImage shaded = shader.shade(loaded.frame);
    const double shading = watch.lap();
    const double kernel = sum_of(shaded.kernel_times);
    const bool first = session.is_new_program(shaded.identity);
    const double build = first ? shaded.build_milliseconds : 0.0;
    outcome.stages.add("build", build);
    outcome.stages.add("transfer", shaded.transfer_milliseconds);
    outcome.stages.add("kernel", kernel);
    const double rest = shading - build - shaded.transfer_milliseconds - kernel;
    outcome.stages.add("prepare", rest > 0.0 ? rest : 0.0);
    outcome.kernels = shaded.kernel_times;
    outcome.counts = shaded.counts;
    outcome.build = !first ? "" : (shaded.built_from_cache ? "from the cache" : "built");
    refuse_filtered_ids(job.input.string(), shaded.counts);

    progress.update("writing " + job.output.filename().string(), 0.6);
    const OutputImage image = make_output(loaded, shaded, scene, surroundings, session.info());
    const std::uint64_t too_large = write_output(job.output, image, settings.exr);
    if (!job.preview.empty()) {
        write_png(job.preview, image);
    }
    outcome.stages.add("write", watch.lap());
    outcome.warnings = environment.take_warnings();
    std::move(loaded.warnings.begin(), loaded.warnings.end(), std::back_inserter(outcome.warnings));
    std::move(of_materials.begin(), of_materials.end(), std::back_inserter(outcome.warnings));
    if (too_large > 0) {
        outcome.warnings.push_back(fmt::format("{}: {} values beyond 65504 do not fit in half and were clamped; write "
                                               "-d float",
                                               job.output.string(), too_large));
    }
    for (std::string& warning : count_warnings(job.input.string(), shaded.counts)) {
        outcome.warnings.push_back(std::move(warning));
    }
    return outcome;
}

void refuse_filtered_ids(const std::string& file, const PixelCounts& counts) {
    if (counts.fractional_ids > 0) {
        throw UsageError(fmt::format("{}: material ids are filtered: {} pixels hold fractions; give a plane rendered "
                                     "without a filter in [gbuffer] material_id",
                                     file, counts.fractional_ids));
    }
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

} // namespace clshade::cli
