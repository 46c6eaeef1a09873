#include "host/cli/environment_input.h"

#include "host/base/error.h"
#include "host/cli/environment_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace clshade::cli {

namespace {

std::vector<std::string> reading_warnings(const std::string& file, const LatLong& image) {
    std::vector<std::string> warnings;
    if (image.negative > 0 || image.nonfinite > 0) {
        warnings.push_back(
            fmt::format("{}: {} texels were negative, {} not finite: set to 0", file, image.negative, image.nonfinite));
    }
    if (image.halvings > 0) {
        warnings.push_back(fmt::format("{}: halved {} to {}x{} to fit into --max-mem", file,
                                       image.halvings == 1 ? "once" : fmt::format("{} times", image.halvings),
                                       image.width, image.height));
    }
    return warnings;
}

} // namespace

EnvironmentInput read_environment(const Scene& scene, std::uint64_t max_memory) {
    EnvironmentInput input;
    const std::filesystem::path path = environment_path(scene);
    if (path.empty()) {
        input.name = "built-in studio";
        input.image = std::make_shared<const LatLong>(built_in_studio());
        input.hash = content_hash(*input.image);
        return input;
    }
    input.name = scene.environment->image;
    EnvironmentFile file = read_environment_file(path, max_memory, scene.background);
    if (file.maps) {
        input.maps = std::make_shared<const FilteredSet>(std::move(*file.maps));
        input.hash = input.maps->hash;
    } else {
        input.warnings = reading_warnings(path.string(), file.image);
        input.image = std::make_shared<const LatLong>(std::move(file.image));
        input.hash = content_hash(*input.image);
    }
    return input;
}

PrefilterReport prefilter_environment(EnvironmentInput& input, Shader& shader, Progress& progress, double from,
                                      double to) {
    PrefilterReport report;
    if (input.maps == nullptr) {
        const std::string what = "pre-filtering " + std::filesystem::path(input.name).filename().string();
        const auto tell = [&](double share) { progress.update(what, from + (to - from) * share); };
        input.maps = std::make_shared<const FilteredSet>(shader.prefilter().filter(*input.image, tell, &report));
    }
    return report;
}

std::vector<std::filesystem::path> environment_files(const Scene& scene) {
    const std::filesystem::path path = environment_path(scene);
    if (path.empty()) {
        return {};
    }
    std::vector<std::filesystem::path> files{path};
    std::error_code ignored; // what cannot be listed is told of when it is read
    for (const auto& entry : std::filesystem::directory_iterator(path, ignored)) {
        files.push_back(entry.path());
    }
    return files;
}

void require_environment(const Scene& scene, const AovSelection& aovs) {
    if (aovs.environment && !scene.environment) {
        throw UsageError(fmt::format("--aov environment: {} has no environment; add [environment] with image = "
                                     "\"FILE.hdr\", or an empty [environment] for the built-in studio",
                                     scene.file.empty() ? "the scene" : scene.file));
    }
}

} // namespace clshade::cli
