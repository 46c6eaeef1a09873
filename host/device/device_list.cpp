// Listing devices and choosing among them.
#include "host/device/device_list.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace clshade {

namespace {

/// Some drivers pad their names with blanks or end them with NUL.
std::string trimmed(const std::string& text) {
    const std::string_view blanks(" \t\r\n\0", 5);
    const auto first = text.find_first_not_of(blanks);
    const auto last = text.find_last_not_of(blanks);
    return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

DeviceKind kind_of(cl_device_type type) {
    if ((type & CL_DEVICE_TYPE_CPU) != 0) {
        return DeviceKind::cpu;
    }
    if ((type & CL_DEVICE_TYPE_GPU) != 0) {
        return DeviceKind::gpu;
    }
    if ((type & CL_DEVICE_TYPE_ACCELERATOR) != 0) {
        return DeviceKind::accelerator;
    }
    return DeviceKind::other;
}

DeviceInfo info_of(const cl::Device& device, const std::string& platform) {
    DeviceInfo info;
    info.platform = platform;
    info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
    info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    info.kind = kind_of(device.getInfo<CL_DEVICE_TYPE>());
    info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    info.global_memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.max_allocation = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.preferred_float_lanes = std::max(1U, device.getInfo<CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT>());
    // Deprecated in OpenCL 2.0 but answered by every driver; there is no successor for buffers.
    info.unified_memory = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() != CL_FALSE;
    return info;
}

/// Why a platform may show nothing. PoCL goes without a device, and without a word, when it cannot write its own cache.
std::string without_devices(const std::string& platform) {
    return fmt::format("OpenCL platform '{}' shows no device{}", platform,
                       platform == "Portable Computing Language"
                           ? "; PoCL needs a writable cache folder, set POCL_CACHE_DIR to one"
                           : "");
}

void add_platform(const cl::Platform& platform, std::size_t number, OpenClDevices& found) {
    std::string name = fmt::format("platform {}", number);
    std::vector<cl::Device> devices;
    try {
        name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
        platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error& error) {
        if (error.err() != CL_DEVICE_NOT_FOUND) {
            found.warnings.push_back(fmt::format("OpenCL platform '{}' cannot be used: {} gave {}", name, error.what(),
                                                 error_name(error.err())));
            return;
        }
    }
    if (devices.empty()) {
        found.warnings.push_back(without_devices(name));
    }
    for (const cl::Device& device : devices) {
        try {
            DeviceInfo info = info_of(device, name);
            if (device.getInfo<CL_DEVICE_AVAILABLE>() == CL_FALSE ||
                device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() == CL_FALSE) {
                found.warnings.push_back(fmt::format(
                    "OpenCL device '{}/{}' is left out: it is not available or has no compiler", name, info.name));
                continue;
            }
            info.index = static_cast<int>(found.devices.size());
            found.devices.push_back({std::move(info), device});
        } catch (const cl::Error& error) {
            found.warnings.push_back(fmt::format("a device of OpenCL platform '{}' is left out: {} gave {}", name,
                                                 error.what(), error_name(error.err())));
        }
    }
}

std::string candidates(const std::vector<DeviceInfo>& devices) {
    std::string text;
    for (const DeviceInfo& device : devices) {
        text += fmt::format("{}{}: {}/{} ({})", text.empty() ? "" : ", ", device.index, device.platform, device.name,
                            name_of(device.kind));
    }
    return text;
}

std::string no_device_text(const DeviceList& list) {
    if (list.warnings.empty()) {
        return "no OpenCL device; install pocl-opencl-icd or a GPU driver";
    }
    return fmt::format("no OpenCL device: {}; mend that, or install pocl-opencl-icd or a GPU driver",
                       fmt::join(list.warnings, "; "));
}

/// Digits only: always an index, never part of a name; otherwise "1" would pick an H100 where there is no device 1.
bool is_index(std::string_view selector) {
    return !selector.empty() &&
           std::all_of(selector.begin(), selector.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

template <class Predicate>
std::vector<DeviceInfo> matching(const DeviceList& list, Predicate predicate) {
    std::vector<DeviceInfo> result;
    std::copy_if(list.devices.begin(), list.devices.end(), std::back_inserter(result), predicate);
    return result;
}

std::vector<DeviceInfo> matches(const DeviceList& list, std::string_view selector) {
    if (is_index(selector)) {
        return matching(list, [digits = std::string(selector)](const DeviceInfo& device) {
            const auto significant = digits.find_first_not_of('0');
            return std::to_string(device.index) ==
                   (significant == std::string::npos ? "0" : digits.substr(significant));
        });
    }
    const std::string wanted = lower(selector);
    for (const DeviceKind kind : {DeviceKind::cpu, DeviceKind::gpu, DeviceKind::accelerator}) {
        if (wanted == name_of(kind)) {
            return matching(list, [kind](const DeviceInfo& device) { return device.kind == kind; });
        }
    }
    return matching(list, [&wanted](const DeviceInfo& device) {
        return lower(device.platform + "/" + device.name).find(wanted) != std::string::npos;
    });
}

DeviceInfo select_default(const DeviceList& list) {
    if (list.devices.size() == 1) {
        return list.devices.front();
    }
    const auto gpus = matching(list, [](const DeviceInfo& device) { return device.kind == DeviceKind::gpu; });
    if (gpus.size() == 1) {
        return gpus.front();
    }
    throw DeviceError(fmt::format("several OpenCL devices fit; choose one with --device: {}",
                                  candidates(gpus.empty() ? list.devices : gpus)));
}

} // namespace

std::string_view name_of(DeviceKind kind) {
    switch (kind) {
    case DeviceKind::cpu:
        return "cpu";
    case DeviceKind::gpu:
        return "gpu";
    case DeviceKind::accelerator:
        return "accelerator";
    case DeviceKind::other:
        break;
    }
    return "other";
}

OpenClDevices find_devices() {
    OpenClDevices found;
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error& error) {
        // CL_PLATFORM_NOT_FOUND_KHR only says that nothing is installed.
        if (error.err() != CL_PLATFORM_NOT_FOUND_KHR) {
            found.warnings.push_back(fmt::format("{} gave {}", error.what(), error_name(error.err())));
        }
    }
    for (std::size_t i = 0; i < platforms.size(); ++i) {
        add_platform(platforms[i], i, found);
    }
    return found;
}

DeviceList list_devices() {
    OpenClDevices found = find_devices();
    DeviceList list;
    list.warnings = std::move(found.warnings);
    for (auto& device : found.devices) {
        list.devices.push_back(std::move(device.info));
    }
    return list;
}

DeviceInfo select_device(const DeviceList& list, std::string_view selector) {
    if (list.devices.empty()) {
        throw DeviceError(no_device_text(list));
    }
    if (selector.empty()) {
        return select_default(list);
    }
    auto found = matches(list, selector);
    if (found.empty()) {
        throw DeviceError(fmt::format("no device matches '{}'; there are: {}", selector, candidates(list.devices)));
    }
    if (found.size() > 1) {
        throw DeviceError(
            fmt::format("device '{}' is ambiguous; choose one by its index or a longer part of its name: {}", selector,
                        candidates(found)));
    }
    return std::move(found.front());
}

} // namespace clshade
