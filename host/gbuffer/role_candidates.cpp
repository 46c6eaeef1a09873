#include "host/gbuffer/role_candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

namespace clshade {

namespace {

bool is_colour(Role role) {
    return role == Role::albedo || role == Role::f0 || role == Role::emission;
}

/// The view layer before a rule's name in a layer's name; empty optional if the rule does not fit the name.
std::optional<std::string> match_name(const RoleRule& rule, const ChannelLayer& layer) {
    switch (rule.match) {
    case Match::whole: {
        const auto prefix = prefix_before(layer.name, rule.layer, rule.any_case);
        return prefix && prefix->empty() ? std::optional<std::string>("") : std::nullopt;
    }
    case Match::anywhere:
    case Match::prefixed: {
        const auto prefix = prefix_before(layer.name, rule.layer, rule.any_case);
        if (!prefix || (rule.match == Match::prefixed && prefix->empty())) {
            return std::nullopt;
        }
        return std::string(*prefix);
    }
    case Match::unreal: {
        if (layer.name == rule.layer) {
            return "";
        }
        for (const std::string_view prefix : unreal_prefixes()) {
            if (layer.name == std::string(prefix).append(rule.layer)) {
                return "";
            }
        }
        return std::nullopt;
    }
    case Match::suffix: {
        const bool fits = layer.components.size() == 1 && layer.components.front().suffix == rule.layer;
        return fits ? std::optional<std::string>("") : std::nullopt;
    }
    }
    return std::nullopt;
}

/// Takes the channels a rule needs out of a layer; leaves candidate.channels empty if the shape does not fit.
/// Returns the shape's rank: 0 as it should be, 1 a substitute.
int take_channels(const RoleRule& rule, const ChannelLayer& layer, Candidate& candidate) {
    if (!rule.component.empty()) {
        if (const auto channel = component(layer, rule.component)) {
            candidate.channels = {*channel};
        }
        return 0;
    }
    const int wanted = components_of(rule.role);
    const std::vector<int> three = three_components(layer, is_colour(rule.role) || wanted == 1);
    const auto single = single_component(layer);
    if (wanted == 3) {
        if (!three.empty()) {
            candidate.channels = three;
            return 0;
        }
        if (is_colour(rule.role) && single) { // grey
            candidate.channels = {*single};
        }
        return 1;
    }
    if (single) {
        candidate.channels = {*single};
        return 0;
    }
    if (!three.empty()) { // renderers that write every plane as a colour
        candidate.channels = {three[0]};
        candidate.first_of_three = true;
    }
    return 1;
}

bool has_layer(const std::vector<ChannelLayer>& layers, std::string_view tail, bool any_case) {
    return std::any_of(layers.begin(), layers.end(), [&](const ChannelLayer& layer) {
        return prefix_before(layer.name, tail, any_case).has_value();
    });
}

} // namespace

std::vector<Candidate> candidates_for(Role role, const std::vector<ChannelLayer>& layers,
                                      const std::optional<std::string>& home) {
    std::vector<Candidate> all;
    for (const RoleRule& rule : role_rules()) {
        if (rule.role != role) {
            continue;
        }
        for (const ChannelLayer& layer : layers) {
            const auto prefix = match_name(rule, layer);
            if (!prefix) {
                continue;
            }
            Candidate candidate;
            candidate.rule = &rule;
            candidate.prefix = *prefix;
            candidate.name = layer.name.empty() || rule.component.empty()
                                 ? layer.name
                                 : fmt::format("{}.{}", layer.name, rule.component);
            if (candidate.name.empty()) {
                candidate.name = rule.component;
            }
            const int shape = take_channels(rule, layer, candidate);
            if (candidate.channels.empty()) {
                continue;
            }
            const bool foreign = home && !prefix->empty() && *prefix != *home;
            const bool other_case = rule.any_case && !prefix_before(layer.name, rule.layer, false);
            const bool far = home ? *prefix != *home : !prefix->empty();
            candidate.key = {foreign ? 1 : 0, rule.priority, other_case ? 1 : 0,
                             far ? 1 : 0,     shape,         layer.of_view ? 0 : 1};
            all.push_back(std::move(candidate));
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.key < b.key; });
    std::vector<Candidate> each_once;
    std::set<std::vector<int>> seen;
    for (Candidate& candidate : all) {
        if (seen.insert(candidate.channels).second) {
            each_once.push_back(std::move(candidate));
        }
    }
    return each_once;
}

std::string why_empty(Role role, const std::vector<ChannelLayer>& layers) {
    switch (role) {
    case Role::normal:
        if (has_layer(layers, "normals", false) || has_layer(layers, "VRayBumpNormals", false)) {
            return "V-Ray's normals are not in world space (a frame per pixel) and are not taken";
        }
        if (has_layer(layers, "Denoising Normal", false)) {
            return "Denoising Normal is in camera space with z flipped and is not taken";
        }
        break;
    case Role::depth:
        if (has_layer(layers, "Denoising Depth", false) || has_layer(layers, "Mist", false)) {
            return "Mist and Denoising Depth are not distances along the axis and are not taken";
        }
        break;
    case Role::f0:
        for (const std::string_view name : {"GlossCol", "Glossy Color", "specular", "Specular"}) {
            if (has_layer(layers, name, false)) {
                return fmt::format("{} is not the reflectance at normal incidence and is not taken", name);
            }
        }
        break;
    case Role::roughness:
        if (!near_misses(role, layers).empty()) {
            return fmt::format("{} holds smoothness; use it with convert = \"smoothness\"",
                               near_misses(role, layers).front());
        }
        break;
    case Role::material_id:
        for (const std::string_view name : {"IndexOB", "Object Index", "id", "instanceID", "ObjectID", "objid"}) {
            if (has_layer(layers, name, false)) {
                return fmt::format("{} numbers objects, not materials, and is not taken by itself", name);
            }
        }
        break;
    default:
        break;
    }
    return "no layer has a known name";
}

std::vector<std::string> near_misses(Role role, const std::vector<ChannelLayer>& layers) {
    std::vector<std::string> names;
    if (role == Role::roughness) {
        for (const ChannelLayer& layer : layers) {
            for (const std::string_view name : {"Smoothness", "VRayMtlReflectGlossiness"}) {
                if (prefix_before(layer.name, name, true)) {
                    names.push_back(layer.name);
                }
            }
        }
    }
    return names;
}

} // namespace clshade
