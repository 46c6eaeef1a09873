#include "host/base/error.h"
#include "host/images/channel_names.h"
#include "host/images/chunk_grid.h"
#include "host/images/chunk_slices.h"
#include "host/images/exr_file.h"
#include "host/images/image_reader.h"
#include "host/images/manifest_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <set>

namespace clshade {

namespace {

Window window_of(const exr_attr_box2i_t& box) {
    return {box.min.x, box.min.y, box.max.x, box.max.y};
}

std::string text_of(const exr_attr_string_t& text) {
    return text.str == nullptr ? "" : std::string(text.str, static_cast<std::size_t>(std::max(text.length, 0)));
}

/// Matrices lie row by row in the file; element [row][column] of the result.
template <typename Number>
glm::dmat4 matrix_of(const Number* values) {
    glm::dmat4 matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            matrix[row][column] = static_cast<double>(values[4 * row + column]);
        }
    }
    return matrix;
}

/// Rec.709 primaries and D65, what an EXR without the attribute means.
constexpr std::array<float, 8> rec709{0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
/// Writers round the primaries to three digits.
constexpr float primaries_tolerance = 1e-3F;

void add_chromaticities(const exr_attr_chromaticities_t& c, ImageLayout& layout) {
    const std::array<float, 8> values{c.red_x, c.red_y, c.green_x, c.green_y, c.blue_x, c.blue_y, c.white_x, c.white_y};
    const bool same = std::equal(values.begin(), values.end(), rec709.begin(),
                                 [](float a, float b) { return std::fabs(a - b) <= primaries_tolerance; });
    if (!same) {
        layout.strings.emplace("chromaticities", fmt::format("{:g}", fmt::join(values, " ")));
    }
}

/// Takes what camera and colour decisions may need. A name already known (from an earlier part) stays.
void add_attribute(const exr_attribute_t& attribute, ImageLayout& layout) {
    const std::string name = attribute.name == nullptr ? "" : attribute.name;
    switch (attribute.type) {
    case EXR_ATTR_M44F:
        layout.matrices.emplace(name, matrix_of(attribute.m44f->m));
        break;
    case EXR_ATTR_M44D:
        layout.matrices.emplace(name, matrix_of(attribute.m44d->m));
        break;
    case EXR_ATTR_FLOAT:
        layout.numbers.emplace(name, static_cast<double>(attribute.f));
        break;
    case EXR_ATTR_DOUBLE:
        layout.numbers.emplace(name, attribute.d);
        break;
    case EXR_ATTR_INT:
        layout.numbers.emplace(name, attribute.i);
        break;
    case EXR_ATTR_STRING:
        layout.strings.emplace(name, text_of(*attribute.string));
        break;
    case EXR_ATTR_CHROMATICITIES:
        add_chromaticities(*attribute.chromaticities, layout);
        break;
    default:
        break;
    }
}

void add_views(const exr_attribute_t& attribute, ImageLayout& layout) {
    if (attribute.type != EXR_ATTR_STRING_VECTOR) {
        layout.warnings.push_back(
            fmt::format("attribute 'multiView' has type {} instead of stringvector; ignored", attribute.type_name));
        return;
    }
    for (int i = 0; i < attribute.stringvector->n_strings; ++i) {
        std::string view = text_of(attribute.stringvector->strings[i]);
        if (!view.empty() && std::find(layout.views.begin(), layout.views.end(), view) == layout.views.end()) {
            layout.views.push_back(std::move(view));
        }
    }
}

void add_attributes(const ExrFile& file, int index, PartInfo& part, ImageLayout& layout) {
    // Of the part, not of the image; said in PartInfo.
    static const std::set<std::string> structural{"name", "type", "view", "version", "chunkCount"};
    std::int32_t count = 0;
    exr_get_attribute_count(file.context(), index, &count);
    for (std::int32_t i = 0; i < count; ++i) {
        const exr_attribute_t* attribute = nullptr;
        if (exr_get_attribute_by_index(file.context(), index, EXR_ATTR_LIST_FILE_ORDER, i, &attribute) !=
                EXR_ERR_SUCCESS ||
            attribute == nullptr) {
            continue;
        }
        const std::string name = attribute->name == nullptr ? "" : attribute->name;
        if (name == "multiView") {
            add_views(*attribute, layout);
        } else if (name == "view") {
            if (attribute->type == EXR_ATTR_STRING) {
                part.view = text_of(*attribute->string);
            } else {
                layout.warnings.push_back(
                    fmt::format("attribute 'view' has type {} instead of string; ignored", attribute->type_name));
            }
        } else if (name == "name" && attribute->type == EXR_ATTR_STRING) {
            if (file.part_count() > 1) {
                part.name = text_of(*attribute->string);
            }
        } else if (structural.count(name) == 0) {
            add_attribute(*attribute, layout);
        }
    }
}

PartInfo read_part(const ExrFile& file, int index, ImageLayout& layout) {
    check_part(file, index);
    check_chunks(file, index);

    PartInfo part;
    exr_attr_box2i_t window{};
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    const exr_attr_chlist_t* channels = nullptr;
    exr_get_data_window(file.context(), index, &window);
    exr_get_compression(file.context(), index, &compression);
    exr_get_storage(file.context(), index, &storage);
    exr_get_channels(file.context(), index, &channels);
    part.data_window = window_of(window);
    part.compression = compression_name(compression);
    part.tiled = storage == EXR_STORAGE_TILED;
    add_attributes(file, index, part, layout);
    for (int i = 0; i < channels->num_channels; ++i) {
        ChannelInfo channel;
        channel.file_name = text_of(channels->entries[i].name);
        channel.part = index;
        channel.type = sample_type_of(channels->entries[i].pixel_type);
        layout.channels.push_back(std::move(channel));
    }
    return part;
}

ImageLayout layout_of(const ExrFile& file) {
    ImageLayout layout;
    layout.file = file.name();
    exr_attr_box2i_t window{};
    float aspect = 1.0F;
    exr_get_display_window(file.context(), 0, &window);
    exr_get_pixel_aspect_ratio(file.context(), 0, &aspect);
    layout.display_window = window_of(window);
    layout.pixel_aspect = static_cast<double>(aspect);
    for (int index = 0; index < file.part_count(); ++index) {
        layout.parts.push_back(read_part(file, index, layout));
        exr_attr_box2i_t other{};
        exr_get_display_window(file.context(), index, &other);
        if (window_of(other) != layout.display_window) {
            layout.warnings.push_back(fmt::format(
                "{} has another display window than the first part; the first is used", file.part_label(index)));
        }
    }
    name_channels(layout);
    if (layout.channels.empty()) {
        file.fail("holds no channel with a name; give another file");
    }
    return layout;
}

} // namespace

ImageLayout read_layout(const std::filesystem::path& file) {
    try {
        ImageLayout layout = layout_of(ExrFile(file));
        read_manifest_files(file, layout);
        return layout;
    } catch (const std::bad_alloc&) {
        throw RuntimeFailure(fmt::format("{}: not enough memory to read the header; free memory", file.string()));
    }
}

} // namespace clshade
