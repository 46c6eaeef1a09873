// Buffers, kernels and threads on every device of kind cpu there is (PoCL).
#include "host/base/aligned_buffer.h"
#include "host/base/error.h"
#include "host/device/device.h"
#include "host/device/program.h"
#include "tests/device/failure_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <numeric>
#include <vector>

namespace clshade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::failure_text;

constexpr const char* source = R"(
__kernel void add(__global const float* a, __global const float* b, __global float* sum, float factor) {
    size_t i = get_global_id(0);
    sum[i] = a[i] + factor * b[i];
}
__kernel void twice(__global float* a) { a[get_global_id(0)] *= 2.0f; }
__kernel void work(__global float* a) {
    size_t i = get_global_id(0);
    float x = a[i];
    for (int k = 0; k < 200; ++k) x = sqrt(fabs(x)) * 1.5f + sin(x);
    a[i] = x;
}
)";

DeviceInfo cpu() {
    return select_device(list_devices(), "cpu");
}

std::span<std::byte> bytes_of(AlignedBuffer& buffer) {
    return std::as_writable_bytes(buffer.span());
}

Program program_for(Device& device) {
    SourceSet sources;
    sources.add("test.cl", source);
    return {device, sources, "test.cl", "", ProgramCache::disabled()};
}

/// Planes used in place, and planes copied to and fro, on the same device.
class BufferTest : public ::testing::TestWithParam<bool> {
  protected:
    static DeviceInfo device_info() {
        DeviceInfo info = cpu();
        info.unified_memory = GetParam();
        return info;
    }
};

TEST_P(BufferTest, KernelAddsWithOffset) {
    constexpr std::size_t size = 1024;
    AlignedBuffer a(size);
    AlignedBuffer b(size);
    AlignedBuffer sum(size);
    for (std::size_t i = 0; i < size; ++i) {
        a.data()[i] = static_cast<float>(i);
        b.data()[i] = 3.0F;
        sum.data()[i] = -1.0F;
    }
    Device device(device_info());
    Buffer a_buffer(device, bytes_of(a), Access::read);
    Buffer b_buffer(device, bytes_of(b), Access::read);
    Buffer sum_buffer(device, bytes_of(sum), Access::read_write);
    EXPECT_EQ(a_buffer.zero_copy(), GetParam());
    a_buffer.upload();
    b_buffer.upload();
    sum_buffer.upload();
    Kernel kernel(program_for(device), "add");
    kernel.set_argument(0, a_buffer);
    kernel.set_argument(1, b_buffer);
    kernel.set_argument(2, sum_buffer);
    kernel.set_argument(3, 2.0F);
    kernel.launch(512, 64, 256);
    EXPECT_GT(kernel.wait_milliseconds(), 0.0);
    sum_buffer.download();
    for (std::size_t i = 0; i < size; ++i) {
        const bool inside = i >= 256 && i < 768;
        ASSERT_EQ(sum.data()[i], inside ? static_cast<float>(i) + 6.0F : -1.0F) << i;
    }
}

TEST_P(BufferTest, HostAndDeviceTakeTurns) {
    AlignedBuffer plane(256);
    Device device(device_info());
    Buffer buffer(device, bytes_of(plane), Access::read_write);
    Kernel kernel(program_for(device), "twice");
    kernel.set_argument(0, buffer);
    plane.data()[7] = 1.0F;
    for (const float expected : {2.0F, 5.0F, 11.0F}) { // doubled by the device, 0.5 added by the host
        buffer.upload();
        kernel.launch(256, 64);
        buffer.download();
        ASSERT_EQ(plane.data()[7], expected);
        plane.data()[7] += 0.5F;
    }
}

TEST_P(BufferTest, OutputNeedsNoUpload) {
    AlignedBuffer plane(64);
    AlignedBuffer sum(64);
    plane.data()[3] = 4.0F;
    Device device(device_info());
    Buffer in(device, bytes_of(plane), Access::read);
    Buffer out(device, bytes_of(sum), Access::write);
    in.upload();
    Kernel kernel(program_for(device), "add");
    kernel.set_argument(0, in);
    kernel.set_argument(1, in);
    kernel.set_argument(2, out);
    kernel.set_argument(3, 1.0F);
    kernel.launch(64, 64);
    out.download();
    EXPECT_EQ(sum.data()[3], 8.0F);
}

INSTANTIATE_TEST_SUITE_P(InPlaceAndMirrored, BufferTest, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "in_place" : "mirrored"; });

/// The device writes into the very memory of the host: the result is there before download(), which then copies
/// nothing. (Reading before download() is not allowed in general; PoCL is known to work on the pointer itself.)
TEST(Buffer, ZeroCopyWorksOnTheHostsMemory) {
    const DeviceInfo info = cpu();
    ASSERT_TRUE(info.unified_memory);
    AlignedBuffer plane(64);
    Device device(info);
    Buffer buffer(device, bytes_of(plane), Access::read_write);
    plane.data()[0] = 21.0F;
    buffer.upload();
    Kernel kernel(program_for(device), "twice");
    kernel.set_argument(0, buffer);
    kernel.launch(64, 64);
    device.finish();
    EXPECT_EQ(plane.data()[0], 42.0F);
}

