#include "host/cli/kernel_dump.h"

#include "host/base/error.h"
#include "host/cli/signals.h"
#include "host/shading/frame_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace clshade::cli {

namespace {

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder, error)) {
        throw RuntimeFailure(fmt::format("--dump-kernel: {}: cannot make the folder: {}", folder.string(),
                                         error ? error.message() : "it is a file"));
    }
}

std::string options_text(const Shader& shader, const Frame& frame) {
    std::string text = fmt::format("kernel   {}\nbuild    shade.cl with -cl-std=CL1.2 {}\n", kernel_key(frame),
                                   shader.build_options());
    for (const BoundMaterial& material : frame.materials) {
        text += fmt::format("material {}: {}\n", material.name, model_key(material));
    }
    return text;
}

} // namespace

KernelDump::KernelDump(std::filesystem::path folder, const std::filesystem::path& kernel_dir)
    : folder_(std::move(folder)) {
    std::error_code ignored; // two folders of which one does not exist are not the same
    if (!folder_.empty() && !kernel_dir.empty() && std::filesystem::equivalent(folder_, kernel_dir, ignored)) {
        throw UsageError(fmt::format("--dump-kernel: {} is also --kernel-dir, whose files it would replace; choose "
                                     "another folder",
                                     folder_.string()));
    }
}

void KernelDump::add(const Shader& shader, const Frame& frame) {
    if (folder_.empty()) {
        return;
    }
    const SourceSet sources = shader.sources(frame);
    const std::string options = options_text(shader, frame);
    std::string all = options;
    for (const std::string& name : sources.names()) {
        all += sources.text(name);
    }
    if (std::find(dumped_.begin(), dumped_.end(), all) != dumped_.end()) {
        return;
    }
    dumped_.push_back(std::move(all));
    const std::filesystem::path folder = dumped_.size() == 1 ? folder_ : folder_ / std::to_string(dumped_.size());
    make_folder(folder);
    for (const std::string& name : sources.names()) {
        write_text_file(folder / name, sources.text(name));
    }
    write_text_file(folder / "options.txt", options);
}

} // namespace clshade::cli
