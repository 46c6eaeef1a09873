// What a user types for a channel: unique names over all parts and views of a file.
#pragma once

#include "host/gbuffer/image_layout.h"

namespace clshade {

/// Fills `name` and `view` of every channel from file_name, the parts and the file's `multiView` list (layout.views as
/// read from it; completed here with the views of the parts), by the rules documented at ChannelInfo. Channels without
/// a name, and further ones of the same name in one part, are dropped. Oddities go to layout.warnings.
void name_channels(ImageLayout& layout);

} // namespace clshade
