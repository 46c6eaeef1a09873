// Choosing among made-up devices.
#include "host/device/device.h"
#include "tests/device/failure_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clshade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::failure_text;

DeviceInfo device(int index, const char* platform, const char* name, DeviceKind kind) {
    DeviceInfo info;
    info.index = index;
    info.platform = platform;
    info.name = name;
    info.kind = kind;
    return info;
}

DeviceList workstation() {
    return {{device(0, "NVIDIA CUDA", "NVIDIA H100 PCIe", DeviceKind::gpu),
             device(1, "NVIDIA CUDA", "Quadro T400", DeviceKind::gpu),
             device(2, "Portable Computing Language", "pthread-AMD EPYC", DeviceKind::cpu)},
            {}};
}

TEST(SelectDevice, ByIndex) {
    EXPECT_EQ(select_device(workstation(), "0").index, 0);
    EXPECT_EQ(select_device(workstation(), "2").index, 2);
    EXPECT_EQ(select_device(workstation(), "02").index, 2);
}

TEST(SelectDevice, NumberIsNeverPartOfAName) {
    EXPECT_THROW(static_cast<void>(select_device(workstation(), "100")), DeviceError);
    EXPECT_THROW(static_cast<void>(select_device(workstation(), "3")), DeviceError);
    EXPECT_THROW(static_cast<void>(select_device(workstation(), "99999999999999999999")), DeviceError);
}

TEST(SelectDevice, ByKind) {
    EXPECT_EQ(select_device(workstation(), "cpu").index, 2);
    EXPECT_EQ(select_device(workstation(), "CPU").index, 2);
    EXPECT_THAT(failure_text([] { static_cast<void>(select_device(workstation(), "gpu")); }),
                AllOf(HasSubstr("0: NVIDIA CUDA/NVIDIA H100 PCIe"), HasSubstr("1: NVIDIA CUDA/Quadro T400"),
                      Not(HasSubstr("EPYC"))));
}

TEST(SelectDevice, BySubstringOfPlatformAndName) {
    EXPECT_EQ(select_device(workstation(), "h100").index, 0);
    EXPECT_EQ(select_device(workstation(), "portable").index, 2);
    EXPECT_EQ(select_device(workstation(), "cuda/quadro").index, 1);
    EXPECT_THAT(failure_text([] { static_cast<void>(select_device(workstation(), "nvidia")); }),
                AllOf(HasSubstr("ambiguous"), HasSubstr("0: "), HasSubstr("1: "), Not(HasSubstr("2: "))));
}

TEST(SelectDevice, AbsenceListsWhatThereIs) {
    EXPECT_THAT(failure_text([] { static_cast<void>(select_device(workstation(), "radeon")); }),
                AllOf(HasSubstr("'radeon'"), HasSubstr("0: "), HasSubstr("1: "), HasSubstr("2: "),
                      HasSubstr("pthread-AMD EPYC (cpu)")));
    const DeviceList only_cpu{{device(0, "PoCL", "cpu", DeviceKind::cpu)}, {}};
    EXPECT_THROW(static_cast<void>(select_device(only_cpu, "gpu")), DeviceError);
}

TEST(SelectDevice, DefaultIsTheOnlyDeviceOrTheOnlyGpu) {
    EXPECT_THAT(failure_text([] { static_cast<void>(select_device(workstation(), "")); }),
                AllOf(HasSubstr("--device"), HasSubstr("0: "), HasSubstr("1: ")));
    const DeviceList only_cpu{{device(0, "PoCL", "a", DeviceKind::cpu)}, {}};
    EXPECT_EQ(select_device(only_cpu, "").index, 0);
    DeviceList one_gpu = workstation();
    one_gpu.devices.erase(one_gpu.devices.begin());
    EXPECT_EQ(select_device(one_gpu, "").index, 1);
    const DeviceList two_cpus{{device(0, "PoCL", "a", DeviceKind::cpu), device(1, "Intel", "b", DeviceKind::cpu)}, {}};
    EXPECT_THROW(static_cast<void>(select_device(two_cpus, "")), DeviceError);
}

TEST(SelectDevice, NoDeviceTellsWhatToInstallAndWhatFailed) {
    const DeviceList none{{}, {"OpenCL platform 'Broken' cannot be used"}};
    for (const char* const selector : {"", "0", "cpu"}) {
        EXPECT_THAT(failure_text([&] { static_cast<void>(select_device(none, selector)); }),
                    AllOf(HasSubstr("install pocl-opencl-icd"), HasSubstr("'Broken'")));
    }
    try {
        static_cast<void>(select_device({}, ""));
        FAIL() << "nothing was thrown";
    } catch (const DeviceError& error) {
        EXPECT_EQ(error.exit_code(), ExitCode::no_device);
    }
}

TEST(ListDevices, TellsTheBasics) {
    const DeviceList list = list_devices();
    ASSERT_FALSE(list.devices.empty()) << "the tests need a CPU device: install pocl-opencl-icd";
    for (std::size_t i = 0; i < list.devices.size(); ++i) {
        const DeviceInfo& info = list.devices[i];
        EXPECT_EQ(info.index, static_cast<int>(i));
        EXPECT_FALSE(info.name.empty());
        EXPECT_FALSE(info.platform.empty());
        EXPECT_FALSE(info.driver.empty());
        EXPECT_GT(info.compute_units, 0U);
        EXPECT_GT(info.max_allocation, 0U);
        EXPECT_GE(info.preferred_float_lanes, 1U);
    }
}

} // namespace
} // namespace clshade
