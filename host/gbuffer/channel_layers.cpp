#include "host/gbuffer/channel_layers.h"

#include "host/base/error.h"
#include "host/base/suggest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace clshade {

namespace {

char lower(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Every suffix names a component by one letter; the long ones are Nuke's.
constexpr std::array<std::string_view, 9> letters{"X", "Y", "Z", "R", "G", "B", "A", "U", "V"};
constexpr std::array<std::string_view, 2> mitsuba_letters{"T", "I"};
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> long_names{
    {{"red", "R"}, {"green", "G"}, {"blue", "B"}, {"alpha", "A"}}};

std::string_view letter_of(std::string_view suffix) {
    for (const auto& [word, letter] : long_names) {
        if (equal_without_case(suffix, word)) {
            return letter;
        }
    }
    return suffix;
}

/// A stereo view stands behind the layer ("ViewLayer.Depth.left"), before it, or alone.
std::string without_view(const std::string& layer, const std::string& view) {
    if (view.empty()) {
        return layer;
    }
    if (layer == view) {
        return {};
    }
    if (const auto rest = prefix_before(layer, view, false)) {
        return std::string(*rest);
    }
    if (layer.size() > view.size() && layer.starts_with(view) && layer[view.size()] == '.') {
        return layer.substr(view.size() + 1);
    }
    return layer;
}

/// Finds or makes layers by raw name, so that headers with thousands of channels stay cheap.
class LayerTable {
  public:
    ChannelLayer& at(const std::string& raw_name, const std::string& view, bool plain) {
        const auto [place, added] = index_.try_emplace({raw_name, plain, !view.empty()}, layers_.size());
        if (added) {
            ChannelLayer layer;
            layer.raw_name = raw_name;
            layer.name = without_view(raw_name, view);
            layer.plain = plain;
            layer.of_view = !view.empty();
            layers_.push_back(std::move(layer));
        }
        return layers_[place->second];
    }
    [[nodiscard]] std::vector<ChannelLayer> take() { return std::move(layers_); }

  private:
    std::map<std::tuple<std::string, bool, bool>, std::size_t> index_;
    std::vector<ChannelLayer> layers_;
};

} // namespace

bool equal_without_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

bool is_component_suffix(std::string_view suffix) {
    const std::string_view letter = letter_of(suffix);
    const auto same = [&](std::string_view known) { return equal_without_case(letter, known); };
    return std::any_of(letters.begin(), letters.end(), same) ||
           std::any_of(mitsuba_letters.begin(), mitsuba_letters.end(), same);
}

std::optional<std::string_view> prefix_before(std::string_view name, std::string_view tail, bool any_case) {
    if (name.size() < tail.size()) {
        return std::nullopt;
    }
    const std::string_view end = name.substr(name.size() - tail.size());
    if (any_case ? !equal_without_case(end, tail) : end != tail) {
        return std::nullopt;
    }
    if (name.size() == tail.size()) {
        return std::string_view();
    }
    const std::size_t dot = name.size() - tail.size() - 1;
    if (name[dot] != '.' || tail.empty()) {
        return std::nullopt;
    }
    return name.substr(0, dot);
}

std::string choose_view(const ImageLayout& layout, const std::string& wanted) {
    if (wanted.empty()) {
        return layout.views.empty() ? std::string() : layout.views.front();
    }
    if (std::find(layout.views.begin(), layout.views.end(), wanted) != layout.views.end()) {
        return wanted;
    }
    if (layout.views.empty()) {
        throw UsageError(fmt::format("{}: there is no view '{}', the file has a single view; leave out --view",
                                     layout.file, wanted));
    }
    throw UsageError(fmt::format("{}: there is no view '{}'; the file has {}{}", layout.file, wanted,
                                 fmt::join(layout.views, ", "),
                                 did_you_mean(wanted, std::span<const std::string>(layout.views))));
}

std::vector<ChannelLayer> visible_layers(const ImageLayout& layout, const std::string& view) {
    LayerTable table;
    for (std::size_t i = 0; i < layout.channels.size(); ++i) {
        const ChannelInfo& info = layout.channels[i];
        if (!info.view.empty() && info.view != view) {
            continue;
        }
        const int channel = static_cast<int>(i);
        const std::size_t dot = info.name.rfind('.');
        const bool bare = dot == std::string::npos;
        const std::string last = bare ? info.name : info.name.substr(dot + 1);
        const bool suffixed = is_component_suffix(last);
        if (suffixed) {
            table.at(bare ? std::string() : info.name.substr(0, dot), info.view, false)
                .components.push_back({last, channel});
        }
        // A bare letter may be a plane of its own: Arnold's Z, RenderMan's z.
        if (!suffixed || bare) {
            table.at(info.name, info.view, true).components.push_back({"", channel});
        }
    }
    std::vector<ChannelLayer> layers = table.take();
    // X, Y and Z without a layer are a vector, not three planes.
    const auto bare = std::find_if(layers.begin(), layers.end(),
                                   [](const ChannelLayer& layer) { return layer.raw_name.empty() && !layer.plain; });
    if (bare != layers.end() && component(*bare, "X") && component(*bare, "Y")) {
        std::erase_if(layers,
                      [](const ChannelLayer& layer) { return layer.plain && equal_without_case(layer.name, "Z"); });
    }
    return layers;
}

std::optional<int> component(const ChannelLayer& layer, std::string_view suffix) {
    for (const LayerComponent& c : layer.components) {
        if (c.suffix == suffix) {
            return c.channel;
        }
    }
    for (const LayerComponent& c : layer.components) {
        if (!c.suffix.empty() && equal_without_case(letter_of(c.suffix), suffix)) {
            return c.channel;
        }
    }
    return std::nullopt;
}

std::vector<int> three_components(const ChannelLayer& layer, bool colour) {
    using Triple = std::array<std::string_view, 3>;
    const Triple rgb{"R", "G", "B"};
    const Triple xyz{"X", "Y", "Z"};
    for (const Triple& triple : colour ? std::array{rgb, xyz} : std::array{xyz, rgb}) {
        const auto a = component(layer, triple[0]);
        const auto b = component(layer, triple[1]);
        const auto c = component(layer, triple[2]);
        if (a && b && c) {
            return {*a, *b, *c};
        }
    }
    return {};
}

std::optional<int> single_component(const ChannelLayer& layer) {
    std::optional<int> only;
    int count = 0;
    for (const LayerComponent& c : layer.components) {
        if (!equal_without_case(letter_of(c.suffix), "A")) {
            only = c.channel;
            ++count;
        }
    }
    if (count == 1) {
        return only;
    }
    if (count == 0) { // a mask of alpha alone
        return layer.components.size() == 1 ? std::optional(layer.components.front().channel) : std::nullopt;
    }
    if (!component(layer, "X") && !component(layer, "Y")) {
        return component(layer, "Z");
    }
    return std::nullopt;
}

std::string list_names(const std::vector<std::string>& names, std::size_t most) {
    if (names.size() <= most) {
        return fmt::format("{}", fmt::join(names, ", "));
    }
    return fmt::format("{} and {} more",
                       fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(most), ", "),
                       names.size() - most);
}

std::vector<std::string> layer_names(const std::vector<ChannelLayer>& layers) {
    std::vector<std::string> names;
    for (const ChannelLayer& layer : layers) {
        const bool bare_letter = layer.plain && is_component_suffix(layer.name);
        if (!layer.name.empty() && !bare_letter) {
            names.push_back(layer.name);
        } else if (layer.name.empty()) {
            for (const LayerComponent& c : layer.components) {
                names.push_back(c.suffix);
            }
        }
    }
    return names;
}

} // namespace clshade
