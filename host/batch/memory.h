// How much memory there is, and how much a frame takes.
#pragma once

#include "host/batch/frame_input.h"

#include <cstdint>

namespace clshade {

/// Memory of this process that is resident now, in bytes; 0 where the system does not tell.
[[nodiscard]] std::uint64_t resident_memory();

/// What the machine, or the control group of a farm's job, has in all, in bytes; a large number if neither tells.
[[nodiscard]] std::uint64_t machine_memory();

/// What `rows` rows of a frame take while they are under way: planes read, planes written, and the latter once more as
/// the encoder packs them.
[[nodiscard]] std::uint64_t band_memory(int width, int planes_read, int planes_written, int rows);
/// The same for a whole frame with `outputs` planes beside those passed through.
[[nodiscard]] std::uint64_t frame_memory(const FramePlan& plan, int outputs);

} // namespace clshade
