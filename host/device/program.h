// Programs and kernels: building from sources, the binary cache on disk, launching and timing.
#pragma once

#include "host/device/device.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace clshade {

/// OpenCL sources by file name. `#include "name"` is resolved among them, on the host, each file once; the build log
/// speaks of the real files and lines.
class SourceSet {
  public:
    SourceSet() = default;
    /// Adds or replaces a file. `path` is what build logs print (the name itself, or where it was read from).
    void add(const std::string& name, std::string text, const std::string& path = {});
    /// Replaces every file of the set that also lies in `folder`, and adds its other *.cl and *.h (--kernel-dir).
    /// Throws UsageError if the folder does not exist or holds none of the set's files.
    void override_from(const std::filesystem::path& folder);
    [[nodiscard]] bool contains(std::string_view name) const;
    [[nodiscard]] const std::string& text(std::string_view name) const;
    [[nodiscard]] std::vector<std::string> names() const;
    /// `main` with its includes expanded and #line directives. Throws RuntimeFailure for a missing include, naming the
    /// file and line that asks for it.
    [[nodiscard]] std::string expand(const std::string& main) const;

  private:
    struct File {
        std::string text;
        std::string path;
    };
    std::map<std::string, File, std::less<>> files_;
};

/// Binaries on disk, one file per program identity, shared safely by any number of processes.
class ProgramCache {
  public:
    /// The default folder: $XDG_CACHE_HOME/clshade, else ~/.cache/clshade; no folder can be had: caching is off.
    [[nodiscard]] static ProgramCache standard();
    /// Never reads, never writes.
    [[nodiscard]] static ProgramCache disabled();
    explicit ProgramCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The binary stored under `identity`, if it is whole: header, identity, length and checksum agree. Anything
    /// doubtful is removed, logged in one line and reported as absent.
    [[nodiscard]] std::optional<std::vector<std::byte>> load(const std::string& identity) const;
    /// Stores through a temporary file, checksum and rename. Failure to store is logged, never an error.
    void store(const std::string& identity, std::span<const std::byte> binary) const;
    void discard(const std::string& identity) const;
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_; ///< empty: disabled
};

struct BuildReport {
    std::string identity; ///< hash of sources, options, device, driver, platform and cache format version
    bool from_cache = false;
    double milliseconds = 0.0;
};

/// A built program. Copyable handle.
class Program {
  public:
    /// Loads from the cache or builds `main` of `sources` with "-cl-std=CL1.2" and `options`. Throws RuntimeFailure
    /// with the device's name and the build log (real file names and lines). Nothing is stored yet: see store_binary().
    Program(Device& device, const SourceSet& sources, const std::string& main, const std::string& options,
            const ProgramCache& cache);

    [[nodiscard]] const BuildReport& report() const;
    /// Stores the program in its cache. Call it when a frame's launches have finished: PoCL compiles a kernel to
    /// machine code at its first launch, and a binary fetched earlier would make the next process compile again (40 ms
    /// and more for each kernel). Calls without a new kind of launch (kernel, local size, offset or none, wide or
    /// narrow grid) since the last do nothing, so it may be called after every frame. Failure to store is logged, never
    /// an error.
    void store_binary();
    /// The built device binary (for tests that count vector instructions).
    [[nodiscard]] std::vector<std::byte> binary() const;

    struct State;
    [[nodiscard]] const std::shared_ptr<State>& state() const { return state_; }

  private:
    std::shared_ptr<State> state_;
};

/// One kernel with its arguments. Not shared between threads.
class Kernel {
  public:
    /// Throws RuntimeFailure if the program has no such kernel.
    Kernel(const Program& program, const std::string& name);

    void set_argument(unsigned index, const Buffer& buffer);
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void set_argument(unsigned index, const T& value) { set_bytes(index, std::as_bytes(std::span(&value, 1))); }

    /// Enqueues on the device's queue over [offset, offset + global) work-items in groups of `local`; global must be a
    /// multiple of local. Returns at once.
    void launch(std::size_t global, std::size_t local, std::size_t offset = 0);
    /// Waits for the last launch and returns its duration on the device in milliseconds (event profiling).
    [[nodiscard]] double wait_milliseconds();

  private:
    void set_bytes(unsigned index, std::span<const std::byte> bytes);
    struct State;
    std::shared_ptr<State> state_;
};

} // namespace clshade
