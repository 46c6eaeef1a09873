// `shade --dump-kernel DIR`: the programs of a run as files, for people to read.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/shading/shader.h"

#include <filesystem>
#include <string>
#include <vector>

namespace clshade::cli {

/// Writes every file of a program as it is built, and options.txt with the kernel's key and the options of the build.
/// The first program goes into the folder itself, each further one (frames with other planes or materials) into a
/// sub-folder "2", "3", ...
class KernelDump {
  public:
    /// `folder` empty: dumps nothing. Throws UsageError if `folder` is the one that --kernel-dir reads (may be empty):
    /// the generated files would replace the kernels there.
    KernelDump(std::filesystem::path folder, const std::filesystem::path& kernel_dir);

    /// Dumps the program that `shader` builds for `frame`, unless it has been dumped already. Makes the folder and
    /// replaces files there. Throws RuntimeFailure naming what cannot be written.
    void add(const Shader& shader, const Frame& frame);

  private:
    std::filesystem::path folder_;
    std::vector<std::string> dumped_; ///< the whole text of each program
};

} // namespace clshade::cli
