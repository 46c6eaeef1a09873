// Kernels: arguments, launch, time.
#include "host/device/opencl.h"

namespace clshade {

namespace {

std::string doing(std::string_view what, const std::string& kernel) {
    return fmt::format("{} kernel '{}'", what, kernel);
}

template <class Work>
void guarded_kernel(const Program::State& program, std::string_view what, const std::string& kernel, Work&& work) {
    try {
        work();
    } catch (const cl::Error& error) {
        throw RuntimeFailure(describe(error, program.device->info.name, doing(what, kernel)));
    }
}

} // namespace

Kernel::Kernel(const Program& program, const std::string& name) : state_(std::make_shared<State>()) {
    state_->program = program.state();
    state_->name = name;
    guarded_kernel(*state_->program, "making", name,
                   [&] { state_->kernel = cl::Kernel(state_->program->program, name.c_str()); });
}

void Kernel::set_argument(unsigned index, const Buffer& buffer) {
    if (!buffer.state()) {
        throw RuntimeFailure(fmt::format("kernel '{}': argument {} is an empty buffer", state_->name, index));
    }
    guarded_kernel(*state_->program, fmt::format("setting argument {} of", index), state_->name,
                   [&] { state_->kernel.setArg(index, buffer.state()->memory); });
    if (state_->buffers.size() <= index) {
        state_->buffers.resize(std::size_t{index} + 1);
    }
    state_->buffers[index] = buffer.state();
}

void Kernel::set_bytes(unsigned index, std::span<const std::byte> bytes) {
    guarded_kernel(*state_->program, fmt::format("setting argument {} of", index), state_->name,
                   [&] { state_->kernel.setArg(index, bytes.size(), bytes.data()); });
}

void Kernel::launch(std::size_t global, std::size_t local, std::size_t offset) {
    if (local == 0 || global == 0 || global % local != 0) {
        throw RuntimeFailure(
            fmt::format("kernel '{}' on device '{}': {} work-items are no whole number of groups of {}", state_->name,
                        state_->program->device->info.name, global, local));
    }
    // A zero-copy buffer that the host still owns goes to the device; buffers the kernel only writes need no upload().
    for (const auto& buffer : state_->buffers) {
        if (buffer) {
            buffer->unmap();
        }
    }
    state_->last = cl::Event();
    guarded_kernel(*state_->program, "launching", state_->name, [&] {
        state_->program->device->queue.enqueueNDRangeKernel(
            state_->kernel, offset == 0 ? cl::NullRange : cl::NDRange(offset), cl::NDRange(global), cl::NDRange(local),
            nullptr, &state_->last);
    });
    state_->program->note_launch(state_->name, global, local, offset);
}

double Kernel::wait_milliseconds() {
    if (state_->last() == nullptr) {
        throw RuntimeFailure(fmt::format("kernel '{}' was not launched", state_->name));
    }
    double milliseconds = 0.0;
    guarded_kernel(*state_->program, "running", state_->name, [&] {
        state_->last.wait();
        const auto start = state_->last.getProfilingInfo<CL_PROFILING_COMMAND_START>();
        const auto end = state_->last.getProfilingInfo<CL_PROFILING_COMMAND_END>();
        milliseconds = static_cast<double>(end - start) * 1e-6;
    });
    return milliseconds;
}

} // namespace clshade
