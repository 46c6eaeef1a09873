// Device memory: in place over host memory, mirrored, or without a host twin.
#include "host/device/opencl.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace clshade {

namespace {

constexpr std::size_t page = 4096;
constexpr std::size_t line = 64;

cl_mem_flags flags_of(Access access) {
    switch (access) {
    case Access::read:
        return CL_MEM_READ_ONLY;
    case Access::write:
        return CL_MEM_WRITE_ONLY;
    case Access::read_write:
        break;
    }
    return CL_MEM_READ_WRITE;
}

double mebibytes(std::uint64_t bytes) {
    return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

std::shared_ptr<Buffer::State> allocate(Device& device, std::size_t bytes, cl_mem_flags flags, void* host) {
    const DeviceInfo& info = device.info();
    if (bytes == 0) {
        throw RuntimeFailure(fmt::format("device '{}': a buffer of 0 bytes was asked for", info.name));
    }
    if (bytes > info.max_allocation) {
        throw RuntimeFailure(
            fmt::format("device '{}' gives at most {:.1f} MiB in one piece, {:.1f} MiB are needed; set "
                        "--max-mem to work in smaller bands",
                        info.name, mebibytes(info.max_allocation), mebibytes(bytes)));
    }
    auto state = std::make_shared<Buffer::State>();
    state->device = device.state();
    state->size = bytes;
    try {
        state->memory = cl::Buffer(device.state()->context, flags, bytes, host);
    } catch (const cl::Error& error) {
        throw RuntimeFailure(describe(error, info.name, fmt::format("allocating {:.1f} MiB", mebibytes(bytes))));
    }
    return state;
}

/// A band of rows lies within host and device memory.
void check_rows(const Buffer::State& state, std::size_t host_pitch, std::size_t device_pitch, std::size_t row_bytes,
                std::size_t rows) {
    const bool fits = row_bytes <= device_pitch && row_bytes <= host_pitch &&
                      (rows - 1) <= (state.size - std::min(row_bytes, state.size)) / device_pitch &&
                      row_bytes <= state.size;
    if (!fits) {
        throw RuntimeFailure(
            fmt::format("device '{}': {} rows of {} bytes at a pitch of {} do not fit a buffer of {} bytes",
                        state.device->info.name, rows, row_bytes, device_pitch, state.size));
    }
}

void check_range(const Buffer::State& state, std::size_t bytes) {
    if (bytes > state.size) {
        throw RuntimeFailure(fmt::format("device '{}': {} bytes do not fit a buffer of {} bytes",
                                         state.device->info.name, bytes, state.size));
    }
}

Buffer::State& open(const std::shared_ptr<Buffer::State>& state) {
    if (!state) {
        throw RuntimeFailure("an empty device buffer was used");
    }
    return *state;
}

} // namespace

Buffer::State::~State() {
    if (host == nullptr) {
        return; // the driver itself keeps its memory until enqueued work is done
    }
    try {
        unmap();
        device->queue.finish();
    } catch (...) { // a destructor has nobody to tell; the failing call told already
    }
}

void Buffer::State::map() {
    if (!zero_copy || mapping != nullptr) {
        return;
    }
    mapping = guarded(device->info, "mapping a buffer", [this] {
        return device->queue.enqueueMapBuffer(memory, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, size);
    });
}

void Buffer::State::unmap() {
    if (mapping == nullptr) {
        return;
    }
    void* const pointer = mapping;
    mapping = nullptr;
    guarded(device->info, "unmapping a buffer", [&] { device->queue.enqueueUnmapMemObject(memory, pointer); });
}

Buffer::Buffer(Device& device, std::span<std::byte> host, Access access) {
    const bool aligned = reinterpret_cast<std::uintptr_t>(host.data()) % page == 0 && host.size() % line == 0;
    if (!aligned) {
        throw RuntimeFailure(fmt::format("device '{}': host memory of {} bytes does not start on a page of {} bytes or "
                                         "is no multiple of {}",
                                         device.info().name, host.size(), page, line));
    }
    const bool in_place = device.info().unified_memory;
    state_ = allocate(device, host.size(), flags_of(access) | (in_place ? CL_MEM_USE_HOST_PTR : 0),
                      in_place ? host.data() : nullptr);
    state_->host = host.data();
    state_->zero_copy = in_place;
    state_->map(); // the host owns the memory until the first upload()
}

Buffer::Buffer(Device& device, std::size_t bytes, Access access)
    : state_(allocate(device, bytes, flags_of(access), nullptr)) {}

Buffer::~Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

std::size_t Buffer::size() const {
    return state_ ? state_->size : 0;
}
bool Buffer::zero_copy() const {
    return state_ && state_->zero_copy;
}

void Buffer::upload() {
    State& state = open(state_);
    if (state.zero_copy) {
        state.unmap();
    } else if (state.host != nullptr) {
        guarded(state.device->info, "copying to the device",
                [&] { state.device->queue.enqueueWriteBuffer(state.memory, CL_TRUE, 0, state.size, state.host); });
    }
}

void Buffer::download() {
    State& state = open(state_);
    if (state.zero_copy) {
        state.map();
    } else if (state.host != nullptr) {
        guarded(state.device->info, "copying from the device",
                [&] { state.device->queue.enqueueReadBuffer(state.memory, CL_TRUE, 0, state.size, state.host); });
    }
}

void Buffer::write(std::span<const std::byte> bytes) {
    State& state = open(state_);
    check_range(state, bytes.size());
    if (bytes.empty()) {
        return;
    }
    state.unmap();
    guarded(state.device->info, "copying to the device",
            [&] { state.device->queue.enqueueWriteBuffer(state.memory, CL_TRUE, 0, bytes.size(), bytes.data()); });
}

void Buffer::read(std::span<std::byte> bytes) {
    State& state = open(state_);
    check_range(state, bytes.size());
    if (bytes.empty()) {
        return;
    }
    state.unmap();
    guarded(state.device->info, "copying from the device",
            [&] { state.device->queue.enqueueReadBuffer(state.memory, CL_TRUE, 0, bytes.size(), bytes.data()); });
}

void Buffer::write_rows(const std::byte* host, std::size_t host_pitch, std::size_t device_pitch, std::size_t row_bytes,
                        std::size_t rows) {
    State& state = open(state_);
    if (row_bytes == 0 || rows == 0) {
        return;
    }
    check_rows(state, host_pitch, device_pitch, row_bytes, rows);
    state.unmap();
    const std::array<cl::size_type, 3> origin{};
    guarded(state.device->info, "copying rows to the device", [&] {
        state.device->queue.enqueueWriteBufferRect(state.memory, CL_TRUE, origin, origin, {row_bytes, rows, 1},
                                                   device_pitch, 0, host_pitch, 0, host);
    });
}

void Buffer::read_rows(std::byte* host, std::size_t host_pitch, std::size_t device_pitch, std::size_t row_bytes,
                       std::size_t rows) const {
    State& state = open(state_);
    if (row_bytes == 0 || rows == 0) {
        return;
    }
    check_rows(state, host_pitch, device_pitch, row_bytes, rows);
    state.unmap();
    const std::array<cl::size_type, 3> origin{};
    guarded(state.device->info, "copying rows from the device", [&] {
        state.device->queue.enqueueReadBufferRect(state.memory, CL_TRUE, origin, origin, {row_bytes, rows, 1},
                                                  device_pitch, 0, host_pitch, 0, host);
    });
}

} // namespace clshade