TEST(Buffer, RowsGoToTheirPitchAndBack) {
    Device device(cpu());
    constexpr std::size_t rows = 5;
    constexpr std::size_t host_pitch = 48;
    constexpr std::size_t device_pitch = 64;
    constexpr std::size_t row_bytes = 40;
    Buffer buffer(device, device_pitch * rows, Access::read_write);
    std::vector<std::byte> host(host_pitch * rows);
    for (std::size_t i = 0; i < host.size(); ++i) {
        host[i] = static_cast<std::byte>(i + 1);
    }
    const std::vector<std::byte> blank(device_pitch * rows, std::byte{0xEE});
    buffer.write(blank);
    buffer.write_rows(host.data(), host_pitch, device_pitch, row_bytes, rows);
    std::vector<std::byte> all(device_pitch * rows);
    buffer.read(all);
    std::vector<std::byte> back(host.size(), std::byte{0xDD});
    buffer.read_rows(back.data(), host_pitch, device_pitch, row_bytes, rows);
    for (std::size_t y = 0; y < rows; ++y) {
        for (std::size_t x = 0; x < device_pitch; ++x) {
            ASSERT_EQ(all[y * device_pitch + x], x < row_bytes ? host[y * host_pitch + x] : std::byte{0xEE}) << y;
        }
        for (std::size_t x = 0; x < host_pitch; ++x) {
            ASSERT_EQ(back[y * host_pitch + x], x < row_bytes ? host[y * host_pitch + x] : std::byte{0xDD}) << y;
        }
    }
    EXPECT_THROW(buffer.write_rows(host.data(), host_pitch, device_pitch, row_bytes, rows + 1), RuntimeFailure);
    EXPECT_THROW(buffer.write_rows(host.data(), host_pitch, 32, row_bytes, rows), RuntimeFailure);
}

TEST(Buffer, RefusesWhatCannotBe) {
    Device device(cpu());
    EXPECT_THROW(Buffer(device, 0, Access::read), RuntimeFailure);
    EXPECT_THROW(Buffer(device, std::span<std::byte>(), Access::read), RuntimeFailure);
    AlignedBuffer plane(1024);
    EXPECT_THROW(Buffer(device, bytes_of(plane).subspan(64), Access::read), RuntimeFailure);
    EXPECT_THROW(Buffer(device, bytes_of(plane).first(100), Access::read), RuntimeFailure);
    const std::size_t too_much = device.info().max_allocation + 64;
    EXPECT_THAT(failure_text([&] { Buffer(device, too_much, Access::read); }),
                AllOf(HasSubstr(device.info().name), HasSubstr("--max-mem"), HasSubstr("MiB")));
    Buffer small(device, 16, Access::read);
    EXPECT_THROW(small.write(std::vector<std::byte>(17)), RuntimeFailure);
    std::vector<std::byte> host(17);
    EXPECT_THROW(small.read(host), RuntimeFailure);
    EXPECT_THROW(Buffer().upload(), RuntimeFailure);
}

TEST(Kernel, ErrorsNameKernelAndDevice) {
    Device device(cpu());
    const Program program = program_for(device);
    EXPECT_THAT(failure_text([&] { Kernel(program, "divide"); }),
                AllOf(HasSubstr("'divide'"), HasSubstr(device.info().name), HasSubstr("CL_INVALID_KERNEL_NAME")));
    Kernel kernel(program, "add");
    EXPECT_THAT(failure_text([&] { kernel.launch(64, 64); }),
                AllOf(HasSubstr("'add'"), HasSubstr(device.info().name), HasSubstr("CL_INVALID_KERNEL_ARGS")));
    EXPECT_THAT(failure_text([&] { kernel.launch(65, 64); }), AllOf(HasSubstr("'add'"), HasSubstr("65")));
    EXPECT_THAT(failure_text([&] { kernel.launch(0, 64); }), HasSubstr("'add'"));
    EXPECT_THAT(failure_text([&] { static_cast<void>(kernel.wait_milliseconds()); }), HasSubstr("not launched"));
    EXPECT_THAT(failure_text([&] { kernel.set_argument(9, 1.0F); }),
                AllOf(HasSubstr("argument 9"), HasSubstr("CL_INVALID_ARG_INDEX")));
    EXPECT_THAT(failure_text([&] { kernel.set_argument(3, 1.0); }), HasSubstr("CL_INVALID_ARG_SIZE"));
}

TEST(Kernel, KeepsItsBuffersAlive) {
    Device device(cpu());
    Kernel kernel(program_for(device), "twice");
    {
        const Buffer buffer(device, 256, Access::read_write);
        kernel.set_argument(0, buffer);
    }
    kernel.launch(64, 64);
    EXPECT_GT(kernel.wait_milliseconds(), 0.0);
}

std::vector<float> worked_with(int threads) {
    AlignedBuffer plane(1 << 14);
    std::iota(plane.span().begin(), plane.span().end(), 1.0F);
    Device device(cpu(), threads);
    Buffer buffer(device, bytes_of(plane), Access::read_write);
    buffer.upload();
    Kernel kernel(program_for(device), "work");
    kernel.set_argument(0, buffer);
    kernel.launch(plane.size(), 64);
    buffer.download();
    return {plane.span().begin(), plane.span().end()};
}

TEST(Device, ThreadsLimitComputeUnits) {
    const DeviceInfo info = cpu();
    EXPECT_EQ(Device(info, 1).info().compute_units, 1U);
    EXPECT_EQ(Device(info, 0).info().compute_units, info.compute_units);
    EXPECT_EQ(Device(info, 100000).info().compute_units, info.compute_units);
    EXPECT_THROW(Device(info, -1), DeviceError);
}

TEST(Device, SameBytesForAnyThreadCount) {
    const auto all = worked_with(0);
    const auto one = worked_with(1);
    EXPECT_EQ(std::memcmp(all.data(), one.data(), all.size() * sizeof(float)), 0);
}

TEST(Device, OneThatIsGoneIsAnError) {
    DeviceInfo info = cpu();
    info.index = 77;
    EXPECT_THROW(Device{info}, DeviceError);
}

} // namespace
} // namespace clshade
