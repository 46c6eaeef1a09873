// `bench --tune`: which vector width the device likes best, by measurement.
#include "bench/bench_frame.h"
#include "bench/benchmark.h"
#include "bench/round_robin.h"
#include "bench/statistics.h"
#include "host/base/error.h"
#include "host/shading/kernel_library.h"
#include "host/shading/shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

namespace clshade {

namespace {

constexpr std::array<BenchLights, 2> tuning_lights = {BenchLights::distant1, BenchLights::distant8};

/// One width: its programs and the contestants made of them, one per tuning scene; none if it does not build.
struct Width {
    LaneTime time;
    std::unique_ptr<Shader> shader; ///< keeps the programs
    std::vector<std::size_t> contestants;
};

Width prepare_width(Device& device, const BenchOptions& options, int lanes, Frame& frame,
                    const std::shared_ptr<PictureMemory>& memory, std::vector<Contestant>& contestants) {
    Width width;
    width.time.lanes = lanes;
    try {
        ShaderOptions shader_options;
        shader_options.lanes = lanes;
        width.shader = std::make_unique<Shader>(device, kernel_sources(options.kernel_dir), ProgramCache::standard(),
                                                shader_options);
        std::vector<Contestant> own;
        for (const BenchLights lights : tuning_lights) {
            apply_scene(frame, {.lights = lights});
            const auto prepared = std::make_shared<PreparedFrame>(width.shader->prepare(frame, memory));
            own.push_back({fmt::format("{} lanes", lanes), [prepared] {
                               prepared->launch();
                               return prepared->wait_milliseconds();
                           }});
        }
        for (Contestant& contestant : own) {
            width.contestants.push_back(contestants.size());
            contestants.push_back(std::move(contestant));
        }
    } catch (const RuntimeFailure& failure) {
        width.time.status = BenchStatus::error;
        width.time.reason = failure.what();
    }
    return width;
}

} // namespace

LaneTuning tune_lanes(Device& device, const BenchOptions& options, const BenchProgress& progress) {
    constexpr std::array<int, 4> candidates = {1, 4, 8, 16};
    const bool own_size = options.width > 0 && options.height > 0;
    Frame frame = make_bench_frame(own_size ? options.width : 1280, own_size ? options.height : 720, options.seed);
    const auto memory = std::make_shared<PictureMemory>(device, frame, bench_outputs); // the same pages for all
    std::vector<Contestant> contestants;
    std::vector<Width> widths;
    for (const int lanes : candidates) {
        if (progress) {
            progress(fmt::format("building for {} lanes", lanes), static_cast<int>(widths.size()),
                     static_cast<int>(candidates.size()) + 1);
        }
        widths.push_back(prepare_width(device, options, lanes, frame, memory, contestants));
    }
    const auto first_good = std::find_if(widths.begin(), widths.end(),
                                         [](const Width& width) { return width.time.status == BenchStatus::ok; });
    if (first_good == widths.end()) {
        throw RuntimeFailure(fmt::format("device '{}': the kernels build for no vector width; the last said: {}",
                                         device.info().name, widths.back().time.reason));
    }
    if (progress) {
        progress("timing the vector widths", static_cast<int>(candidates.size()),
                 static_cast<int>(candidates.size()) + 1);
    }
    RoundSettings settings;
    settings.rounds = options.quick ? 3 : std::max(1, options.rounds);
    settings.seconds = options.quick ? 0.0 : options.seconds;
    const std::vector<Timings> timings = run_round_robin(contestants, settings);

    // Each scene's ratio to the first width that builds, so that the longer one does not decide alone.
    LaneTuning tuning;
    double best = std::numeric_limits<double>::infinity();
    for (Width& width : widths) {
        double score = 0.0;
        for (std::size_t scene = 0; width.time.status == BenchStatus::ok && scene < width.contestants.size(); ++scene) {
            const Timings& ours = timings[width.contestants[scene]];
            const Timings& base = timings[first_good->contestants[scene]];
            if (!ours.error.empty() || !base.error.empty()) {
                width.time.status = BenchStatus::error;
                width.time.reason = ours.error.empty() ? base.error : ours.error;
                break;
            }
            width.time.median_ms += median(ours.milliseconds);
            score += paired_ratio(ours.milliseconds, base.milliseconds);
        }
        if (width.time.status == BenchStatus::ok && score < best) {
            best = score;
            tuning.best = width.time.lanes;
        }
        tuning.times.push_back(width.time);
    }
    return tuning;
}

} // namespace clshade
