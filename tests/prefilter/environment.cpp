// Keeps PoCL's own kernel cache out of the way, before anything touches OpenCL: with it, a "cold" build would be warm.
#include "tests/device/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

namespace clshade::tests {
namespace {

class OwnCaches : public ::testing::Environment {
  public:
    void SetUp() override {
        folder_.emplace();
        ::setenv("POCL_CACHE_DIR", (folder_->path() / "pocl").c_str(), 1);
        ::setenv("POCL_KERNEL_CACHE", "0", 1);
        ::setenv("XDG_CACHE_HOME", (folder_->path() / "xdg").c_str(), 1);
    }
    void TearDown() override { folder_.reset(); }

  private:
    std::optional<TemporaryFolder> folder_;
};

// GoogleTest owns and deletes the environment.
[[maybe_unused]] const auto* const own_caches = ::testing::AddGlobalTestEnvironment(new OwnCaches);

} // namespace
} // namespace clshade::tests
