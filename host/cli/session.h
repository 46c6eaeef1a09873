// One run's device: chosen early, opened when the input has proved good.
#pragma once

#include "host/cli/options.h"
#include "host/device/device.h"
#include "host/prefilter/prefilter.h"
#include "host/shading/shader.h"

#include <optional>
#include <string>

namespace clshade::cli {

/// The device and the shader of a run, each made once and only when asked for.
class Session {
  public:
    explicit Session(const CommonOptions& options) : options_(options) {}

    /// Chooses on first use. Throws DeviceError.
    [[nodiscard]] const DeviceInfo& info();
    /// Opens on first use. Throws DeviceError.
    [[nodiscard]] Device& device();
    /// Made on first use with the outputs of that call. Throws like device(), and UsageError for a bad --kernel-dir.
    [[nodiscard]] Shader& shader(const AovSelection& aovs);
    /// Made on first use, with the kernels and lanes that the shader takes. Throws like shader().
    [[nodiscard]] Prefilter& prefilter();
    /// --lanes; for `auto` what `bench --tune` stored for this device, else 0: the shader's own choice.
    [[nodiscard]] int lanes();

  private:
    CommonOptions options_;
    std::optional<DeviceInfo> info_;
    std::optional<Device> device_;
    std::optional<Shader> shader_;
    std::optional<Prefilter> prefilter_;
};

} // namespace clshade::cli
