#include "host/cli/session.h"

#include "host/cli/lane_store.h"
#include "host/shading/kernel_library.h"

#include <spdlog/spdlog.h>

namespace clshade::cli {

const DeviceInfo& Session::info() {
    if (!info_) {
        const DeviceList list = list_devices();
        for (const std::string& warning : list.warnings) {
            spdlog::warn(warning);
        }
        info_ = select_device(list, options_.device);
    }
    return *info_;
}

Device& Session::device() {
    if (!device_) {
        device_.emplace(info(), options_.threads);
    }
    return *device_;
}

int Session::lanes() {
    return options_.lanes != 0 ? options_.lanes : stored_lanes(info()).value_or(0);
}

Shader& Session::shader(const AovSelection& aovs) {
    if (!shader_) {
        ShaderOptions shader_options;
        shader_options.aovs = aovs;
        shader_options.lanes = lanes();
        shader_options.max_memory = options_.max_memory;
        SourceSet kernels = kernel_sources(options_.kernel_dir); // a bad --kernel-dir before a device is opened
        shader_.emplace(device(), std::move(kernels), ProgramCache::standard(), shader_options);
    }
    return *shader_;
}

Prefilter& Session::prefilter() {
    if (!prefilter_) {
        SourceSet kernels = kernel_sources(options_.kernel_dir); // a bad --kernel-dir before a device is opened
        const int wanted = lanes();
        prefilter_.emplace(device(), std::move(kernels), ProgramCache::standard(),
                           wanted != 0 ? wanted : automatic_lanes(info()));
    }
    return *prefilter_;
}

} // namespace clshade::cli
