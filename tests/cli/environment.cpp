// Own folders for the binary caches of clshade and of PoCL: tests leave nothing behind in the user's, and share what
// they build among themselves.
#include "tests/cli/run_program.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

namespace clshade::tests {
namespace {

class OwnCaches : public ::testing::Environment {
  public:
    void SetUp() override {
        folder_.emplace();
        ::setenv("POCL_CACHE_DIR", (*folder_ / "pocl").c_str(), 1);
        ::setenv("XDG_CACHE_HOME", (*folder_ / "xdg").c_str(), 1);
    }
    void TearDown() override { folder_.reset(); }

  private:
    std::optional<TemporaryFolder> folder_;
};

// GoogleTest owns and deletes the environment.
[[maybe_unused]] const auto* const own_caches = ::testing::AddGlobalTestEnvironment(new OwnCaches);

} // namespace
} // namespace clshade::tests
