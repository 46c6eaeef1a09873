// Private to host/device: the OpenCL C++ wrapper, the handles behind the public classes, and the translation of its
// errors.
#pragma once

#include "host/base/error.h"
#include "host/device/build_lock.h"
#include "host/device/device.h"
#include "host/device/program.h"

#include <CL/opencl.hpp>
#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// "CL_OUT_OF_RESOURCES" and the like; "error -9999" for a code that has no name here.
[[nodiscard]] std::string error_name(cl_int code);
/// What a user can do about an error, as "; do this", or an empty string.
[[nodiscard]] std::string_view advice_for(cl_int code);
/// "device 'NAME': DOING failed: clCall gave CL_ERROR; advice"
[[nodiscard]] std::string describe(const cl::Error& error, std::string_view device, std::string_view doing);

/// Runs `work` and turns what OpenCL throws into a RuntimeFailure that names the device and what was being done.
template <class Work>
decltype(auto) guarded(const DeviceInfo& device, std::string_view doing, Work&& work) {
    try {
        return work();
    } catch (const cl::Error& error) {
        throw RuntimeFailure(describe(error, device.name, doing));
    }
}

struct Device::State {
    DeviceInfo info;
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue;
};

struct Buffer::State {
    std::shared_ptr<Device::State> device;
    cl::Buffer memory;
    std::size_t size = 0;
    std::byte* host = nullptr; ///< host twin; null when there is none
    bool zero_copy = false;    ///< the device works on `host` itself
    void* mapping = nullptr;   ///< set while the host owns a zero-copy buffer

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    State(State&&) = delete;
    State& operator=(State&&) = delete;
    /// Waits for the queue before a host twin may be freed. Never throws.
    ~State();

    void map();
    void unmap();
};

struct Program::State {
    std::shared_ptr<Device::State> device;
    cl::Program program;
    BuildReport report;
    ProgramCache cache = ProgramCache::disabled();
    std::mutex mutex;                    ///< guards the two sets: kernels of one program may run from several threads
    std::set<std::string> launched;      ///< launch shapes seen in this process
    std::set<std::string> stored;        ///< launch shapes that the file in the cache already holds code for
    bool on_disk = false;                ///< the cache holds this program
    std::unique_ptr<BuildLock> building; ///< until the cache holds it

    void note_launch(const std::string& kernel, std::size_t global, std::size_t local, std::size_t offset);
};

struct Kernel::State {
    std::shared_ptr<Program::State> program;
    cl::Kernel kernel;
    std::string name;
    std::vector<std::shared_ptr<Buffer::State>> buffers; ///< by argument index; OpenCL does not keep them alive itself
    cl::Event last;
};

} // namespace clshade
