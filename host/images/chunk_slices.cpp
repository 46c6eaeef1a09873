#include "host/images/chunk_slices.h"

#include "host/images/unpack.h"

#include <fmt/format.h>

#include <algorithm>

namespace clshade {

SampleType sample_type_of(exr_pixel_type_t type) {
    switch (type) {
    case EXR_PIXEL_HALF:
        return SampleType::half;
    case EXR_PIXEL_UINT:
        return SampleType::uint32;
    default:
        return SampleType::float32;
    }
}

ChunkSlices find_slices(const PartSource& source) {
    const ExrFile& file = *source.file;
    const exr_attr_chlist_t* channels = nullptr;
    exr_get_channels(file.context(), source.part, &channels);
    std::vector<bool> found(source.targets.size(), false);
    ChunkSlices result;
    for (int i = 0; i < channels->num_channels; ++i) {
        const exr_attr_chlist_entry_t& channel = channels->entries[i];
        const SampleType type = sample_type_of(channel.pixel_type);
        for (std::size_t target = 0; target < source.targets.size(); ++target) {
            if (!found[target] && source.targets[target].channel == channel.name.str) {
                result.slices.push_back(
                    {type, result.pixel_bytes, result.pxr24_pixel_bytes, source.targets[target].plane});
                found[target] = true;
            }
        }
        result.pixel_bytes += bytes_of(type);
        result.pxr24_pixel_bytes += pxr24_bytes_of(type);
    }
    const auto missing = std::find(found.begin(), found.end(), false);
    if (missing != found.end()) {
        file.fail(fmt::format("channel '{}' is gone; run again when the file's writer has finished",
                              source.targets[static_cast<std::size_t>(missing - found.begin())].channel));
    }
    return result;
}

std::size_t bytes_of_chunk(const ChunkGrid& grid, const ChunkSlices& layout) {
    return layout.pixel_bytes * static_cast<std::size_t>(grid.chunk_width) *
           static_cast<std::size_t>(grid.chunk_height);
}

void fail_chunk(const PartSource& source, std::size_t chunk, const std::string& why) {
    const std::string label = source.file->part_label(source.part);
    source.file->fail(fmt::format("{}pixels of chunk {} are damaged{}; render or copy the file again",
                                  label.empty() ? "" : label + ": ", chunk, why.empty() ? "" : " (" + why + ")"));
}

LineRange lines_in_band(const Window& chunk, const Band& band) {
    return {std::max(chunk.y_min, band.area.y_min) - chunk.y_min, std::min(chunk.y_max, band.area.y_max) - chunk.y_min};
}

} // namespace clshade
