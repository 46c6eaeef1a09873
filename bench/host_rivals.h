// The C++ rivals on the planes of a bench frame.
#pragma once

#include "bench/host_kernels.h"
#include "bench/simd/rivals.h"
#include "bench/worker_pool.h"
#include "host/base/plane_slab.h"
#include "host/gbuffer/frame.h"

#include <string_view>
#include <vector>

namespace clshade {

/// Lights of a frame as the C++ rivals take them. Throws std::invalid_argument if one is not distant.
[[nodiscard]] std::vector<rivals::DistantLight> distant_lights(const Frame& frame);

/// Runs the rivals with the widest instructions the processor has. Refers to the frame, whose planes must stay, and to
/// the planes to write, R, G, B and alpha; the lights are handed over so that the frame's own may change.
class HostRivals {
  public:
    /// threads: 0 stands for all processors. instruction_set: one of instruction_sets(), empty for the widest; throws
    /// std::invalid_argument for another.
    HostRivals(const Frame& frame, PlaneSlab& output, int threads, std::string_view instruction_set = {});

    // Each does its work once and returns its milliseconds. planes_out: 3, or 4 with alpha.
    double openmp_simd(const std::vector<rivals::DistantLight>& lights, int planes_out);
    double hand_simd(const std::vector<rivals::DistantLight>& lights, int planes_out);
    double stream(int planes_in, int planes_out);

    [[nodiscard]] int threads() const { return pool_.threads(); }
    [[nodiscard]] std::string_view instruction_set() const;

  private:
    [[nodiscard]] rivals::Planes planes(int planes_in, int planes_out);
    double shade(rivals::ShadeRange work, const std::vector<rivals::DistantLight>& lights, int planes_out);

    const Frame* frame_;
    const HostKernels* kernels_;
    PlaneSlab* output_;
    WorkerPool pool_;
};

} // namespace clshade
