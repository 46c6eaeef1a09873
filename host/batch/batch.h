// Many frames from files to files: decode, shade and encode overlap over whole frames, in bounded memory.
#pragma once

#include "host/batch/frame_job.h"
#include "host/batch/frame_outcome.h"
#include "host/batch/run_scene.h"
#include "host/environment/environment_input.h"
#include "host/images/image_writer.h"
#include "host/shading/shader.h"

#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace clshade {

/// What is done with every frame.
struct BatchSettings {
    AovSelection aovs;
    std::vector<std::string> keep; ///< input layers passed through
    std::string view;              ///< of stereo files
    ExrSettings exr;
    bool update_only = false; ///< skip frames whose output is complete, of the same job and newer than its sources
    bool no_clobber = false;
    std::vector<std::filesystem::path> tools; ///< further sources: the program, replaced kernels
    bool hash_inputs = false;                 ///< for a manifest
    int threads = 1;
    std::uint64_t max_memory = 0; ///< bytes the process may keep resident; 0: as many frames at once as are useful
};

/// What all frames share, made when the first one needs it. Called by one thread at a time.
class BatchResources {
  public:
    BatchResources() = default;
    virtual ~BatchResources() = default;
    BatchResources(const BatchResources&) = delete;
    BatchResources& operator=(const BatchResources&) = delete;
    BatchResources(BatchResources&&) = delete;
    BatchResources& operator=(BatchResources&&) = delete;

    /// Throws DeviceError.
    virtual Shader& shader() = 0;
    virtual const DeviceInfo& device() = 0;
    /// The picture read and filtered; null for a scene without environment. Times go to `stages`. Throws as reading
    /// and filtering do.
    virtual const EnvironmentInput* environment(StageTimes& stages) = 0;
    /// Where the environment's maps came from, "built" or "from the cache"; told once, empty after that.
    virtual std::string take_environment_origin() { return {}; }
    /// Before a frame's kernel is built, for --dump-kernel.
    virtual void about_to_shade(const Frame& /*frame*/) {}
};

/// Told of frames in the order of the jobs, by one thread at a time.
class BatchListener {
  public:
    BatchListener() = default;
    virtual ~BatchListener() = default;
    BatchListener(const BatchListener&) = delete;
    BatchListener& operator=(const BatchListener&) = delete;
    BatchListener(BatchListener&&) = delete;
    BatchListener& operator=(BatchListener&&) = delete;

    virtual void finished(const FrameJob& job, const FrameOutcome& outcome) = 0;
    /// False: no further frames; run_batch throws the failure on.
    virtual bool failed(const FrameJob& job, const std::exception_ptr& failure) = 0;
    /// What is being done, for people; called by any thread.
    virtual void doing(const FrameJob& /*job*/, const std::string& /*what*/) {}
    /// Asked often, by any thread: true ends the run. Frames in flight are discarded.
    [[nodiscard]] virtual bool interrupted() const { return false; }
};

/// Shades the jobs on settings.threads threads. Pixels depend on neither threads nor memory nor order. A frame that
/// does not fit max_memory is shaded in bands. Returns when all are done, a failure was not to be survived, or it was
/// interrupted.
void run_batch(std::span<const FrameJob> jobs, const RunScene& scene, const BatchSettings& settings,
               BatchResources& resources, BatchListener& listener);

} // namespace clshade
