// Which channel plays which role, and why.
#pragma once

#include "host/gbuffer/image_layout.h"
#include "host/scene/scene.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

enum class Role {
    normal,
    position,
    depth,
    albedo,
    f0,
    roughness,
    metallic,
    shininess,
    tangent,
    material_id,
    coverage,
    emission,
};
inline constexpr int role_count = 12;

[[nodiscard]] std::string_view name_of(Role role);
[[nodiscard]] std::optional<Role> role_from_name(std::string_view name);
/// Components a role must have: 3 for directions, positions and colours (1 is accepted for colours: grey), else 1.
[[nodiscard]] int components_of(Role role);

/// The outcome for one role.
struct RoleChoice {
    Role role = Role::normal;
    std::vector<int> channels; ///< indices into ImageLayout::channels, in component order; empty: the role is empty
    std::string layer;         ///< layer name, for messages
    /// Why: "Blender pass name", "[gbuffer] in scene.toml", ...; for an empty role, why nothing fits.
    std::string rule;
    std::vector<std::string> runners_up; ///< layers that would also have fitted, best first
    /// Two layers fit equally well: the candidates. The role is then empty, and using it is an error that lists them.
    std::vector<std::string> ambiguous;
};

struct RoleAssignment {
    std::array<RoleChoice, role_count> choices;
    std::string view;                  ///< the stereo view chosen; empty in files without views
    std::vector<std::string> warnings; ///< half-float positions, DWA on data channels, colour space, ...

    [[nodiscard]] const RoleChoice& operator[](Role role) const { return choices[static_cast<std::size_t>(role)]; }
    [[nodiscard]] bool has(Role role) const { return !(*this)[role].channels.empty(); }
};

/// Finds each role by exact layer name per producer (the table is in role_rules.cpp), honours
/// the overrides of [gbuffer] and the stereo view (empty: the first view, said in a warning if there are several).
/// Throws UsageError for an override that names nothing in the file (with near matches), has the wrong number of
/// channels, or an unknown view.
[[nodiscard]] RoleAssignment assign_roles(const ImageLayout& layout, const GBufferSettings& settings,
                                          const std::string& view);

/// Finds the channels of a material parameter: a role's name, a layer's name (1 or 3 colour channels), a full channel
/// name. Returns indices into layout.channels: one or three. Throws UsageError naming the material and near matches.
[[nodiscard]] std::vector<int> find_channels(const ImageLayout& layout, const RoleAssignment& roles,
                                             const Parameter& parameter, std::string_view what);

} // namespace clshade
