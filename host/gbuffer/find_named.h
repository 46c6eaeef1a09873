// Private to host/gbuffer: channels by the names users write.
#pragma once

#include "host/gbuffer/channel_layers.h"
#include "host/scene/scene.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// What the channels are for.
enum class Shape {
    scalar,    ///< one channel
    vector,    ///< three: X, Y, Z before R, G, B
    colour,    ///< three or one: R, G, B before X, Y, Z
    parameter, ///< as colour; said of a material
};

struct NamedChannels {
    std::vector<int> channels;
    std::string name; ///< of the layer, or the channels
};

/// "scene.toml:12:5: what", "scene.toml: what" or just "what", as far as the place is known.
[[nodiscard]] std::string located(const SourceLocation& where, std::string_view what);

/// The view layer that the layer of these channels stands in ("" for one without); empty without channels.
[[nodiscard]] std::optional<std::string> home_of(const std::vector<ChannelLayer>& layers,
                                                 const std::vector<int>& channels);

/// Resolves one name (a layer or a full channel name, with or without its view layer), or three full channel names.
/// `home` is the view layer that decides between equals. Throws UsageError starting with `what` for names that the file
/// does not have (with near matches), that fit several layers, or that have the wrong number of channels.
[[nodiscard]] NamedChannels find_named(const ImageLayout& layout, const std::vector<ChannelLayer>& layers,
                                       const std::vector<std::string>& names, Shape shape,
                                       const std::optional<std::string>& home, std::string_view what);

/// All channels of a layer, or one channel, to pass through. Throws UsageError as find_named.
[[nodiscard]] std::vector<int> find_kept(const ImageLayout& layout, const std::vector<ChannelLayer>& layers,
                                         const std::string& name);

} // namespace clshade
