// Private to host/device: the devices of list_devices() with their OpenCL handles.
#pragma once

#include "host/device/opencl.h"

#include <string>
#include <vector>

namespace clshade {

struct OpenClDevice {
    DeviceInfo info;
    cl::Device device;
};

struct OpenClDevices {
    std::vector<OpenClDevice> devices;
    std::vector<std::string> warnings;
};

/// All devices of all platforms, in the order of list_devices().
[[nodiscard]] OpenClDevices find_devices();

} // namespace clshade
