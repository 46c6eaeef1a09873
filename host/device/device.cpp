// Opening a device: context and queue, and the limit on threads.
#include "host/device/device_list.h"

#include <algorithm>
#include <array>

namespace clshade {

namespace {

/// The device that list_devices() showed at this place.
cl::Device find(const DeviceInfo& info) {
    OpenClDevices found = find_devices();
    const auto same = std::find_if(found.devices.begin(), found.devices.end(), [&info](const OpenClDevice& device) {
        return device.info.index == info.index && device.info.name == info.name &&
               device.info.platform == info.platform;
    });
    if (same == found.devices.end()) {
        throw DeviceError(fmt::format("device {} ({}/{}) is not there any more; see clshade devices", info.index,
                                      info.platform, info.name));
    }
    return same->device;
}

/// The part of a CPU device that has `threads` compute units. Works after the platform was initialised, unlike the
/// environment variables of PoCL; a program built for the part is, byte for byte, the one built for the whole.
cl::Device limited(const cl::Device& device, const DeviceInfo& info, unsigned threads) {
    const auto partitions = device.getInfo<CL_DEVICE_PARTITION_PROPERTIES>();
    if (std::find(partitions.begin(), partitions.end(), CL_DEVICE_PARTITION_BY_COUNTS) == partitions.end()) {
        throw DeviceError(fmt::format("device '{}' cannot be limited to {} threads, its driver does not split devices; "
                                      "leave out --threads",
                                      info.name, threads));
    }
    const std::array<cl_device_partition_property, 4> counts{CL_DEVICE_PARTITION_BY_COUNTS,
                                                             static_cast<cl_device_partition_property>(threads),
                                                             CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    std::vector<cl::Device> parts;
    cl::Device(device).createSubDevices(counts.data(), &parts);
    return parts.at(0);
}

} // namespace

Device::Device(const DeviceInfo& info, int threads) : state_(std::make_shared<State>()) {
    if (threads < 0) {
        throw DeviceError(fmt::format("--threads {} is negative; 0 uses all", threads));
    }
    state_->info = info;
    state_->device = find(info);
    try {
        const auto wanted = static_cast<unsigned>(threads);
        if (info.kind == DeviceKind::cpu && wanted > 0 && wanted < info.compute_units) {
            state_->device = limited(state_->device, info, wanted);
            state_->info.compute_units = wanted;
        }
        state_->context = cl::Context(state_->device);
        state_->queue = cl::CommandQueue(state_->context, state_->device, CL_QUEUE_PROFILING_ENABLE);
    } catch (const cl::Error& error) {
        throw DeviceError(describe(error, info.name, "opening the device"));
    }
}

Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

const DeviceInfo& Device::info() const {
    return state_->info;
}

void Device::finish() {
    guarded(state_->info, "waiting for the queue", [this] { state_->queue.finish(); });
}

} // namespace clshade
