// What it takes to see a build as the first user of a machine sees it: an empty folder, and sources nobody has built.
#pragma once

#include "host/device/program.h"

#include <filesystem>
#include <string>
#include <vector>

namespace clshade {

/// A folder of our own, gone with its content at the end.
class BuildFolder {
  public:
    /// Throws RuntimeFailure.
    explicit BuildFolder(const std::string& name);
    ~BuildFolder();
    BuildFolder(const BuildFolder&) = delete;
    BuildFolder& operator=(const BuildFolder&) = delete;
    BuildFolder(BuildFolder&&) = delete;
    BuildFolder& operator=(BuildFolder&&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// A name nobody has used before, fit for C and for a folder.
[[nodiscard]] std::string new_mark();

/// The kernel sources, the given main files with a type of that name that nobody uses: drivers cache what the
/// preprocessor leaves, so a comment would not do.
[[nodiscard]] SourceSet marked_sources(const std::filesystem::path& kernel_dir, const std::vector<std::string>& mains,
                                       const std::string& mark);

} // namespace clshade
