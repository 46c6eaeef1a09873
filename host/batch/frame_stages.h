// The stages a frame goes through, each a function of one frame: plan, read, shade, write.
#pragma once

#include "host/batch/batch.h"
#include "host/batch/frame_input.h"
#include "host/batch/slab_pool.h"

#include <cstdint>
#include <exception>
#include <filesystem>
#include <set>
#include <string>

namespace clshade {

/// What shows that somebody has written a file anew.
struct FileState {
    std::uintmax_t size = 0;
    std::filesystem::file_time_type written;

    bool operator==(const FileState&) const = default;
};

/// A frame under way.
struct FrameWork {
    const FrameJob* job = nullptr;
    FileState input; ///< when it was planned
    FrameOutcome outcome;
    std::exception_ptr failure;
    bool done = false; ///< written, or skipped
    PlannedInput planned;
    LoadedFrame loaded;
    ShadedImage shaded;
    const EnvironmentInput* environment = nullptr; ///< what it was shaded with
    const DeviceInfo* device = nullptr;

    /// Is there more to do?
    [[nodiscard]] bool open() const { return !failure && !done; }
};

/// `plan` and `shade` are for one thread at a time, the others for any number. Each throws what made it fail; the
/// frame's memory goes back to the pool in any case.
class FrameStages {
  public:
    FrameStages(const RunScene& scene, const BatchSettings& settings, BatchResources& resources,
                BatchListener& listener);

    /// Checks the paths, decides whether there is anything to do, reads the header, binds the scene.
    void plan(FrameWork& work) const;
    void read(FrameWork& work);
    void shade(FrameWork& work);
    void write(FrameWork& work);
    /// read, shade and write in one, band after band; memory of the process stays below `limit` bytes if that can be.
    void shade_in_bands(FrameWork& work, std::uint64_t limit);

    /// Planes that shading the planned frame writes.
    [[nodiscard]] int outputs_of(const FrameWork& work) const;
    /// Gives a frame's memory back.
    void release(FrameWork& work);
    [[nodiscard]] SlabPool& pool() { return pool_; }

  private:
    /// The shader, and the frame joined to its environment.
    [[nodiscard]] Shader& prepare(FrameWork& work);
    /// Times, counts and the kernel's identity.
    void account(FrameWork& work, const ShadedImage& shaded, double elapsed);
    /// Throws RuntimeFailure if the G-buffer has been written anew since it was planned.
    static void refuse_changed(const FrameWork& work);
    /// After the output stands: the same, with the output marked as older than the new G-buffer, so that -u makes it
    /// again.
    void finish(FrameWork& work) const;
    [[nodiscard]] Replace replace() const { return settings_.no_clobber ? Replace::no : Replace::yes; }
    void accept_file(FrameWork& work, const WrittenFile& file, const std::filesystem::path& path) const;

    const RunScene& scene_;
    const BatchSettings& settings_;
    BatchResources& resources_;
    BatchListener& listener_;
    std::string identity_;
    SlabPool pool_;
    std::set<std::string> programs_; ///< met so far: a build belongs to the first frame of a program
    bool environment_told_ = false;
};

} // namespace clshade
