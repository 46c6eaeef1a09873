#include "host/images/channel_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace clshade {

namespace {

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

bool has_layer(std::string_view name) {
    return name.find('.') != std::string_view::npos;
}

/// The next-to-last component of a dotted name, where OpenEXR's multi-view convention puts the view; else "".
std::string_view view_component(std::string_view name) {
    const std::size_t last = name.rfind('.');
    if (last == std::string_view::npos || last == 0) {
        return {};
    }
    const std::size_t before = name.rfind('.', last - 1);
    return before == std::string_view::npos ? name.substr(0, last) : name.substr(before + 1, last - before - 1);
}

/// "ViewLayer.Depth.left.Z" -> "ViewLayer.Depth.Z"; "left.R" -> "R".
std::string without_view(std::string_view name) {
    const std::string_view view = view_component(name);
    const std::size_t last = name.rfind('.');
    return std::string(name.substr(0, last - view.size())) + std::string(name.substr(last + 1));
}

/// "ViewLayer.Depth.Z", "left" -> "ViewLayer.Depth.left.Z".
std::string with_view(std::string_view name, std::string_view view) {
    const std::size_t last = name.rfind('.');
    return last == std::string_view::npos ? fmt::format("{}.{}", view, name)
                                          : fmt::format("{}.{}.{}", name.substr(0, last), view, name.substr(last + 1));
}

/// The layer a part's name stands for: Nuke appends the view ("character.main").
std::string layer_of(const PartInfo& part) {
    const std::string tail = "." + part.view;
    if (!part.view.empty() && part.name.size() > tail.size() && part.name.ends_with(tail)) {
        return part.name.substr(0, part.name.size() - tail.size());
    }
    return part.name;
}

bool is_main_layer(std::string_view layer) {
    const std::string name = lower(layer);
    return name.empty() || name == "rgba" || name == "rgb";
}

/// Letters that belong together: one image may be spread over parts that hold one letter each.
std::string_view family_of(char letter) {
    for (const std::string_view family : {"rgba", "xyz", "uv"}) {
        if (family.find(letter) != std::string_view::npos) {
            return family;
        }
    }
    return {};
}

/// A channel on its way to a name.
struct Candidate {
    ChannelInfo* channel = nullptr;
    std::string base; ///< name inside the part, without its view
};

/// What the bare (undotted) channels of one part look like.
struct BareChannels {
    std::set<char> letters; ///< single-letter names, lower case
    [[nodiscard]] bool holds(std::string_view set) const {
        return std::all_of(set.begin(), set.end(), [&](char letter) { return letters.count(letter) > 0; });
    }
    [[nodiscard]] bool is_whole() const { return holds("rgb") || holds("xyz") || holds("uv"); }
};

/// Does the part's name have to tell what this bare channel is?
bool needs_layer(const Candidate& candidate, const std::string& layer, const std::vector<BareChannels>& parts) {
    if (is_main_layer(layer) || candidate.base == layer) {
        return false; // "rgba": the picture itself; Arnold: channel "id" in part "id"
    }
    if (candidate.base.size() > 1) {
        return true; // Nuke: "mask" in part "other"
    }
    const auto part = static_cast<std::size_t>(candidate.channel->part);
    if (parts[part].is_whole()) {
        return true; // Karma: X, Y, Z in part "N"
    }
    // One image spread over parts (R here, G there) keeps its names.
    const auto letter = static_cast<char>(std::tolower(static_cast<unsigned char>(candidate.base[0])));
    const std::string_view family = family_of(letter);
    for (std::size_t other = 0; other < parts.size(); ++other) {
        if (other == part || parts[other].is_whole()) {
            continue;
        }
        for (const char sibling : parts[other].letters) {
            if (sibling != letter && family.find(sibling) != std::string_view::npos) {
                return false;
            }
        }
    }
    return true;
}

void drop_unusable(ImageLayout& layout) {
    std::set<std::pair<int, std::string>> seen;
    std::vector<ChannelInfo> kept;
    for (ChannelInfo& channel : layout.channels) {
        if (channel.file_name.empty()) {
            layout.warnings.push_back("a channel without a name is left out");
        } else if (!seen.insert({channel.part, channel.file_name}).second) {
            layout.warnings.push_back(
                fmt::format("channel '{}' stands twice in the header; the first is used", channel.file_name));
        } else {
            kept.push_back(std::move(channel));
        }
    }
    layout.channels = std::move(kept);
}

/// Sets the views and returns each channel with its name free of the view.
std::vector<Candidate> split_views(ImageLayout& layout) {
    for (const PartInfo& part : layout.parts) {
        if (!part.view.empty() &&
            std::find(layout.views.begin(), layout.views.end(), part.view) == layout.views.end()) {
            layout.views.push_back(part.view);
        }
    }
    std::set<std::string> in_named_views; // names without the view of channels that state one
    std::vector<Candidate> candidates;
    for (ChannelInfo& channel : layout.channels) {
        Candidate candidate{&channel, channel.file_name};
        const std::string_view component = view_component(channel.file_name);
        const bool names_view =
            !component.empty() && std::find(layout.views.begin(), layout.views.end(), component) != layout.views.end();
        channel.view = layout.parts[static_cast<std::size_t>(channel.part)].view;
        if (names_view && (channel.view.empty() || channel.view == component)) {
            channel.view = component;
            candidate.base = without_view(channel.file_name);
            in_named_views.insert(candidate.base);
        }
        candidates.push_back(std::move(candidate));
    }
    if (layout.views.empty()) {
        return candidates;
    }
    // By convention the first view is the default, whose channels name no view. A layer without a view that no other
    // view has belongs to all of them.
    for (Candidate& candidate : candidates) {
        if (candidate.channel->view.empty() &&
            (!has_layer(candidate.base) || in_named_views.count(candidate.base) > 0)) {
            candidate.channel->view = layout.views.front();
        }
    }
    return candidates;
}

/// Prefixes the part's layer where it is needed, or where two parts of one view claim the same name.
void add_layers(ImageLayout& layout, std::vector<Candidate>& candidates) {
    std::vector<BareChannels> bare(layout.parts.size());
    for (const Candidate& candidate : candidates) {
        if (candidate.base.size() == 1) {
            bare[static_cast<std::size_t>(candidate.channel->part)].letters.insert(
                static_cast<char>(std::tolower(static_cast<unsigned char>(candidate.base[0]))));
        }
    }
    std::map<std::pair<std::string, std::string>, std::set<int>> claims; // (view, name) -> parts
    for (const Candidate& candidate : candidates) {
        claims[{candidate.channel->view, candidate.base}].insert(candidate.channel->part);
    }
    std::set<int> colliding;
    std::set<std::string> shared_names;
    for (const auto& [key, parts] : claims) {
        if (parts.size() > 1) {
            colliding.insert(parts.begin(), parts.end());
            shared_names.insert(key.second);
        }
    }
    if (!shared_names.empty()) {
        layout.warnings.push_back(
            fmt::format("several parts hold channels of the same name ({}); told apart by the parts' names",
                        fmt::join(shared_names, ", ")));
    }
    for (Candidate& candidate : candidates) {
        const std::string layer = layer_of(layout.parts[static_cast<std::size_t>(candidate.channel->part)]);
        if (layer.empty() || candidate.base.starts_with(layer + ".")) {
            continue;
        }
        const bool shared = claims[{candidate.channel->view, candidate.base}].size() > 1;
        const bool bare_in_colliding_part =
            !has_layer(candidate.base) && colliding.count(candidate.channel->part) > 0 && candidate.base != layer;
        const bool main_picture = is_main_layer(layer) && !has_layer(candidate.base);
        if (!main_picture &&
            (shared || bare_in_colliding_part || (!has_layer(candidate.base) && needs_layer(candidate, layer, bare)))) {
            candidate.base = fmt::format("{}.{}", layer, candidate.base);
        }
    }
}

} // namespace

