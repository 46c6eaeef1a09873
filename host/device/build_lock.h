// Private to host/device: one process at a time builds a program.
#pragma once

#include <filesystem>
#include <string>

namespace clshade {

/// While it lives, other processes with the same cache that want the same program wait for it, and find it in the cache
/// then. Many processes that begin together (a farm's node with a cold cache) would else compile the same thing side by
/// side, which PoCL 3.1 does not always survive (CL_BUILD_PROGRAM_FAILURE). A process does not wait for itself. Waiting
/// ends after a minute, and a folder that cannot be written is no reason to wait: the lock saves work and trouble, and
/// nothing depends on it.
class BuildLock {
  public:
    BuildLock(const std::filesystem::path& folder, const std::string& identity);
    ~BuildLock();
    BuildLock(const BuildLock&) = delete;
    BuildLock& operator=(const BuildLock&) = delete;
    BuildLock(BuildLock&&) = delete;
    BuildLock& operator=(BuildLock&&) = delete;

  private:
    std::filesystem::path file_;
    int descriptor_ = -1;
};

} // namespace clshade
