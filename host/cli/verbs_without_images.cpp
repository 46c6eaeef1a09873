// Stand-ins for the verbs that need image files, in builds without them (CLSHADE_IMAGES=OFF).
#include "host/cli/check_image.h"
#include "host/cli/environment_file.h"
#include "host/cli/thumbnails.h"
#include "host/cli/verb.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <string>

namespace clshade::cli {

namespace {

Action refuse(CLI::App& app, const std::string& verb) {
    // Thrown while parsing, before anybody can call the verb's flags unknown.
    app.callback([verb] {
        throw UsageError(fmt::format("{}: this build has no image files; configure with -DCLSHADE_IMAGES=ON", verb));
    });
    return [] { return ExitCode::usage; };
}

} // namespace

Action declare_shade(CLI::App& app) {
    return refuse(app, "shade");
}
Action declare_inspect(CLI::App& app) {
    return refuse(app, "inspect");
}
Action declare_demo(CLI::App& app) {
    return refuse(app, "demo");
}
Action declare_prefilter(CLI::App& app) {
    return refuse(app, "prefilter");
}

EnvironmentFile read_environment_file(const std::filesystem::path& path, std::uint64_t /*max_memory*/, bool /*whole*/) {
    throw UsageError(
        fmt::format("{}: this build has no image files; configure with -DCLSHADE_IMAGES=ON", path.string()));
}

CheckInput read_check_input(const std::filesystem::path& /*file*/, const SceneOptions& /*scene*/,
                            std::uint64_t /*max_memory*/) {
    throw UsageError("check INPUT: this build has no image files; configure with -DCLSHADE_IMAGES=ON");
}

void check_dump_path(const std::filesystem::path& /*file*/, const std::filesystem::path& /*input*/) {
    throw UsageError("check --dump: this build has no image files; configure with -DCLSHADE_IMAGES=ON");
}

// Never reached: check_dump_path has thrown.
void ErrorDump::add(const std::string& /*layer*/, const Frame& /*frame*/, const ShadedImage& /*shaded*/,
                    const reference::Image& /*expected*/) {}
void ErrorDump::write(const std::filesystem::path& /*file*/) const {}

void write_thumbnails(const std::filesystem::path& /*folder*/, std::span<const PresetInfo> /*presets*/,
                      Session& /*session*/, int /*threads*/,
                      const std::function<void(const std::filesystem::path&)>& /*told*/) {
    throw UsageError("models --thumbnails: this build has no image files; configure with -DCLSHADE_IMAGES=ON");
}

} // namespace clshade::cli
