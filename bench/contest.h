// Rivals as contestants: made once per group, checked against the device's picture, then timed.
#pragma once

#include "bench/bench_rows.h"
#include "bench/host_rivals.h"
#include "host/shading/shader.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace clshade {

/// Largest |a - b| / (1e-3 + |b|) over R, G, B of two pictures; NaN counts as infinite. The floor keeps pixels that
/// are next to black from deciding.
[[nodiscard]] double picture_difference(const PlaneSlab& device,
                                        const std::function<double(int plane, int x, int y)>& other);

/// What is allowed: every rival works in single precision with N.H in its usual form, which near 256 leaves 1e-4 of
/// the lobe (models.md section 14); one that left a term out is off by far more.
inline constexpr double rival_tolerance = 5e-4;

/// A rival ready to run. status other than ok: it cannot take part, for the reason given.
struct RivalEntry {
    BenchStatus status = BenchStatus::ok;
    std::string reason;
    bool slow = false;
    std::function<double()> run; ///< once; milliseconds
    /// Difference of what the last run wrote from the device's picture (streams: from the sums of the planes).
    std::function<double(const PlaneSlab& picture)> difference;
};

/// Fills what is written with NaN, so that a rival that writes nothing cannot pass with another's picture.
void spoil(PictureMemory& memory);

/// What a rival of a row works on; rivals of equal id are one contestant.
[[nodiscard]] std::string rival_id(Rival rival, const BenchRow& row, int planes_in, int planes_out);

/// Makes the rivals of one bench frame. They read and write where the kernels do: time depends on which pages memory
/// got. Refers to device and frame.
class RivalMaker {
  public:
    /// `memory` is of the frame's planes and four outputs.
    RivalMaker(Device& device, Frame& frame, std::shared_ptr<PictureMemory> memory, int threads, int lanes)
        : device_(&device), frame_(&frame), memory_(std::move(memory)), threads_(threads), lanes_(lanes) {}

    /// The rival for a row whose kernel reads and writes that many planes. The frame must hold the row's scene.
    [[nodiscard]] RivalEntry make(Rival rival, const BenchRow& row, int planes_in, int planes_out);

  private:
    [[nodiscard]] RivalEntry stream_opencl(int planes_in, int planes_out);
    [[nodiscard]] RivalEntry stream_cpp(int planes_in, int planes_out);
    [[nodiscard]] RivalEntry host_shading(Rival rival, int planes_out);
    [[nodiscard]] RivalEntry naive();
    [[nodiscard]] RivalEntry reference(const BenchScene& scene);
    HostRivals& host();

    Device* device_;
    Frame* frame_;
    std::shared_ptr<PictureMemory> memory_;
    int threads_;
    int lanes_;
    std::shared_ptr<HostRivals> host_; ///< made when first needed
};

} // namespace clshade
