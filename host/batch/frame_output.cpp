#include "host/batch/frame_output.h"

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/images/completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace clshade {

bool is_png(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".png";
}

namespace {

void add_matrices(OutputImage& image, const LoadedFrame& loaded) {
    // The picture is seen through the input's camera; what its header says of it is still true.
    for (const char* name : {"worldToCamera", "worldToNDC", "worldToScreen"}) {
        if (const auto found = loaded.layout.matrices.find(name); found != loaded.layout.matrices.end()) {
            image.matrices[name] = found->second;
        }
    }
    const View& view = loaded.frame.view;
    if (!image.matrices.contains("worldToCamera")) {
        const Window& window = loaded.frame.data_window;
        const glm::dvec3 centre =
            view.origin + 0.5 * window.width() * view.origin_dx + 0.5 * window.height() * view.origin_dy;
        image.matrices["worldToCamera"] = world_to_camera(view.camera_to_world, view.orthographic ? centre : view.eye);
    }
}

} // namespace

glm::dmat4 world_to_camera(const glm::dmat3& camera_to_world, const glm::dvec3& eye) {
    // Rows of the rotation are the camera's axes right, up and forward (-Z). A matrix for row vectors, stored row by
    // row, has the same memory as GLM's for column vectors, stored column by column.
    const glm::dmat3 rotation = glm::transpose(camera_to_world);
    glm::dmat4 matrix(rotation);
    matrix[3] = glm::dvec4(-(rotation * eye), 1.0);
    for (int i = 0; i < 4; ++i) {
        matrix[i].z = -matrix[i].z;
    }
    return matrix;
}

OutputImage make_output(const LoadedFrame& loaded, const ShadedImage& shaded, const RunScene& scene,
                        const EnvironmentInput* environment, const DeviceInfo& device, const std::string& job) {
    OutputImage image;
    image.data_window = loaded.frame.data_window;
    image.display_window = loaded.frame.display_window;
    image.pixel_aspect = loaded.frame.pixel_aspect;
    for (std::size_t i = 0; i < shaded.plane_names.size(); ++i) {
        image.channels.push_back({shaded.plane_names[i], &shaded.planes, static_cast<int>(i), false});
    }
    for (const KeptPlane& kept : loaded.kept) {
        const bool taken = std::any_of(image.channels.begin(), image.channels.end(),
                                       [&](const OutputChannel& channel) { return channel.name == kept.name; });
        if (taken) {
            throw UsageError(fmt::format("{}: --keep: channel '{}' has the name of an output channel; leave it out",
                                         loaded.frame.file, kept.name));
        }
        image.channels.push_back({kept.name, &loaded.frame.planes, kept.plane, !kept.exact_in_half});
    }
    image.attributes = {
        {"software", fmt::format("clshade {}", CLSHADE_VERSION)},
        {"clshade/version", CLSHADE_VERSION},
        {job_attribute, job},
        {"clshade/device", device.platform + "/" + device.name},
        {"clshade/driver", device.driver},
        {"clshade/scene", scene.name},
        // What decides the picture beside the G-buffer: an environment's texels as much as the scene's text.
        {"clshade/scene_hash", environment == nullptr ? scene.hash : hash_hex(scene.hash + environment->hash)},
        {"clshade/kernel", shaded.identity},
        {"clshade/camera", loaded.camera_source},
        {"clshade/normal_space", loaded.frame.normal_space == NormalSpace::world ? "world" : "camera"},
    };
    if (environment != nullptr) {
        image.attributes["clshade/environment"] = environment->name;
        image.attributes["clshade/environment_hash"] = environment->hash;
    }
    add_matrices(image, loaded);
    return image;
}

WrittenFile write_output(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings,
                         Replace replace) {
    return is_png(file) ? write_png(file, image, replace) : write_exr(file, image, settings, replace);
}

void refuse_same_file(const std::filesystem::path& output, const std::filesystem::path& source) {
    if (!source.empty() && same_file(output, source)) {
        throw UsageError(fmt::format("{}: the output would overwrite the input; choose another name", output.string()));
    }
}

} // namespace clshade
