#include "host/shading/kernel_library.h"

#include <string>
#include <utility>
#include <vector>

namespace clshade {

std::vector<std::pair<std::string, std::string>> embedded_kernels(); // generated from kernels/ at build time

SourceSet kernel_sources(const std::filesystem::path& kernel_dir) {
    SourceSet sources;
    for (auto& [name, text] : embedded_kernels()) {
        sources.add(name, std::move(text), "kernels/" + name);
    }
    if (!kernel_dir.empty()) {
        sources.override_from(kernel_dir);
    }
    return sources;
}

} // namespace clshade
