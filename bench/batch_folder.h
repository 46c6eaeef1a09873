// Where a batch row's files lie while it runs.
#pragma once

#include "host/images/temporary_file.h"

#include <filesystem>
#include <string>
#include <vector>

namespace clshade {

/// A folder in TMPDIR for the frames of a sequence and of two outputs; removed with them at the end and on a signal.
class BatchFolder {
  public:
    /// Throws RuntimeFailure.
    explicit BatchFolder(int frames);

    [[nodiscard]] const std::vector<std::filesystem::path>& inputs() const { return inputs_; }
    [[nodiscard]] const std::vector<std::filesystem::path>& ours() const { return ours_; }
    [[nodiscard]] const std::vector<std::filesystem::path>& theirs() const { return theirs_; }

    /// Waits until everything written to the folder's file system is on the disk, so that nobody pays for another.
    void settle() const;

  private:
    explicit BatchFolder(std::vector<std::string> names);

    StagedFolder folder_;
    std::vector<std::filesystem::path> inputs_;
    std::vector<std::filesystem::path> ours_;
    std::vector<std::filesystem::path> theirs_;
};

} // namespace clshade
