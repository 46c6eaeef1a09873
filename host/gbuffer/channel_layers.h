// Channel names read as layers: "ViewLayer.Normal.X" is component X of the layer "ViewLayer.Normal".
#pragma once

#include "host/gbuffer/image_layout.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// One channel of a layer.
struct LayerComponent {
    std::string suffix; ///< as in the file; empty for a plane without a suffix
    int channel = 0;    ///< index into ImageLayout::channels
};

/// The channels that share everything before the last dot of their names.
struct ChannelLayer {
    std::string name;     ///< without the stereo view; "" for bare channels such as R or Z
    std::string raw_name; ///< as in the file
    bool plain = false;   ///< a single plane whose name carries no component suffix ("pscale", "other.mask")
    bool of_view = false; ///< belongs to the chosen stereo view, not to all of them
    std::vector<LayerComponent> components;
};

/// ASCII comparison without case.
[[nodiscard]] bool equal_without_case(std::string_view a, std::string_view b);

/// True for the component suffixes met in practice: X Y Z, R G B A, U V, T, I, red green blue alpha, in any case.
[[nodiscard]] bool is_component_suffix(std::string_view suffix);

/// What stands before `tail` in a dotted name: "" if `name` is `tail`, "View Layer.001" for
/// "View Layer.001.Normal" and "Normal"; empty optional if `name` does not end in exactly that dotted tail.
[[nodiscard]] std::optional<std::string_view> prefix_before(std::string_view name, std::string_view tail,
                                                            bool any_case);

/// The stereo view to use: `wanted`, or the first of the file, or "" in files without views. Throws UsageError listing
/// the views if `wanted` is not among them.
[[nodiscard]] std::string choose_view(const ImageLayout& layout, const std::string& wanted);

/// Layers of the channels that are visible in `view`: those of that view and those of none.
[[nodiscard]] std::vector<ChannelLayer> visible_layers(const ImageLayout& layout, const std::string& view);

/// Channel of the component with this suffix: exact case first, then any case, then the long names (red for R).
[[nodiscard]] std::optional<int> component(const ChannelLayer& layer, std::string_view suffix);

/// Channels of X, Y, Z or of R, G, B; `colour` looks for R, G, B first. Empty if neither set is complete.
[[nodiscard]] std::vector<int> three_components(const ChannelLayer& layer, bool colour);

/// The one channel of a layer that has just one beside alpha. A Z without X and Y counts as such a one.
[[nodiscard]] std::optional<int> single_component(const ChannelLayer& layer);

/// Layer names for messages: "A, B, C and 12 more".
[[nodiscard]] std::string list_names(const std::vector<std::string>& names, std::size_t most = 12);
[[nodiscard]] std::vector<std::string> layer_names(const std::vector<ChannelLayer>& layers);

} // namespace clshade
