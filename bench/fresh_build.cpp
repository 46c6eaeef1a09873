#include "bench/fresh_build.h"

#include "host/base/error.h"
#include "host/shading/kernel_library.h"

#include <fmt/format.h>

#include <random>
#include <system_error>

namespace clshade {

BuildFolder::BuildFolder(const std::string& name) : path_(std::filesystem::temp_directory_path() / name) {
    std::error_code error;
    std::filesystem::create_directories(path_, error);
    if (error) {
        throw RuntimeFailure(fmt::format("{}: cannot make a folder for the cold build ({}); set TMPDIR", path_.string(),
                                         error.message()));
    }
}

BuildFolder::~BuildFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string new_mark() {
    std::random_device entropy;
    return fmt::format("clshade_bench_{:08x}{:08x}", entropy(), entropy());
}

SourceSet marked_sources(const std::filesystem::path& kernel_dir, const std::vector<std::string>& mains,
                         const std::string& mark) {
    SourceSet sources = kernel_sources(kernel_dir);
    for (const std::string& main : mains) {
        sources.add(main, fmt::format("{}\ntypedef int {};\n", sources.text(main), mark), main);
    }
    return sources;
}

} // namespace clshade
