// Programs and the cache together, also across processes.
#include "host/base/aligned_buffer.h"
#include "host/base/error.h"
#include "host/device/device.h"
#include "host/device/program.h"
#include "tests/device/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <thread>

namespace clshade {
namespace {

namespace fs = std::filesystem;
using tests::TemporaryFolder;

DeviceInfo cpu() {
    return select_device(list_devices(), "cpu");
}

SourceSet adding(const std::string& what) {
    SourceSet sources;
    sources.add("main.cl", "#include \"op.h\"\n__kernel void k(__global float* o) { o[get_global_id(0)] += VALUE; }\n");
    sources.add("op.h", "#ifndef VALUE\n#define VALUE " + what + "\n#endif\n");
    return sources;
}

/// What the kernel adds to 1 at the last of `size` places.
float run(Device& device, const Program& program, std::size_t size = 64, std::size_t offset = 0) {
    AlignedBuffer plane(size + offset);
    plane.span().back() = 1.0F;
    Buffer buffer(device, std::as_writable_bytes(plane.span()), Access::read_write);
    buffer.upload();
    Kernel kernel(program, "k");
    kernel.set_argument(0, buffer);
    kernel.launch(size, 64, offset);
    static_cast<void>(kernel.wait_milliseconds());
    buffer.download();
    return plane.span().back() - 1.0F;
}

fs::path file_of(const ProgramCache& cache, const Program& program) {
    return cache.folder() / (program.report().identity + ".bin");
}

class ProgramTest : public ::testing::Test {
  protected:
    Program make(const std::string& value = "2.0f", const std::string& options = {}) {
        return {device_, adding(value), "main.cl", options, cache_};
    }

    TemporaryFolder temporary_;
    ProgramCache cache_{temporary_.path() / "clshade"};
    Device device_{cpu()};
};

TEST_F(ProgramTest, SecondOneComesFromTheCache) {
    Program first = make();
    EXPECT_FALSE(first.report().from_cache);
    EXPECT_GT(first.report().milliseconds, 0.0);
    EXPECT_EQ(run(device_, first), 2.0F);
    EXPECT_FALSE(fs::exists(file_of(cache_, first)));
    first.store_binary();
    EXPECT_TRUE(fs::exists(file_of(cache_, first)));

    const Program second = make();
    EXPECT_TRUE(second.report().from_cache);
    EXPECT_EQ(second.report().identity, first.report().identity);
    EXPECT_EQ(run(device_, second), 2.0F);
    EXPECT_FALSE(second.binary().empty());
}

TEST_F(ProgramTest, IdentityFollowsSourcesIncludesAndOptions) {
    const std::string identity = make().report().identity;
    EXPECT_EQ(make().report().identity, identity);
    EXPECT_NE(make("3.0f").report().identity, identity) << "an included file changed";
    EXPECT_NE(make("2.0f", "-DVALUE=4.0f").report().identity, identity) << "an option changed";
    DeviceInfo newer = cpu();
    newer.driver += ".1";
    Device updated(newer);
    const Program program(updated, adding("2.0f"), "main.cl", "", cache_);
    EXPECT_NE(program.report().identity, identity) << "the driver changed";
}

TEST_F(ProgramTest, ThreadLimitSharesTheBinary) {
    Program all = make();
    EXPECT_EQ(run(device_, all), 2.0F);
    all.store_binary();
    Device one(cpu(), 1);
    const Program limited(one, adding("2.0f"), "main.cl", "", cache_);
    EXPECT_TRUE(limited.report().from_cache);
    EXPECT_EQ(run(one, limited), 2.0F);
}

TEST_F(ProgramTest, BinaryTheDriverRefusesIsBuiltAgain) {
    const std::string identity = make().report().identity;
    const std::array<std::byte, 5> garbage{std::byte{'\n'}, std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}};
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, garbage.size()}) {
        cache_.store(identity, std::span(garbage).first(size));
        Program program = make();
        EXPECT_FALSE(program.report().from_cache);
        EXPECT_FALSE(fs::exists(file_of(cache_, program)));
        EXPECT_EQ(run(device_, program), 2.0F);
        program.store_binary();
        EXPECT_TRUE(make().report().from_cache);
    }
}

TEST_F(ProgramTest, StoresAgainOnlyForANewKindOfLaunch) {
    Program first = make();
    EXPECT_EQ(run(device_, first), 2.0F);
    first.store_binary();
    const fs::path file = file_of(cache_, first);
    const auto narrow_size = fs::file_size(file);
    fs::remove(file);
    EXPECT_EQ(run(device_, first, 128), 2.0F);
    first.store_binary();
    EXPECT_FALSE(fs::exists(file)) << "another size of the same kind is no news";
    EXPECT_EQ(run(device_, first, 65536), 2.0F);
    first.store_binary();
    ASSERT_TRUE(fs::exists(file));
    const auto wide_size = fs::file_size(file);
    EXPECT_GT(wide_size, narrow_size);

    Program second = make();
    ASSERT_TRUE(second.report().from_cache);
    EXPECT_EQ(run(device_, second, 65536), 2.0F);
    const auto time = fs::last_write_time(file);
    second.store_binary();
    EXPECT_EQ(fs::last_write_time(file), time) << "what came from the file is no news";
    EXPECT_EQ(run(device_, second, 64, 64), 2.0F);
    second.store_binary();
    EXPECT_GT(fs::file_size(file), wide_size) << "the kinds from the file and the new one";
}

