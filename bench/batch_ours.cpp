#include "bench/batch_ours.h"

#include "host/base/error.h"
#include "host/gbuffer/frame_builder.h"
#include "host/gbuffer/roles.h"
#include "host/images/image_reader.h"
#include "host/scene/scene_file.h"
#include "host/shading/kernel_library.h"

#include <chrono>
#include <optional>
#include <utility>

namespace clshade {

namespace {

constexpr std::string_view scene_text = R"(version = 1
[[light]]
name = "key"
type = "distant"
direction = [0.5, 0.6, -0.7]
irradiance = 3.0
color = [1.0, 0.95, 0.9]
)";

/// A device that is open; the shader is made once.
class Resources final : public BatchResources {
  public:
    Resources(Device& device, const BenchOptions& options) : device_(device) {
        ShaderOptions shader_options;
        shader_options.lanes = options.lanes;
        shader_.emplace(device, kernel_sources(options.kernel_dir), ProgramCache::standard(), shader_options);
    }
    Shader& shader() override { return *shader_; }
    const DeviceInfo& device() override { return device_.info(); }
    const EnvironmentInput* environment(StageTimes& /*stages*/) override { return nullptr; }

  private:
    Device& device_;
    std::optional<Shader> shader_;
};

/// Adds up what was read and written; the first failure ends the run.
class Sums final : public BatchListener {
  public:
    void finished(const FrameJob& /*job*/, const FrameOutcome& outcome) override {
        run.bytes_read += outcome.bytes_read;
        run.bytes_written += outcome.bytes_written;
        ++frames;
    }
    bool failed(const FrameJob& /*job*/, const std::exception_ptr& /*failure*/) override { return false; }

    OurRun run;
    std::size_t frames = 0;
};

} // namespace

struct BatchContestant::State {
    State(Device& device, const BenchOptions& options, int thread_count)
        : resources(device, options), threads(thread_count) {
        scene.scene = parse_scene(scene_text, "bench.toml", {}, {});
        scene.name = "bench";
        scene.hash = "bench";
    }
    Resources resources;
    RunScene scene;
    int threads;
};

BatchContestant::BatchContestant(Device& device, const BenchOptions& options, int threads)
    : state_(std::make_unique<State>(device, options, threads)) {}
BatchContestant::~BatchContestant() = default;
BatchContestant::BatchContestant(BatchContestant&&) noexcept = default;
BatchContestant& BatchContestant::operator=(BatchContestant&&) noexcept = default;

OurRun BatchContestant::run(const OurWork& work) {
    std::vector<FrameJob> jobs;
    for (std::size_t i = 0; i < work.inputs.size(); ++i) {
        jobs.push_back({static_cast<int>(i) + 1, work.inputs[i], work.outputs.at(i), {}});
    }
    BatchSettings settings;
    settings.exr = encoding_of(work.half, work.compression);
    settings.threads = state_->threads;
    Sums sums;
    const auto start = std::chrono::steady_clock::now();
    run_batch(jobs, state_->scene, settings, state_->resources, sums);
    sums.run.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (sums.frames != jobs.size()) {
        throw RuntimeFailure("the batch ended before all frames were done");
    }
    return sums.run;
}

std::vector<std::string> BatchContestant::channels(const std::filesystem::path& file) const {
    const ImageLayout layout = read_layout(file);
    const Scene& scene = state_->scene.scene;
    const FramePlan plan = plan_frame(layout, assign_roles(layout, scene.gbuffer, {}), scene);
    std::vector<std::string> names;
    for (const int channel : plan.channels) {
        names.push_back(layout.channels.at(static_cast<std::size_t>(channel)).file_name);
    }
    return names;
}

const Light& BatchContestant::light() const {
    return state_->scene.scene.lights.front();
}

ExrSettings encoding_of(bool half, const std::string& compression) {
    ExrSettings settings;
    settings.half = half;
    const std::size_t colon = compression.find(':');
    settings.compression = compression.substr(0, colon);
    if (colon != std::string::npos) {
        settings.level = std::stod(compression.substr(colon + 1));
    }
    check_exr_settings(settings);
    return settings;
}

} // namespace clshade
