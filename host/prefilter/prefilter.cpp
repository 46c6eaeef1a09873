#include "host/prefilter/prefilter.h"

#include <utility>

namespace clshade {

Prefilter::Prefilter(Device& device, SourceSet kernels, ProgramCache cache, int lanes)
    : device_(&device), kernels_(std::move(kernels)), cache_(std::move(cache)), lanes_(lanes) {}

} // namespace clshade
