// The table of layer names: which producer writes which role under which name.
#pragma once

#include "host/gbuffer/roles.h"

#include <span>
#include <string_view>

namespace clshade {

/// Where the rule's layer name may stand in a layer's full name.
enum class Match {
    anywhere, ///< the whole name, or behind a view layer's name and a dot
    whole,    ///< the whole name only
    prefixed, ///< behind a view layer's name only
    unreal,   ///< the whole name, or behind one of the prefixes of Unreal's movie render queue
    suffix,   ///< any layer with one component of this suffix (Mitsuba)
};

/// What must be said when the rule is used.
enum class Caution {
    none,
    base_colour,       ///< includes the colour of metals
    camera_space,      ///< written in camera space by default
    left_handed,       ///< Unreal: left-handed, centimetres
    maybe_left_handed, ///< Redshift and Unity share the name
    ray_distance,      ///< depth is a ray length
    unchecked_depth,   ///< V-Ray: may be clamped or inverted by the artist
    includes_specular, ///< an albedo that holds specular reflectance too
    beauty_alpha,      ///< alpha of the picture: 1 on an opaque film
};

struct RoleRule {
    Role role;
    std::string_view layer;
    Match match;
    bool any_case;
    int priority;               ///< lower is better
    std::string_view producer;  ///< for people: "Blender pass Normal"
    std::string_view component; ///< a certain component of the layer; empty: what the role needs
    Caution caution;
};

/// All rules, from files and documentation of each producer, in no particular order.
[[nodiscard]] std::span<const RoleRule> role_rules();

/// What Unreal's movie render queue may write before the name of a pass.
[[nodiscard]] std::span<const std::string_view> unreal_prefixes();

} // namespace clshade
