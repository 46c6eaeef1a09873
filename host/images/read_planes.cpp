#include "host/base/error.h"
#include "host/images/image_reader.h"
#include "host/images/part_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace clshade {

namespace {

/// The file may have been written anew since its header was read.
void check_unchanged(const ExrFile& file, const ImageLayout& layout, int part) {
    const PartInfo& known = layout.parts.at(static_cast<std::size_t>(part));
    exr_attr_box2i_t window{};
    const exr_attr_chlist_t* channels = nullptr;
    exr_get_data_window(file.context(), part, &window);
    exr_get_channels(file.context(), part, &channels);
    const Window now{window.min.x, window.min.y, window.max.x, window.max.y};
    bool same = now == known.data_window;
    for (const ChannelInfo& channel : layout.channels) {
        if (channel.part != part) {
            continue;
        }
        const auto* end = channels->entries + channels->num_channels;
        same = same && std::any_of(channels->entries, end, [&](const exr_attr_chlist_entry_t& entry) {
                   return channel.file_name == entry.name.str;
               });
    }
    if (!same) {
        file.fail("changed while it was being read; run again when its writer has finished");
    }
}

bool contains(const Window& outer, const Window& inner) {
    return outer.x_min <= inner.x_min && outer.y_min <= inner.y_min && outer.x_max >= inner.x_max &&
           outer.y_max >= inner.y_max;
}

} // namespace

void read_planes(const std::filesystem::path& path, const ImageLayout& layout, FramePlan& plan, int threads) {
    Frame& frame = plan.frame;
    const PlaneGeometry geometry{frame.data_window, frame.planes.pitch()};
    if (frame.planes.count() < static_cast<int>(plan.channels.size()) ||
        frame.planes.width() < frame.data_window.width() || frame.planes.height() < frame.data_window.height()) {
        throw RuntimeFailure(fmt::format("{}: internal: the planes do not fit the plan", path.string()));
    }
    std::map<int, std::vector<PlaneTarget>> targets; // by part
    for (std::size_t i = 0; i < plan.channels.size(); ++i) {
        const ChannelInfo& channel = layout.channels.at(static_cast<std::size_t>(plan.channels[i]));
        targets[channel.part].push_back({channel.file_name, frame.planes.plane(static_cast<int>(i)).data()});
    }

    const ExrFile file(path);
    if (file.part_count() != static_cast<int>(layout.parts.size())) {
        file.fail("changed while it was being read; run again when its writer has finished");
    }
    for (const auto& [part, wanted] : targets) {
        check_part(file, part);
        check_unchanged(file, layout, part);
        if (!contains(frame.data_window, layout.parts[static_cast<std::size_t>(part)].data_window)) {
            file.fail(fmt::format("internal: {} sticks out of the frame", file.part_label(part)));
        }
        exr_compression_t compression = EXR_COMPRESSION_NONE;
        exr_get_compression(file.context(), part, &compression);
        if (has_own_decoder(compression)) {
            decode_chunks(file, part, wanted, geometry, std::max(threads, 1));
        } else {
            static_cast<void>(full_resolution_chunks(file, part)); // the library is handed nothing implausible
            decode_with_library(file, part, wanted, geometry, std::max(threads, 1));
        }
    }
}

} // namespace clshade
