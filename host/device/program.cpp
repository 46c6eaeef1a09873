// Building programs, from the cache or from source.
#include "host/base/hash.h"
#include "host/device/opencl.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <sstream>

namespace clshade {

namespace {

/// Counts changes to what a stored binary means.
constexpr int cache_format = 1;
/// PoCL compiles a kernel once more, without knowing the size of the grid, from this many work-items up (its
/// grid_width_specialization_limit).
constexpr std::size_t wide_grid = 65535;
/// A build log longer than this says no more.
constexpr std::size_t most_log_lines = 60;

/// Environment variables that change what PoCL makes of a source.
constexpr std::array<const char*, 6> driver_settings{"POCL_WORK_GROUP_METHOD",        "POCL_EXTRA_BUILD_FLAGS",
                                                     "POCL_KERNELLIB_NAME",           "POCL_LLVM_CPU_NAME",
                                                     "POCL_WILOOPS_MAX_UNROLL_COUNT", "POCL_WORK_GROUP_SPECIALIZATION"};

std::string platform_version(const Device::State& device) {
    const cl::Platform platform(device.device.getInfo<CL_DEVICE_PLATFORM>());
    return platform.getInfo<CL_PLATFORM_VERSION>();
}

/// Everything that can change the binary. Each part carries its length, so that no two lists of parts read alike.
std::string identity_of(const Device::State& device, const std::string& source, const std::string& options) {
    std::vector<std::string> parts{std::to_string(cache_format),
                                   source,
                                   options,
                                   device.info.platform,
                                   device.info.name,
                                   device.info.vendor,
                                   device.info.driver,
                                   device.info.version};
    parts.push_back(
        guarded(device.info, "asking the driver for its version", [&] { return platform_version(device); }));
    for (const char* const name : driver_settings) {
        const char* const value = std::getenv(name);
        parts.push_back(value == nullptr ? std::string() : fmt::format("{}={}", name, value));
    }
    std::string text;
    for (const std::string& part : parts) {
        text += fmt::format("{}:{}\n", part.size(), part);
    }
    return hash_hex(std::string_view(text));
}

std::string trimmed_log(const std::string& log) {
    std::string result;
    std::istringstream lines(log);
    std::string line;
    std::size_t count = 0;
    while (std::getline(lines, line)) {
        line.erase(std::remove(line.begin(), line.end(), '\0'), line.end());
        const auto last = line.find_last_not_of(" \t\r");
        if (last == std::string::npos) {
            continue;
        }
        if (++count <= most_log_lines) {
            result += line.substr(0, last + 1) + "\n";
        }
    }
    if (count > most_log_lines) {
        result += fmt::format("... and {} more lines\n", count - most_log_lines);
    }
    if (!result.empty()) {
        result.pop_back();
    }
    return result;
}

std::string build_log(const cl::Program& program, const cl::Device& device) {
    try {
        return trimmed_log(program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device));
    } catch (const cl::Error&) {
        return "(the driver gives no build log)";
    }
}

cl::Program build_from_source(const Device::State& device, const std::string& source, const std::string& main,
                              const std::string& options) {
    cl::Program program;
    try {
        program = cl::Program(device.context, source);
        program.build({device.device}, options.c_str());
    } catch (const cl::Error& error) {
        const std::string log = program() == nullptr ? std::string() : build_log(program, device.device);
        throw RuntimeFailure(fmt::format("{}: device '{}' cannot build this kernel file (options {}): {} gave {}{}{}",
                                         main, device.info.name, options, error.what(), error_name(error.err()),
                                         log.empty() ? advice_for(error.err()) : "\n", log));
    }
    if (const std::string log = build_log(program, device.device); !log.empty()) {
        spdlog::debug("{}: build log of device '{}':\n{}", main, device.info.name, log);
    }
    return program;
}

/// What the cache stores: the launch shapes that the binary holds finished code for, one a line, an empty line, and
/// the binary.
struct StoredProgram {
    std::set<std::string> shapes;
    std::vector<unsigned char> binary;
};

std::vector<std::byte> pack(const std::set<std::string>& shapes, const std::vector<unsigned char>& binary) {
    std::string text;
    for (const std::string& shape : shapes) {
        text += shape + "\n";
    }
    text += "\n";
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() + binary.size());
    for (const char c : text) {
        bytes.push_back(static_cast<std::byte>(c));
    }
    for (const unsigned char c : binary) {
        bytes.push_back(static_cast<std::byte>(c));
    }
    return bytes;
}

