// The OpenCL rivals: the stream of the same bytes, and the kernel as it is usually written.
#pragma once

#include "host/base/plane_slab.h"
#include "host/device/device.h"
#include "host/device/program.h"
#include "host/gbuffer/frame.h"
#include "host/shading/shader.h"

#include <memory>
#include <span>

namespace clshade {

/// The sources of bench/kernels, embedded at build time.
[[nodiscard]] SourceSet rival_sources();

/// Streams the first planes of a bench frame into as many planes as a shading kernel writes.
class StreamRival {
  public:
    /// planes_in 1 to 16, planes_out 1 to 4. Throws RuntimeFailure.
    StreamRival(Device& device, std::shared_ptr<PictureMemory> memory, std::size_t plane_stride, int planes_in,
                int planes_out, int lanes);
    /// Runs once; milliseconds on the device.
    double run();

  private:
    std::shared_ptr<PictureMemory> memory_;
    Kernel kernel_;
    std::size_t work_items_;
};

/// Blinn-Phong and Lambert with one distant light through image2d_t, float4 and pow.
class NaiveRival {
  public:
    /// Copies the frame's planes into images. Throws RuntimeFailure, and std::invalid_argument unless the frame has one
    /// distant light.
    NaiveRival(Device& device, const Frame& frame);
    ~NaiveRival();
    NaiveRival(const NaiveRival&) = delete;
    NaiveRival& operator=(const NaiveRival&) = delete;
    NaiveRival(NaiveRival&&) = delete;
    NaiveRival& operator=(NaiveRival&&) = delete;
    /// False where the device has no images.
    [[nodiscard]] static bool supported(const Device& device);
    double run();
    /// Fetches what run() wrote: RGBA interleaved, width * height * 4 floats.
    [[nodiscard]] std::span<const float> output();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace clshade