TEST_F(ProgramTest, WithoutACacheItStillRuns) {
    std::ofstream(temporary_.path() / "file") << "in the way";
    for (const ProgramCache& cache : {ProgramCache::disabled(), ProgramCache(temporary_.path() / "file" / "clshade")}) {
        for (int i = 0; i < 2; ++i) {
            Program program(device_, adding("2.0f"), "main.cl", "", cache);
            EXPECT_FALSE(program.report().from_cache);
            EXPECT_EQ(run(device_, program), 2.0F);
            program.store_binary();
        }
    }
}

// Run by the tests below in processes of their own: builds or loads, launches, stores, and writes what it saw.
TEST(ProgramProcess, DISABLED_Child) {
    const char* const folder = std::getenv("CLSHADE_TEST_CACHE");
    const char* const report = std::getenv("CLSHADE_TEST_REPORT");
    ASSERT_NE(folder, nullptr);
    ASSERT_NE(report, nullptr);
    Device device(cpu());
    const auto start = std::chrono::steady_clock::now();
    Program program(device, adding("2.0f"), "main.cl", "", ProgramCache(folder));
    const float result = run(device, program);
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    program.store_binary();
    std::ofstream(report) << result << ' ' << program.report().from_cache << ' ' << spent.count() << '\n';
}

// Run in a process whose OpenCL loader knows no driver, or only a broken one.
TEST(ProgramProcess, DISABLED_NoDriver) {
    const DeviceList list = list_devices();
    EXPECT_TRUE(list.devices.empty());
    EXPECT_THROW(static_cast<void>(select_device(list, "")), DeviceError);
}

// Run in a process where PoCL stands beside a broken driver.
TEST(ProgramProcess, DISABLED_OneGoodDriver) {
    EXPECT_FALSE(list_devices().devices.empty());
}

int run_child(const std::string& variables, const std::string& test) {
    const std::string command = variables + " '" + fs::read_symlink("/proc/self/exe").string() +
                                "' --gtest_also_run_disabled_tests --gtest_filter=ProgramProcess.DISABLED_" + test +
                                " >/dev/null 2>&1";
    return std::system(command.c_str());
}

struct ChildReport {
    float result = 0.0F;
    bool from_cache = false;
    double milliseconds = 0.0; ///< from the source to the end of the first launch
};

class ProcessTest : public ::testing::Test {
  protected:
    ChildReport child(int number) const {
        const fs::path file = temporary_.path() / ("report" + std::to_string(number));
        const std::string variables = "CLSHADE_TEST_CACHE='" + (temporary_.path() / "clshade").string() +
                                      "' CLSHADE_TEST_REPORT='" + file.string() + "'";
        ChildReport report;
        if (run_child(variables, "Child") == 0) {
            std::ifstream(file) >> report.result >> report.from_cache >> report.milliseconds;
        }
        return report;
    }

    TemporaryFolder temporary_;
};

/// A process that finds the binary compiles nothing, not even at its first launch. PoCL's own cache is off, so a
/// compilation would cost some 40 ms or more where loading and launching take 2 to 15; a third is far from both.
TEST_F(ProcessTest, SecondProcessCompilesNothing) {
    const ChildReport cold = child(0);
    EXPECT_EQ(cold.result, 2.0F);
    EXPECT_FALSE(cold.from_cache);
    const ChildReport warm = child(1);
    EXPECT_EQ(warm.result, 2.0F);
    EXPECT_TRUE(warm.from_cache);
    EXPECT_LT(warm.milliseconds, cold.milliseconds / 3.0);
    RecordProperty("cold_ms", std::to_string(cold.milliseconds));
    RecordProperty("warm_ms", std::to_string(warm.milliseconds));
}

TEST_F(ProcessTest, ManyProcessesShareOneFolder) {
    constexpr std::size_t processes = 8;
    for (int round = 0; round < 2; ++round) { // all cold at once, then all warm at once
        std::array<ChildReport, processes> reports;
        std::vector<std::thread> waiting;
        for (std::size_t i = 0; i < processes; ++i) {
            waiting.emplace_back([&, i] { reports.at(i) = child(static_cast<int>(i)); });
        }
        for (std::thread& thread : waiting) {
            thread.join();
        }
        for (const ChildReport& report : reports) {
            EXPECT_EQ(report.result, 2.0F);
            EXPECT_TRUE(round == 0 || report.from_cache);
        }
        std::size_t files = 0;
        for (const auto& entry : fs::directory_iterator(temporary_.path() / "clshade")) {
            EXPECT_EQ(entry.path().extension(), ".bin");
            ++files;
        }
        EXPECT_EQ(files, 1U);
    }
}

TEST_F(ProcessTest, BadDriversAreNoneAndHideNoOthers) {
    const std::string folder = temporary_.path().string();
    const std::string variables = "OCL_ICD_VENDORS='" + folder + "'"; // read by ocl-icd, Debian's OpenCL loader
    EXPECT_EQ(run_child(variables, "NoDriver"), 0);
    std::ofstream(temporary_.path() / "bad.icd") << "libclshade-no-such-driver.so\n";
    EXPECT_EQ(run_child(variables, "NoDriver"), 0);
    std::error_code absent;
    if (fs::copy_file("/etc/OpenCL/vendors/pocl.icd", temporary_.path() / "pocl.icd", absent)) {
        EXPECT_EQ(run_child(variables, "OneGoodDriver"), 0);
    }
}

} // namespace
} // namespace clshade