StoredProgram unpack(const std::vector<std::byte>& bytes) {
    StoredProgram stored;
    std::string line;
    auto next = bytes.begin();
    for (; next != bytes.end(); ++next) {
        const char c = static_cast<char>(*next);
        if (c != '\n') {
            line += c;
        } else if (line.empty()) {
            ++next;
            break;
        } else {
            stored.shapes.insert(std::move(line));
            line.clear();
        }
    }
    std::transform(next, bytes.end(), std::back_inserter(stored.binary),
                   [](std::byte b) { return static_cast<unsigned char>(b); });
    return stored;
}

/// The program from its stored binary; nothing if the driver does not take it.
std::optional<cl::Program> build_from_binary(const Device::State& device, const std::vector<unsigned char>& binary,
                                             const std::string& options) {
    if (binary.empty()) {
        return std::nullopt;
    }
    try {
        cl::Program program(device.context, {device.device}, cl::Program::Binaries{binary});
        program.build({device.device}, options.c_str());
        return program;
    } catch (const cl::Error& error) {
        spdlog::debug("{} gave {} for a stored binary", error.what(), error_name(error.err()));
        return std::nullopt;
    }
}

bool load_stored(Program::State& state, const std::string& main, const std::string& options) {
    const auto bytes = state.cache.load(state.report.identity);
    if (!bytes) {
        return false;
    }
    StoredProgram stored = unpack(*bytes);
    auto program = build_from_binary(*state.device, stored.binary, options);
    if (!program) {
        spdlog::warn("kernel cache: device '{}' does not take the stored binary of {}; it is dropped and built again",
                     state.device->info.name, main);
        state.cache.discard(state.report.identity);
        return false;
    }
    state.program = std::move(*program);
    state.stored = std::move(stored.shapes);
    state.on_disk = true;
    return true;
}

std::vector<unsigned char> binary_of(const Program::State& state) {
    return guarded(state.device->info, "asking for the built program", [&] {
        auto binaries = state.program.getInfo<CL_PROGRAM_BINARIES>();
        if (binaries.empty()) {
            throw cl::Error(CL_INVALID_PROGRAM_EXECUTABLE, "clGetProgramInfo");
        }
        return std::move(binaries.front());
    });
}

} // namespace

void Program::State::note_launch(const std::string& kernel, std::size_t global, std::size_t local, std::size_t offset) {
    std::string shape =
        fmt::format("{} {}{}{}", kernel, local, offset != 0 ? " offset" : "", global >= wide_grid ? " wide" : "");
    const std::scoped_lock lock(mutex);
    launched.insert(std::move(shape));
}

Program::Program(Device& device, const SourceSet& sources, const std::string& main, const std::string& options,
                 const ProgramCache& cache)
    : state_(std::make_shared<State>()) {
    const auto start = std::chrono::steady_clock::now();
    state_->device = device.state();
    state_->cache = cache;
    const std::string source = sources.expand(main);
    const std::string all_options = options.empty() ? "-cl-std=CL1.2" : "-cl-std=CL1.2 " + options;
    state_->report.identity = identity_of(*state_->device, source, all_options);
    state_->report.from_cache = load_stored(*state_, main, all_options);
    if (!state_->report.from_cache) {
        // Kept until the first launch has made machine code of it and the cache has that: see store_binary().
        state_->building = std::make_unique<BuildLock>(cache.folder(), state_->report.identity);
        state_->report.from_cache = load_stored(*state_, main, all_options); // by whoever was first
        if (state_->report.from_cache) {
            state_->building.reset();
        } else {
            state_->program = build_from_source(*state_->device, source, main, all_options);
        }
    }
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    state_->report.milliseconds = spent.count();
}

const BuildReport& Program::report() const {
    return state_->report;
}

std::vector<std::byte> Program::binary() const {
    const auto binary = binary_of(*state_);
    const auto bytes = std::as_bytes(std::span(binary));
    return {bytes.begin(), bytes.end()};
}

void Program::store_binary() {
    State& state = *state_;
    const std::scoped_lock lock(state.mutex);
    if (state.cache.folder().empty()) {
        return;
    }
    if (state.on_disk &&
        std::includes(state.stored.begin(), state.stored.end(), state.launched.begin(), state.launched.end())) {
        return;
    }
    // A program that came from the disk gives back what was in its binary, so the new file holds both.
    state.stored.insert(state.launched.begin(), state.launched.end());
    state.on_disk = true; // one try: a cache that cannot be written is not asked again for the same shapes
    state.cache.store(state.report.identity, pack(state.stored, binary_of(state)));
    state.building.reset();
}

} // namespace clshade
