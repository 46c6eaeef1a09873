// Our own pipeline as a contestant: what `clshade shade` runs, without the command line.
#pragma once

#include "bench/benchmark.h"
#include "host/batch/batch.h"
#include "host/device/device.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace clshade {

struct OurWork {
    std::vector<std::filesystem::path> inputs;
    std::vector<std::filesystem::path> outputs;
    bool half = true;
    std::string compression; ///< "zip", "zip:4"
};

struct OurRun {
    double milliseconds = 0.0;
    std::uint64_t bytes_read = 0;
    std::uint64_t bytes_written = 0;
};

class BatchContestant {
  public:
    /// One distant light, materials as the planes have them. Refers to the device.
    BatchContestant(Device& device, const BenchOptions& options, int threads);
    ~BatchContestant();
    BatchContestant(BatchContestant&&) noexcept;
    BatchContestant& operator=(BatchContestant&&) noexcept;
    BatchContestant(const BatchContestant&) = delete;
    BatchContestant& operator=(const BatchContestant&) = delete;

    /// All frames. The first run of a contestant builds the kernel. Throws as run_batch does.
    [[nodiscard]] OurRun run(const OurWork& work);

    /// The channels that are read of a file, by the names that they have in it.
    [[nodiscard]] std::vector<std::string> channels(const std::filesystem::path& file) const;
    /// The scene's only light, travelling direction and power as in scene.h.
    [[nodiscard]] const Light& light() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// "zip:4" into a name and a level. Throws UsageError as check_exr_settings does.
[[nodiscard]] ExrSettings encoding_of(bool half, const std::string& compression);

} // namespace clshade
