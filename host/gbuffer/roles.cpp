#include "host/gbuffer/roles.h"

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/gbuffer/channel_layers.h"
#include "host/gbuffer/find_named.h"
#include "host/gbuffer/role_candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

namespace clshade {

namespace {

constexpr std::array<std::string_view, role_count> role_names{"normal",  "position",    "depth",    "albedo",
                                                              "f0",      "roughness",   "metallic", "shininess",
                                                              "tangent", "material_id", "coverage", "emission"};

/// Where the normal lives: the other planes should come from the same view layer.
using Home = std::optional<std::string>;

RoleChoice choose(Role role, const std::vector<ChannelLayer>& layers, const Home& home, const RoleRule*& used) {
    RoleChoice choice;
    choice.role = role;
    const std::vector<Candidate> candidates = candidates_for(role, layers, home);
    if (candidates.empty()) {
        choice.rule = why_empty(role, layers);
        choice.runners_up = near_misses(role, layers);
        return choice;
    }
    const Candidate& best = candidates.front();
    for (const Candidate& candidate : candidates) {
        if (candidate.key == best.key) {
            choice.ambiguous.push_back(candidate.name);
        } else {
            choice.runners_up.push_back(candidate.name);
        }
    }
    const std::vector<std::string> misses = near_misses(role, layers);
    choice.runners_up.insert(choice.runners_up.end(), misses.begin(), misses.end());
    if (choice.ambiguous.size() > 1) {
        choice.rule = fmt::format("{} fit equally well", list_names(choice.ambiguous));
        return choice;
    }
    choice.ambiguous.clear();
    choice.channels = best.channels;
    choice.layer = best.name;
    choice.rule = best.first_of_three ? fmt::format("{}, first of its channels", best.rule->producer)
                                      : std::string(best.rule->producer);
    used = best.rule;
    return choice;
}

/// "scene.toml:12:5: [gbuffer] normal"
std::string place(const RoleOverride& entry) {
    return located(entry.where, fmt::format("[gbuffer] {}", entry.role));
}

RoleChoice choose_by_override(Role role, const RoleOverride& entry, const ImageLayout& layout,
                              const std::vector<ChannelLayer>& layers, const Home& home) {
    RoleChoice choice;
    choice.role = role;
    choice.rule = entry.where.file.empty() ? "[gbuffer]" : fmt::format("[gbuffer] in {}", entry.where.file);
    const std::string what = place(entry);
    if (entry.channels.empty()) {
        throw UsageError(fmt::format("{}: names no channel; give a layer, channels, or \"none\"", what));
    }
    if (entry.channels.size() == 1 && entry.channels.front() == "none") {
        choice.rule += ": none";
        return choice;
    }
    const bool grey_fits = role == Role::albedo || role == Role::f0 || role == Role::emission;
    const Shape shape = components_of(role) == 1 ? Shape::scalar : grey_fits ? Shape::colour : Shape::vector;
    NamedChannels named = find_named(layout, layers, entry.channels, shape, home, what);
    choice.channels = std::move(named.channels);
    choice.layer = std::move(named.name);
    for (const Candidate& candidate : candidates_for(role, layers, home)) {
        if (candidate.channels != choice.channels) {
            choice.runners_up.push_back(candidate.name);
        }
    }
    return choice;
}

const RoleOverride* override_of(Role role, const GBufferSettings& settings) {
    const RoleOverride* found = nullptr;
    for (const RoleOverride& entry : settings.roles) {
        if (entry.role == name_of(role)) {
            found = &entry; // the last one holds: --set comes after the file
        }
    }
    return found;
}

void check_override_names(const GBufferSettings& settings) {
    for (const RoleOverride& entry : settings.roles) {
        if (!role_from_name(entry.role)) {
            throw UsageError(fmt::format("{}: there is no such role{}", place(entry),
                                         did_you_mean(entry.role, std::span<const std::string_view>(role_names))));
        }
    }
}

} // namespace

std::string_view name_of(Role role) {
    return role_names[static_cast<std::size_t>(role)];
}

std::optional<Role> role_from_name(std::string_view name) {
    const auto found = std::find(role_names.begin(), role_names.end(), name);
    if (found == role_names.end()) {
        return std::nullopt;
    }
    return static_cast<Role>(found - role_names.begin());
}

int components_of(Role role) {
    switch (role) {
    case Role::normal:
    case Role::position:
    case Role::albedo:
    case Role::f0:
    case Role::tangent:
    case Role::emission:
        return 3;
    case Role::depth:
    case Role::roughness:
    case Role::metallic:
    case Role::shininess:
    case Role::material_id:
    case Role::coverage:
        return 1;
    }
    return 1;
}

RoleAssignment assign_roles(const ImageLayout& layout, const GBufferSettings& settings, const std::string& view) {
    check_override_names(settings);
    RoleAssignment roles;
    roles.view = choose_view(layout, view);
    if (view.empty() && layout.views.size() > 1) {
        roles.warnings.push_back(fmt::format("the file has {} views ({}); '{}' is used, choose another with --view",
                                             layout.views.size(), list_names(layout.views), roles.view));
    }
    const std::vector<ChannelLayer> layers = visible_layers(layout, roles.view);
    std::array<const RoleRule*, role_count> used{};
    Home home;
    // The normal comes first in the enumeration: its view layer decides between equals of the other roles.
    for (std::size_t i = 0; i < role_count; ++i) {
        const Role role = static_cast<Role>(i);
        if (const RoleOverride* entry = override_of(role, settings)) {
            roles.choices[i] = choose_by_override(role, *entry, layout, layers, home);
        } else {
            roles.choices[i] = choose(role, layers, home, used[i]);
            const Home own = home_of(layers, roles[role].channels);
            if (home && own && !own->empty() && !home->empty() && *own != *home) {
                roles.warnings.push_back(fmt::format("{} '{}' and normal '{}' are of different view layers",
                                                     name_of(role), roles[role].layer, roles[Role::normal].layer));
            }
        }
        if (role == Role::normal) {
            home = home_of(layers, roles[role].channels);
        }
    }
    std::vector<std::string> warnings = role_warnings(layout, settings, roles, used, layers);
    std::move(warnings.begin(), warnings.end(), std::back_inserter(roles.warnings));
    return roles;
}

} // namespace clshade
