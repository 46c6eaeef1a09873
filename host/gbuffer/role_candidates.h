// Private to host/gbuffer: layers that fit a role, in order of fitness.
#pragma once

#include "host/gbuffer/channel_layers.h"
#include "host/gbuffer/role_rules.h"
#include "host/gbuffer/roles.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace clshade {

/// One layer (or one component of it) that a rule offers for a role.
struct Candidate {
    std::string name;   ///< the layer, or the full channel name where a rule takes one component
    std::string prefix; ///< the view layer
    const RoleRule* rule = nullptr;
    std::vector<int> channels;
    bool first_of_three = false; ///< a scalar taken from the first channel of a colour
    /// Smaller is better, compared in order: of a foreign view layer, rule priority, letter case, distance of the view
    /// layer, shape, not of the chosen stereo view. Equal keys of two layers are an ambiguity.
    std::array<int, 6> key{};
};

/// Candidates for a role, best first, each layer once. `home` is the view layer of the normal, if one was found: layers
/// of other view layers come last.
[[nodiscard]] std::vector<Candidate> candidates_for(Role role, const std::vector<ChannelLayer>& layers,
                                                    const std::optional<std::string>& home);

/// Why no layer fits: names that look like the role and are not taken on purpose (GlossCol is not F0, ...).
[[nodiscard]] std::string why_empty(Role role, const std::vector<ChannelLayer>& layers);

/// Layers that would fit after a conversion or a change of space; told as runners-up.
[[nodiscard]] std::vector<std::string> near_misses(Role role, const std::vector<ChannelLayer>& layers);

/// Warnings about the layers chosen: half-float positions and ids, DWA compression, handedness, colour space, ...
/// `used` holds the candidate behind every automatic choice, else null.
[[nodiscard]] std::vector<std::string> role_warnings(const ImageLayout& layout, const GBufferSettings& settings,
                                                     const RoleAssignment& roles,
                                                     const std::array<const RoleRule*, role_count>& used,
                                                     const std::vector<ChannelLayer>& layers);

} // namespace clshade
