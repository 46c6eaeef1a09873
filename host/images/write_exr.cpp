#include "host/base/error.h"
#include "host/images/image_writer.h"

#include <fmt/format.h>

namespace clshade {

WrittenFile write_exr(const std::filesystem::path& file, const OutputImage& image, const ExrSettings& settings,
                      Replace replace) {
    ExrWriter writer(file, image, settings, replace);
    for (const OutputChannel& channel : image.channels) {
        if (channel.slab == nullptr || channel.slab->height() != image.data_window.height()) {
            throw RuntimeFailure(
                fmt::format("{}: internal: channel '{}' has not the size of the image", file.string(), channel.name));
        }
    }
    writer.write(image.channels, 0, image.data_window.height());
    return writer.commit();
}

} // namespace clshade
