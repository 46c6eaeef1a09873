#include "host/batch/update_check.h"

#include "host/base/hash.h"
#include "host/images/completion.h"
#include "host/scene/frame_camera.h"

#include <fmt/format.h>

namespace clshade {

namespace {

namespace fs = std::filesystem;

/// Files of the same age as the output may be younger than it: clocks of file systems tick in milliseconds or seconds.
bool is_older(const fs::path& source, fs::file_time_type written) {
    std::error_code error;
    return source.empty() || (fs::last_write_time(source, error) < written && !error);
}

bool is_complete(const fs::path& output, const std::string& identity) {
    const auto stamp = read_completion_stamp(output);
    return stamp && stamp->job == identity;
}

bool is_up_to_date(const FrameJob& job, const RunScene& scene, const BatchSettings& settings,
                   const std::string& identity) {
    std::vector<fs::path> sources{job.input, scene.file, camera_file_of_frame(scene.scene, job.number)};
    for (const auto& more : {scene.tables, scene.environment, settings.tools}) {
        sources.insert(sources.end(), more.begin(), more.end());
    }
    for (const fs::path& output : {job.output, job.preview}) {
        if (output.empty()) {
            continue;
        }
        std::error_code error;
        const auto written = fs::last_write_time(output, error);
        if (error) {
            return false;
        }
        for (const fs::path& source : sources) {
            if (!is_older(source, written)) {
                return false;
            }
        }
        if (!is_complete(output, identity)) {
            return false;
        }
    }
    return true;
}

} // namespace

std::string job_identity(const RunScene& scene, const BatchSettings& settings) {
    const AovSelection& aovs = settings.aovs;
    return hash_hex(fmt::format(
        "{}\n{}\n{}{}{}{}\n{}\n{}\n{} {} {}", scene.hash, scene.scene.environment ? scene.scene.environment->image : "",
        aovs.diffuse ? "diffuse " : "", aovs.specular ? "specular " : "", aovs.lights ? "lights " : "",
        aovs.environment ? "environment" : "", fmt::join(settings.keep, "\n"), settings.view,
        settings.exr.half ? "half" : "float", settings.exr.compression, settings.exr.level.value_or(-1.0)));
}

std::string reason_to_skip(const FrameJob& job, const RunScene& scene, const BatchSettings& settings,
                           const std::string& identity) {
    std::error_code ignored;
    if (settings.no_clobber && fs::exists(job.output, ignored)) {
        return "the output exists (--no-clobber)";
    }
    if (settings.update_only && is_up_to_date(job, scene, settings, identity)) {
        return "the output is up to date (-u)";
    }
    return {};
}

} // namespace clshade
