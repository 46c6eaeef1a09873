#include "bench/build_times.h"

#include "bench/fresh_build.h"
#include "host/shading/shader.h"

#include <chrono>
#include <string>

namespace clshade {

namespace {

double first_launch_ms(Device& device, Frame& frame, const SourceSet& sources, const std::filesystem::path& cache,
                       int lanes) {
    const auto start = std::chrono::steady_clock::now();
    ShaderOptions options;
    options.lanes = lanes;
    Shader shader(device, sources, ProgramCache(cache), options);
    PreparedFrame prepared = shader.prepare(frame);
    prepared.launch();
    (void)prepared.wait_milliseconds();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

BuildTimes measure_build(Device& device, const BenchScene& scene, const std::filesystem::path& kernel_dir, int lanes,
                         const std::optional<BoundEnvironment>& environment) {
    const std::string mark = new_mark();
    const BuildFolder folder(mark);
    Frame frame = make_bench_frame(64, 64, 1);
    apply_scene(frame, scene, environment);
    const SourceSet sources = marked_sources(kernel_dir, {"shade.cl"}, mark);
    BuildTimes times;
    times.cold_ms = first_launch_ms(device, frame, sources, folder.path(), lanes);
    times.cached_ms = first_launch_ms(device, frame, sources, folder.path(), lanes);
    return times;
}

} // namespace clshade
