#include "host/gbuffer/find_named.h"

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/gbuffer/roles.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

namespace clshade {

namespace {

using Home = std::optional<std::string>;

/// Index of the visible channel with this full name.
std::optional<int> exact_channel(const ImageLayout& layout, const std::vector<ChannelLayer>& layers,
                                 std::string_view name) {
    for (const ChannelLayer& layer : layers) {
        for (const LayerComponent& c : layer.components) {
            if (layout.channels[static_cast<std::size_t>(c.channel)].name == name) {
                return c.channel;
            }
        }
    }
    return std::nullopt;
}

/// Layers of this name: exact ones, else those that have it behind a view layer.
std::vector<const ChannelLayer*> layers_named(const std::vector<ChannelLayer>& layers, std::string_view name,
                                              const Home& home) {
    std::vector<const ChannelLayer*> exact;
    std::vector<const ChannelLayer*> relative;
    std::vector<const ChannelLayer*> at_home;
    for (const ChannelLayer& layer : layers) {
        if (layer.name.empty()) {
            continue;
        }
        if (layer.name == name || layer.raw_name == name) {
            exact.push_back(&layer);
        } else if (const auto prefix = prefix_before(layer.name, name, false)) {
            relative.push_back(&layer);
            if (home && *prefix == *home) {
                at_home.push_back(&layer);
            }
        }
    }
    if (!exact.empty()) {
        return exact;
    }
    return at_home.empty() ? relative : at_home;
}

/// Channels whose name without a view layer is `name`.
std::vector<int> relative_channels(const std::vector<ChannelLayer>& layers, std::string_view name, const Home& home) {
    std::vector<int> all;
    std::vector<int> at_home;
    for (const ChannelLayer& layer : layers) {
        for (const LayerComponent& c : layer.components) {
            const std::string full = c.suffix.empty() ? layer.name : fmt::format("{}.{}", layer.name, c.suffix);
            const auto prefix = prefix_before(full, name, false);
            if (layer.name.empty() || !prefix) {
                continue;
            }
            all.push_back(c.channel);
            if (home && *prefix == *home) {
                at_home.push_back(c.channel);
            }
        }
    }
    return at_home.empty() ? all : at_home;
}

std::vector<int> channels_of(const ChannelLayer& layer, Shape shape) {
    const auto single = single_component(layer);
    if (shape == Shape::scalar) {
        return single ? std::vector{*single} : std::vector<int>();
    }
    std::vector<int> three = three_components(layer, shape != Shape::vector);
    if (three.empty() && shape != Shape::vector && single) {
        three = {*single};
    }
    return three;
}

std::string_view wanted_text(Shape shape) {
    switch (shape) {
    case Shape::scalar:
        return "one channel is needed";
    case Shape::vector:
        return "three channels (X, Y, Z or R, G, B) are needed";
    case Shape::colour:
    case Shape::parameter:
        return "one channel or three (R, G, B or X, Y, Z) are needed";
    }
    return "";
}

std::vector<std::string> component_names(const ImageLayout& layout, const ChannelLayer& layer) {
    std::vector<std::string> names;
    for (const LayerComponent& c : layer.components) {
        names.push_back(layout.channels[static_cast<std::size_t>(c.channel)].name);
    }
    return names;
}

[[noreturn]] void throw_unknown(const ImageLayout& layout, const std::vector<ChannelLayer>& layers,
                                std::string_view name, std::string_view what) {
    std::vector<std::string> candidates = layer_names(layers);
    const std::size_t full = candidates.size();
    for (std::size_t i = 0; i < full; ++i) {
        const std::size_t dot = candidates[i].rfind('.');
        if (dot != std::string::npos) {
            candidates.push_back(candidates[i].substr(dot + 1));
        }
    }
    for (const ChannelLayer& layer : layers) {
        const std::vector<std::string> names = component_names(layout, layer);
        candidates.insert(candidates.end(), names.begin(), names.end());
    }
    std::string hint = did_you_mean(name, std::span<const std::string>(candidates));
    if (hint.empty()) {
        candidates.resize(full);
        hint = candidates.empty() ? "; the file has no channels" : fmt::format("; it has {}", list_names(candidates));
    }
    throw UsageError(fmt::format("{}: {} has no layer or channel '{}'{}", what, layout.file, name, hint));
}

NamedChannels find_one(const ImageLayout& layout, const std::vector<ChannelLayer>& layers, const std::string& name,
                       Shape shape, const Home& home, std::string_view what) {
    const auto exact = exact_channel(layout, layers, name);
    if (exact && shape != Shape::vector) {
        return {{*exact}, name};
    }
    const ChannelLayer* misfit = nullptr;
    std::vector<NamedChannels> fits;
    for (const ChannelLayer* layer : layers_named(layers, name, home)) {
        std::vector<int> channels = channels_of(*layer, shape);
        if (channels.empty()) {
            misfit = layer;
        } else {
            fits.push_back({std::move(channels), layer->name});
        }
    }
    if (fits.empty() && misfit == nullptr && shape != Shape::vector) {
        for (const int channel : relative_channels(layers, name, home)) {
            fits.push_back({{channel}, layout.channels[static_cast<std::size_t>(channel)].name});
        }
    }
    if (fits.size() > 1) {
        std::vector<std::string> names;
        names.reserve(fits.size());
        for (const NamedChannels& fit : fits) {
            names.push_back(fit.name);
        }
        throw UsageError(fmt::format("{}: '{}' may be {}; write the full name", what, name, list_names(names)));
    }
    if (fits.size() == 1) {
        return std::move(fits.front());
    }
    if (misfit != nullptr) {
        throw UsageError(fmt::format("{}: layer '{}' of {} holds {}; {}", what, name, layout.file,
                                     list_names(component_names(layout, *misfit)), wanted_text(shape)));
    }
    if (exact) {
        throw UsageError(fmt::format("{}: '{}' is a single channel; {}", what, name, wanted_text(shape)));
    }
    throw_unknown(layout, layers, name, what);
}

} // namespace

std::string located(const SourceLocation& where, std::string_view what) {
    if (where.file.empty()) {
        return std::string(what);
    }
    return where.line > 0 ? fmt::format("{}:{}:{}: {}", where.file, where.line, where.column, what)
                          : fmt::format("{}: {}", where.file, what);
}

Home home_of(const std::vector<ChannelLayer>& layers, const std::vector<int>& channels) {
    for (const ChannelLayer& layer : layers) {
        for (const LayerComponent& c : layer.components) {
            if (!channels.empty() && c.channel == channels.front()) {
                const std::size_t dot = layer.name.rfind('.');
                return dot == std::string::npos ? std::string() : layer.name.substr(0, dot);
            }
        }
    }
    return std::nullopt;
}

NamedChannels find_named(const ImageLayout& layout, const std::vector<ChannelLayer>& layers,
                         const std::vector<std::string>& names, Shape shape, const std::optional<std::string>& home,
                         std::string_view what) {
    if (names.size() == 1) {
        return find_one(layout, layers, names.front(), shape, home, what);
    }
    if (names.size() != 3 || shape == Shape::scalar) {
        throw UsageError(fmt::format("{}: {} channels are named; {}", what, names.size(), wanted_text(shape)));
    }
    NamedChannels result;
    for (const std::string& name : names) {
        const NamedChannels one = find_one(layout, layers, name, Shape::scalar, home, what);
        result.channels.push_back(one.channels.front());
        result.name += result.name.empty() ? one.name : ", " + one.name;
    }
    return result;
}

std::vector<int> find_kept(const ImageLayout& layout, const std::vector<ChannelLayer>& layers,
                           const std::string& name) {
    std::vector<int> channels;
    const std::vector<const ChannelLayer*> named = layers_named(layers, name, std::nullopt);
    for (const ChannelLayer* layer : named) {
        for (const LayerComponent& c : layer->components) {
            channels.push_back(c.channel);
        }
    }
    if (channels.empty()) {
        if (const auto exact = exact_channel(layout, layers, name)) {
            return {*exact};
        }
        throw_unknown(layout, layers, name, "--keep");
    }
    return channels;
}

std::vector<int> find_channels(const ImageLayout& layout, const RoleAssignment& roles, const Parameter& parameter,
                               std::string_view what) {
    const std::string place = located(parameter.where, what);
    if (parameter.channels.empty()) {
        throw UsageError(fmt::format("{}: names no channel", place));
    }
    const std::vector<ChannelLayer> layers = visible_layers(layout, roles.view);
    const Home home = home_of(layers, roles[Role::normal].channels);
    if (parameter.channels.size() == 1) {
        if (const auto role = role_from_name(parameter.channels.front())) {
            const RoleChoice& choice = roles[*role];
            if (!choice.channels.empty()) {
                return choice.channels;
            }
            if (!choice.ambiguous.empty()) {
                throw UsageError(fmt::format("{}: role '{}' of {} may be {}; say which in [gbuffer]", place,
                                             name_of(*role), layout.file, list_names(choice.ambiguous)));
            }
            if (layers_named(layers, parameter.channels.front(), home).empty()) {
                throw UsageError(fmt::format("{}: role '{}' of {} is empty ({}); map it in [gbuffer] or give a number",
                                             place, name_of(*role), layout.file, choice.rule));
            }
        }
    }
    return find_named(layout, layers, parameter.channels, Shape::parameter, home, place).channels;
}

} // namespace clshade
