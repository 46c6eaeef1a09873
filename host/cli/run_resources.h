// What the frames of a run share: device, shader, environment.
#pragma once

#include "host/batch/batch.h"
#include "host/cli/kernel_dump.h"
#include "host/cli/progress.h"
#include "host/cli/run_environment.h"
#include "host/cli/session.h"

#include <string>
#include <utility>

namespace clshade::cli {

/// Opens the device and reads the environment when a frame first asks for them. Refers to its arguments.
class RunResources final : public BatchResources {
  public:
    /// `dump` may be null: no --dump-kernel.
    RunResources(const RunScene& scene, const AovSelection& aovs, std::uint64_t max_memory, Session& session,
                 Progress& progress, KernelDump* dump)
        : aovs_(aovs), session_(session), progress_(progress), environment_(scene.scene, max_memory), dump_(dump) {}

    Shader& shader() override { return session_.shader(aovs_); }
    const DeviceInfo& device() override { return session_.info(); }
    const EnvironmentInput* environment(StageTimes& stages) override;
    std::string take_environment_origin() override { return std::exchange(origin_, {}); }
    void about_to_shade(const Frame& frame) override;

    /// Reading or filtering the environment has thrown: no other frame could do better.
    [[nodiscard]] bool environment_failed() const { return environment_.has_failed(); }

  private:
    AovSelection aovs_;
    Session& session_;
    Progress& progress_;
    RunEnvironment environment_;
    KernelDump* dump_;
    std::string origin_;
};

} // namespace clshade::cli
