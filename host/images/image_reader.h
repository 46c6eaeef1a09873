// Image files in: headers into ImageLayout, needed channels straight into planes. The only place that knows formats.
#pragma once

#include "host/gbuffer/frame_builder.h"
#include "host/gbuffer/image_layout.h"

#include <filesystem>

namespace clshade {

/// Reads the header of an EXR file, and the Cryptomatte manifests beside it that it names. Costs no memory in
/// proportion to what the header claims. Throws RuntimeFailure: missing, empty, not an EXR, truncated, deep, subsampled
/// chroma, claims more than it holds.
[[nodiscard]] ImageLayout read_layout(const std::filesystem::path& file);

/// Decodes plan.channels into plan.frame.planes (half and uint widened to float), nothing else. threads >= 1.
/// Throws RuntimeFailure naming the file, part and channel when the pixel data is broken or incomplete.
void read_planes(const std::filesystem::path& file, const ImageLayout& layout, FramePlan& plan, int threads);

} // namespace clshade