void name_channels(ImageLayout& layout) {
    drop_unusable(layout);
    std::vector<Candidate> candidates = split_views(layout);
    if (layout.views.size() == 1) { // nothing to choose from
        layout.views.clear();
        for (ChannelInfo& channel : layout.channels) {
            channel.view.clear();
        }
    }
    if (layout.parts.size() > 1) {
        add_layers(layout, candidates);
    }
    // The default view takes the plain names, then the others, who keep their view where the plain name is gone.
    std::set<std::string> taken;
    const auto settle = [&](const Candidate& candidate) {
        ChannelInfo& channel = *candidate.channel;
        channel.name = candidate.base;
        if (taken.count(channel.name) > 0 && !channel.view.empty()) {
            channel.name = with_view(candidate.base, channel.view);
        }
        if (taken.count(channel.name) > 0) { // equally named parts, or the main picture twice
            channel.name = fmt::format("part{}.{}", channel.part, channel.name);
        }
        for (int again = 2; taken.count(channel.name) > 0; ++again) {
            channel.name = fmt::format("part{}.{}#{}", channel.part, candidate.base, again);
        }
        taken.insert(channel.name);
    };
    const std::string first_view = layout.views.empty() ? "" : layout.views.front();
    for (const bool other_views : {false, true}) {
        for (const Candidate& candidate : candidates) {
            const std::string& view = candidate.channel->view;
            if ((!view.empty() && view != first_view) == other_views) {
                settle(candidate);
            }
        }
    }
}

} // namespace clshade
