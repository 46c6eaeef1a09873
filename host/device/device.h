// OpenCL devices: listing, choosing, and one in-order profiling queue each. Nothing here knows what is computed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

enum class DeviceKind { cpu, gpu, accelerator, other };
[[nodiscard]] std::string_view name_of(DeviceKind kind);

struct DeviceInfo {
    int index = 0; ///< position in list_devices(), stable while the installed drivers do not change
    std::string platform;
    std::string name;
    std::string vendor;
    std::string driver;  ///< driver version
    std::string version; ///< OpenCL version string
    DeviceKind kind = DeviceKind::other;
    unsigned compute_units = 0;
    std::uint64_t global_memory = 0; ///< bytes
    std::uint64_t max_allocation = 0;
    unsigned preferred_float_lanes = 1; ///< CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT
    bool unified_memory = false;        ///< host memory can be used in place
};

struct DeviceList {
    std::vector<DeviceInfo> devices;
    std::vector<std::string> warnings; ///< platforms or devices whose driver failed to answer; they hide no others
};

/// All devices of all platforms. Never throws for a bad driver.
[[nodiscard]] DeviceList list_devices();

/// Picks by index ("0"), kind ("cpu", "gpu") or a case-insensitive substring of "platform/device". Empty: the only
/// device there is, else the only GPU, else an error: never a silent choice among several.
/// Throws DeviceError listing the candidates (ambiguous) or the devices there are (no match, none at all).
[[nodiscard]] DeviceInfo select_device(const DeviceList& list, std::string_view selector);

class Buffer;
class Kernel;
class Program;

/// An open device: context and in-order queue with profiling. Move-only; buffers, programs and kernels keep what they
/// need of it alive.
class Device {
  public:
    /// threads > 0 limits a CPU device to that many compute units (a sub-device; other kinds ignore it); 0 or more than
    /// there are: all. The result does not depend on it, nor does a program's identity. Throws DeviceError.
    explicit Device(const DeviceInfo& info, int threads = 0);
    ~Device();
    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceInfo& info() const;
    /// Blocks until everything enqueued is done. Throws RuntimeFailure naming the device.
    void finish();

    struct State; ///< OpenCL handles, private to host/device
    [[nodiscard]] const std::shared_ptr<State>& state() const { return state_; }

  private:
    std::shared_ptr<State> state_;
};

enum class Access { read, write, read_write };

/// Device memory. Either over host memory (used in place on unified-memory devices, mirrored otherwise) or of its own.
/// The host owns a buffer over its memory from the start and after download(), the device after upload() or a launch
/// that uses the buffer; what only the device writes needs no upload().
class Buffer {
  public:
    Buffer() = default;
    /// Over `host`, which must outlive the buffer, start on a page and span a multiple of 64 bytes (AlignedBuffer
    /// does). The device sees the host's content after upload(); the host sees the device's after download().
    Buffer(Device& device, std::span<std::byte> host, Access access);
    /// `bytes` of device memory with no host twin, for tiles and constants.
    Buffer(Device& device, std::size_t bytes, Access access);
    ~Buffer();
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] bool zero_copy() const;
    /// Makes the host's content visible to the device (unmap, or a copy). Enqueued in order, non-blocking on unified
    /// memory.
    void upload();
    /// Makes the device's content visible to the host (map, or a copy). Blocks.
    void download();
    /// Copies `bytes` to the start of the buffer. Blocks. For constants.
    void write(std::span<const std::byte> bytes);
    void read(std::span<std::byte> bytes);
    /// Copies `rows` runs of `row_bytes` from host memory (runs `host_pitch` bytes apart) to device runs
    /// `device_pitch` bytes apart, or back. Blocks. For bands of planes on devices that cannot hold a whole picture.
    void write_rows(const std::byte* host, std::size_t host_pitch, std::size_t device_pitch, std::size_t row_bytes,
                    std::size_t rows);
    void read_rows(std::byte* host, std::size_t host_pitch, std::size_t device_pitch, std::size_t row_bytes,
                   std::size_t rows) const;

    struct State;
    [[nodiscard]] const std::shared_ptr<State>& state() const { return state_; }

  private:
    std::shared_ptr<State> state_;
};

} // namespace clshade
