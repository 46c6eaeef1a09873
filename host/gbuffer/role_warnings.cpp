// What must be said about the layers chosen: the traps of conventions, "Channel names and spaces" and "Values".
#include "host/gbuffer/channel_layers.h"
#include "host/gbuffer/role_candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace clshade {

namespace {

const ChannelInfo& info_of(const ImageLayout& layout, int channel) {
    return layout.channels[static_cast<std::size_t>(channel)];
}

bool any_half(const ImageLayout& layout, const RoleChoice& choice) {
    return std::any_of(choice.channels.begin(), choice.channels.end(),
                       [&](int channel) { return info_of(layout, channel).type == SampleType::half; });
}

std::string caution_text(Caution caution, const RoleChoice& choice, const GBufferSettings& settings) {
    const std::string what = fmt::format("{} '{}'", name_of(choice.role), choice.layer);
    switch (caution) {
    case Caution::none:
    case Caution::beauty_alpha: // told by the rule's text alone
        return {};
    case Caution::base_colour:
        return what + " is the base colour: metals are in it too";
    case Caution::includes_specular:
        return what + " holds specular reflectance too";
    case Caution::camera_space:
        return settings.normal_space == NormalSpace::camera
                   ? std::string()
                   : what + " is in camera space by its writer's default; if so, write normal_space = \"camera\" in "
                            "[gbuffer]";
    case Caution::left_handed:
        return what +
               " is Unreal's: left-handed, Z up, centimetres; give lights in the same axes and unit, and let the "
               "camera be recovered from the position";
    case Caution::maybe_left_handed:
        return what + " is Redshift's or Unity's name; Unity is left-handed, Y up: give lights in the same axes";
    case Caution::ray_distance:
        return settings.depth_kind == DepthKind::ray
                   ? std::string()
                   : what + " is Mitsuba's distance along the ray; write depth_kind = \"ray\" in [gbuffer]";
    case Caution::unchecked_depth:
        return what + " is V-Ray's and may be clamped or inverted; check its range";
    }
    return {};
}

/// DWA picks its lossy channels by the last part of the name.
void warn_of_dwa(const ImageLayout& layout, const RoleChoice& choice, std::vector<std::string>& warnings) {
    std::vector<std::string> damaged;
    std::string compression;
    for (const int channel : choice.channels) {
        const ChannelInfo& info = info_of(layout, channel);
        const std::size_t part = static_cast<std::size_t>(info.part);
        if (part >= layout.parts.size() || !layout.parts[part].compression.starts_with("dwa")) {
            continue;
        }
        const std::string last = info.file_name.substr(info.file_name.rfind('.') + 1);
        for (const std::string_view lossy : {"R", "G", "B", "Y"}) {
            if (equal_without_case(last, lossy)) {
                damaged.push_back(info.name);
                compression = layout.parts[part].compression;
            }
        }
    }
    if (!damaged.empty()) {
        warnings.push_back(fmt::format("{} {} damaged by lossy {} compression; write data passes with zip",
                                       list_names(damaged), damaged.size() == 1 ? "is" : "are", compression));
    }
}

/// Linear Rec.709 by any of the names in use.
bool is_linear_rec709(std::string_view name) {
    constexpr std::array<std::string_view, 11> names{"linear",
                                                     "lin_rec709",
                                                     "lin_rec709_scene",
                                                     "lin_srgb",
                                                     "linear rec.709",
                                                     "linear rec709",
                                                     "linear rec.709 (srgb)",
                                                     "linear srgb",
                                                     "scene_linear",
                                                     "scene-linear rec.709-srgb",
                                                     "scene-linear rec 709/srgb"};
    return std::any_of(names.begin(), names.end(), [&](std::string_view n) { return equal_without_case(n, name); });
}

/// The numbers of a text such as "(0.64 0.33) (0.3 0.6) ...".
std::vector<double> numbers_in(const std::string& text) {
    std::vector<double> numbers;
    const char* at = text.c_str();
    while (*at != '\0') {
        char* end = nullptr;
        const double value = std::strtod(at, &end);
        if (end == at) {
            ++at;
        } else {
            numbers.push_back(value);
            at = end;
        }
    }
    return numbers;
}

void warn_of_colour_space(const ImageLayout& layout, std::vector<std::string>& warnings) {
    for (const auto& [name, value] : layout.strings) {
        const std::string_view last = std::string_view(name).substr(name.rfind('/') + 1);
        const bool names_space = equal_without_case(last, "color_space") || equal_without_case(last, "colorspace");
        if (names_space && !value.empty() && !is_linear_rec709(value)) {
            warnings.push_back(fmt::format("{} says '{}'; colours are taken as linear Rec.709", name, value));
        }
    }
    const auto found = layout.strings.find("chromaticities");
    if (found == layout.strings.end()) {
        return;
    }
    constexpr std::array rec709{0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329};
    const std::vector<double> values = numbers_in(found->second);
    const bool same =
        values.size() == rec709.size() && std::equal(values.begin(), values.end(), rec709.begin(),
                                                     [](double a, double b) { return std::abs(a - b) < 2e-3; });
    if (!same) {
        warnings.push_back(
            fmt::format("chromaticities ({}) are not Rec.709; colours are taken as linear Rec.709", found->second));
    }
}

bool has_override(const GBufferSettings& settings, Role role) {
    return std::any_of(settings.roles.begin(), settings.roles.end(),
                       [&](const RoleOverride& entry) { return entry.role == name_of(role); });
}

} // namespace

std::vector<std::string> role_warnings(const ImageLayout& layout, const GBufferSettings& settings,
                                       const RoleAssignment& roles, const std::array<const RoleRule*, role_count>& used,
                                       const std::vector<ChannelLayer>& layers) {
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < role_count; ++i) {
        const RoleChoice& choice = roles.choices[i];
        if (used[i] == nullptr) {
            continue;
        }
        const bool ray = choice.role == Role::depth && info_of(layout, choice.channels.front()).name.ends_with(".T");
        const std::string text = caution_text(ray ? Caution::ray_distance : used[i]->caution, choice, settings);
        if (!text.empty()) {
            warnings.push_back(text);
        }
    }
    const RoleChoice& normal = roles[Role::normal];
    if (normal.channels.empty() && normal.ambiguous.empty() && !has_override(settings, Role::normal)) {
        const std::string reason = why_empty(Role::normal, layers);
        if (reason != why_empty(Role::normal, {})) {
            warnings.push_back(reason);
        }
    }
    const RoleChoice& position = roles[Role::position];
    if (any_half(layout, position)) {
        warnings.push_back(fmt::format("position '{}' is stored as half: off by 0.002 units at 10 and useless beyond a "
                                       "few units; prefer depth and a camera (position = \"none\" in [gbuffer])",
                                       position.layer));
    }
    const RoleChoice& ids = roles[Role::material_id];
    if (any_half(layout, ids)) {
        warnings.push_back(fmt::format("material_id '{}' is stored as half: ids above 2048 are rounded", ids.layer));
    }
    warn_of_dwa(layout, normal, warnings);
    warn_of_dwa(layout, position, warnings);
    warn_of_colour_space(layout, warnings);
    return warnings;
}

} // namespace clshade
