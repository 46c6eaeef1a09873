// A sequence of small G-buffers and a run over them.
#pragma once

#include "host/batch/batch.h"
#include "host/scene/scene_file.h"
#include "host/shading/kernel_library.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace clshade::tests {

/// The CPU device and one shader for all tests of a fixture.
class TestResources final : public BatchResources {
  public:
    explicit TestResources(const AovSelection& aovs = {})
        : device_(select_device(list_devices(), "cpu")),
          shader_(device_, kernel_sources(), ProgramCache::standard(), {.aovs = aovs}) {}

    Shader& shader() override { return shader_; }
    const DeviceInfo& device() override { return device_.info(); }
    const EnvironmentInput* environment(StageTimes& /*stages*/) override { return nullptr; }

  private:
    Device device_;
    Shader shader_;
};

/// Notes what it is told.
class TestListener : public BatchListener {
  public:
    void finished(const FrameJob& job, const FrameOutcome& outcome) override {
        done.push_back(job.number.value_or(0));
        outcomes.push_back(outcome);
    }
    bool failed(const FrameJob& job, const std::exception_ptr& failure) override {
        bad.push_back(job.number.value_or(0));
        try {
            std::rethrow_exception(failure);
        } catch (const std::exception& error) {
            messages.emplace_back(error.what());
        }
        return go_on;
    }
    [[nodiscard]] bool interrupted() const override { return done.size() >= stop_after; }

    bool go_on = true;
    std::size_t stop_after = static_cast<std::size_t>(-1);
    std::vector<int> done;
    std::vector<int> bad;
    std::vector<FrameOutcome> outcomes;
    std::vector<std::string> messages;
};

/// One light and the roles' materials; no environment, so that nothing has to be filtered.
inline RunScene plain_scene() {
    RunScene run;
    run.scene = default_scene({}, "");
    run.scene.environment.reset();
    run.name = "plain";
    run.hash = "1";
    return run;
}

inline std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Files of a folder, temporaries among them.
inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    return names;
}

} // namespace clshade::tests
