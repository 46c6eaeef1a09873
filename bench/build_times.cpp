#include "bench/build_times.h"

#include "host/base/error.h"
#include "host/shading/kernel_library.h"
#include "host/shading/shader.h"

#include <fmt/format.h>

#include <chrono>
#include <random>
#include <string>
#include <system_error>

namespace clshade {

namespace {

/// A folder of our own, gone with its content at the end.
class TemporaryFolder {
  public:
    explicit TemporaryFolder(const std::string& name) : path_(std::filesystem::temp_directory_path() / name) {
        std::error_code error;
        std::filesystem::create_directories(path_, error);
        if (error) {
            throw RuntimeFailure(fmt::format("{}: cannot make a folder for the cold build ({}); set TMPDIR",
                                             path_.string(), error.message()));
        }
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    TemporaryFolder(TemporaryFolder&&) = delete;
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// The kernel sources, the main one with a type that nobody uses: drivers cache what the preprocessor leaves, so a
/// comment would not do.
SourceSet marked_sources(const std::filesystem::path& kernel_dir, const std::string& mark) {
    SourceSet sources = kernel_sources(kernel_dir);
    const std::string main = "shade.cl";
    sources.add(main, fmt::format("{}\ntypedef int {};\n", sources.text(main), mark), main);
    return sources;
}

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

BuildTimes measure_build(Device& device, const BenchScene& scene, const std::filesystem::path& kernel_dir, int lanes) {
    std::random_device entropy;
    const std::string mark = fmt::format("clshade_bench_{:08x}{:08x}", entropy(), entropy());
    const TemporaryFolder folder(mark);
    Frame frame = make_bench_frame(64, 64, 1);
    apply_scene(frame, scene);
    const SourceSet sources = marked_sources(kernel_dir, mark);
    BuildTimes times;
    times.cold_ms = first_launch_ms(device, frame, sources, folder.path(), lanes);
    times.cached_ms = first_launch_ms(device, frame, sources, folder.path(), lanes);
    return times;
}

} // namespace clshade
