// Which frames need not be shaded again (-u, --no-clobber).
#pragma once

#include "host/batch/batch.h"

#include <string>

namespace clshade {

/// Identity of what is done with a frame, beside its G-buffer: scene, environment's name, outputs, pixel type and
/// compression. Stands in the output (completion.h: job_attribute).
[[nodiscard]] std::string job_identity(const RunScene& scene, const BatchSettings& settings);

/// Why the frame need not be shaded; empty: it must be. With update_only, an output is good if it is complete and
/// undamaged, of the same job, and newer than the G-buffer, the scene with its tables, cameras and environment, and the
/// program. Never throws for what it finds in the way.
[[nodiscard]] std::string reason_to_skip(const FrameJob& job, const RunScene& scene, const BatchSettings& settings,
                                         const std::string& identity);

} // namespace clshade
