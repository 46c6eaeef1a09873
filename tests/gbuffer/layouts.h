// Layouts as the image reader would report them, for tests without files.
#pragma once

#include "host/gbuffer/image_layout.h"
#include "host/gbuffer/roles.h"

#include <initializer_list>
#include <string>
#include <vector>

namespace clshade::testing {

/// "Normal.X Normal.Y" from ("Normal", "XY"), one letter per channel.
inline std::vector<std::string> layer(const std::string& name, const std::string& letters) {
    std::vector<std::string> names;
    for (const char letter : letters) {
        names.push_back(name.empty() ? std::string(1, letter) : name + "." + letter);
    }
    return names;
}

inline void add_channel(ImageLayout& layout, const std::string& name, SampleType type = SampleType::float32,
                        const std::string& view = "", int part = 0) {
    ChannelInfo info;
    info.name = name;
    info.file_name = name;
    info.type = type;
    info.view = view;
    info.part = part;
    layout.channels.push_back(info);
}

/// One part of 64 x 32 pixels with these channels.
inline ImageLayout layout_of(const std::vector<std::vector<std::string>>& layers) {
    ImageLayout layout;
    layout.file = "picture.exr";
    layout.display_window = {0, 0, 63, 31};
    PartInfo part;
    part.data_window = layout.display_window;
    part.compression = "zip";
    layout.parts.push_back(part);
    for (const std::vector<std::string>& names : layers) {
        for (const std::string& name : names) {
            add_channel(layout, name);
        }
    }
    return layout;
}

/// The channels of tests' Blender renders, from their headers: with AOVs (suzanne, room) or without (anim).
inline ImageLayout blender_layout(const std::string& view_layer = "ViewLayer", bool aovs = true) {
    const std::string v = view_layer + ".";
    std::vector<std::vector<std::string>> layers{
        layer(v + "Combined", "ABGR"), layer(v + "Depth", "Z"),      layer(v + "DiffCol", "BGR"),
        layer(v + "GlossCol", "BGR"),  layer(v + "IndexMA", "X"),    layer(v + "IndexOB", "X"),
        layer(v + "Normal", "XYZ"),    layer(v + "Position", "XYZ"), layer(v + "roughness", "X"),
    };
    if (aovs) {
        layers.insert(layers.end(), {layer(v + "CryptoMaterial00", "abgr"), layer(v + "Emit", "BGR"),
                                     layer(v + "Mist", "Z"), layer(v + "UV", "AUV"), layer(v + "basecolor", "ABGR"),
                                     layer(v + "f0", "ABGR"), layer(v + "metallic", "X")});
    }
    return layout_of(layers);
}

/// Full names of the channels a role took, in component order.
inline std::vector<std::string> names_of(const ImageLayout& layout, const std::vector<int>& channels) {
    std::vector<std::string> names;
    names.reserve(channels.size());
    for (const int channel : channels) {
        names.push_back(layout.channels[static_cast<std::size_t>(channel)].name);
    }
    return names;
}
inline std::vector<std::string> names_of(const ImageLayout& layout, const RoleAssignment& roles, Role role) {
    return names_of(layout, roles[role].channels);
}

/// [gbuffer] with one override.
inline GBufferSettings settings_with(const std::string& role, const std::vector<std::string>& channels) {
    GBufferSettings settings;
    settings.roles.push_back({role, channels, {"scene.toml", 12, 5}});
    return settings;
}

} // namespace clshade::testing
