#include "host/cli/check_frame.h"

#include "host/cli/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace clshade::cli {

namespace {

constexpr int alpha_plane = 3;
constexpr std::size_t longest_name = 72; // of the table; reports have it whole

// Alpha is a plane's value clamped: the same float on both sides, or next to it.
const reference::Tolerance alpha_tolerance = reference::Tolerance::plain(1.2e-7, 0.0, 100.0);

struct Group {
    std::string model;
    reference::Tolerance tolerance;
    std::vector<int> materials; ///< indices; -1: no surface

    [[nodiscard]] bool claims(int material) const {
        return std::find(materials.begin(), materials.end(), material) != materials.end();
    }
};

// Stacks of models in the order of the materials, and the pixels without a surface.
std::vector<Group> groups_of(const Frame& frame, const ToleranceOverride& wanted) {
    std::vector<Group> groups;
    int index = 0;
    for (const BoundMaterial& material : frame.materials) {
        const std::string model = model_key(material);
        auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.model == model; });
        if (found == groups.end()) {
            groups.push_back(
                {model, wanted.apply(reference::default_tolerance(material, frame.environment.has_value())), {}});
            found = groups.end() - 1;
        }
        found->materials.push_back(index++);
    }
    const bool background = frame.environment && frame.environment->background;
    groups.push_back({"no_surface", reference::background_tolerance(background), {-1}});
    return groups;
}

// Where a plane's worst pixel differs, counted in the file's own pixels.
std::string difference(std::string_view what, const Frame& frame, const reference::Comparison& comparison) {
    const reference::Comparison::Worst& worst = comparison.worst;
    return fmt::format("{} differs at ({}, {}): device {}, reference {}", what, worst.x + frame.data_window.x_min,
                       worst.y + frame.data_window.y_min, worst.device, worst.reference);
}

// The environment's own planes, where they have been asked for.
void compare_environment(const Frame& frame, const ShadedImage& shaded, const reference::Image& expected,
                         const reference::RoundingScale& scale, const std::vector<std::uint8_t>& selected,
                         CheckResult& result) {
    const auto found = std::find(shaded.plane_names.begin(), shaded.plane_names.end(), "environment.R");
    if (found == shaded.plane_names.end()) {
        return;
    }
    const int plane = static_cast<int>(found - shaded.plane_names.begin());
    const reference::Comparison share =
        reference::compare(shaded.planes, expected, scale, result.tolerance, selected, plane);
    if (!reference::passes(share, result.tolerance)) {
        result.pass = false;
        result.trouble = difference("AOV environment", frame, share);
    }
}

nlohmann::json worst_of(const Frame& frame, const ShadedImage& shaded, const reference::Image& expected,
                        const reference::Comparison& comparison) {
    const reference::Comparison::Worst& worst = comparison.worst;
    if (worst.x < 0) {
        return {};
    }
    nlohmann::json inputs = nlohmann::json::object();
    for (std::size_t i = 0; i < frame.plane_names.size(); ++i) {
        inputs[frame.plane_names[i]] = frame.planes.at(static_cast<int>(i), worst.x, worst.y);
    }
    const auto pixel = static_cast<std::size_t>(worst.y) * static_cast<std::size_t>(expected.width) +
                       static_cast<std::size_t>(worst.x);
    nlohmann::json device = nlohmann::json::array();
    nlohmann::json reference = nlohmann::json::array();
    for (int c = 0; c < 3; ++c) {
        device.push_back(shaded.planes.at(c, worst.x, worst.y));
        reference.push_back(expected.planes[static_cast<std::size_t>(c)][pixel]);
    }
    // Counted in the file's own pixels.
    return {{"x", worst.x + frame.data_window.x_min},
            {"y", worst.y + frame.data_window.y_min},
            {"channel", worst.channel},
            {"inputs", inputs},
            {"device", device},
            {"reference", reference},
            {"share_of_tolerance", worst.share}};
}

} // namespace

reference::Tolerance ToleranceOverride::apply(const reference::Tolerance& defaults) const {
    if (is_plain()) {
        return reference::Tolerance::plain(rel.value_or(0.0), abs.value_or(0.0),
                                           percentile.value_or(defaults.percentile));
    }
    reference::Tolerance tolerance = defaults;
    tolerance.percentile = percentile.value_or(defaults.percentile);
    return tolerance;
}

Expectation expect(const Frame& frame, const AovSelection& aovs, int threads) {
    return {reference::shade(frame, aovs, threads), reference::rounding_scale(frame, threads)};
}

std::vector<CheckResult> check_frame(const Frame& frame, const ShadedImage& shaded, const Expectation& expectation,
                                     const ToleranceOverride& wanted) {
    const reference::Image& expected = expectation.image;
    const reference::RoundingScale& scale = expectation.scale;
    std::vector<CheckResult> results;
    for (const Group& group : groups_of(frame, wanted)) {
        std::vector<std::uint8_t> selected(expected.material.size());
        std::transform(expected.material.begin(), expected.material.end(), selected.begin(),
                       [&](int material) { return group.claims(material) ? std::uint8_t{1} : std::uint8_t{0}; });
        if (std::find(selected.begin(), selected.end(), 1) == selected.end()) {
            continue;
        }
        CheckResult result;
        result.model = group.model;
        result.tolerance = group.tolerance;
        result.comparison = reference::compare(shaded.planes, expected, scale, group.tolerance, selected);
        result.pass = reference::passes(result.comparison, group.tolerance);
        const reference::Comparison alpha =
            reference::compare(shaded.planes, expected, {}, alpha_tolerance, selected, alpha_plane, 1);
        if (!reference::passes(alpha, alpha_tolerance)) {
            result.pass = false;
            result.trouble = difference("alpha", frame, alpha);
        }
        compare_environment(frame, shaded, expected, scale, selected, result);
        result.worst = worst_of(frame, shaded, expected, result.comparison);
        results.push_back(std::move(result));
    }
    return results;
}

std::string check_table(const std::vector<CheckResult>& results) {
    Table table({{"model", Align::left},
                 {"pixels"},
                 {"max rel"},
                 {"rms rel"},
                 {"p99 rel"},
                 {"p99.9 rel"},
                 {"max abs"},
                 {"rms abs"},
                 {"max ulp"},
                 {"outside"},
                 {"tolerance", Align::left},
                 {"", Align::left}});
    for (const CheckResult& result : results) {
        const reference::Comparison& c = result.comparison;
        const reference::Tolerance& t = result.tolerance;
        std::string tolerance = fmt::format("{:g} rel + {:g} abs", t.rel, t.abs);
        if (t.per_roundoff > 0.0 || t.per_irradiance > 0.0) {
            tolerance = fmt::format("{:g} rel + {:g} light + {:g} roundings", t.rel, t.per_irradiance, t.per_roundoff);
        }
        table.add_row({shortened(result.model, longest_name), std::to_string(c.pixels), format_error(c.max_rel),
                       format_error(c.rms_rel), format_error(c.p99_rel), format_error(c.p999_rel),
                       format_error(c.max_abs), format_error(c.rms_abs), fmt::format("{:.0f}", c.max_ulp),
                       std::to_string(c.outside), fmt::format("{} for {:g} %", tolerance, t.percentile),
                       result.pass ? "pass" : "FAIL"});
    }
    return table.text();
}

std::string worst_text(const CheckResult& result) {
    if (result.worst.is_null()) {
        return {};
    }
    const nlohmann::json& worst = result.worst;
    std::string text = fmt::format(
        "{}: worst pixel ({}, {}), {:.3g} times what is allowed\n  device    {}\n  reference {}\n  inputs   ",
        result.model, worst["x"].get<int>(), worst["y"].get<int>(), result.comparison.worst.share,
        worst["device"].dump(), worst["reference"].dump());
    for (const auto& [name, value] : worst["inputs"].items()) {
        text += fmt::format(" {}={}", name, value.dump());
    }
    return text + "\n" + (result.trouble.empty() ? "" : "  " + result.trouble + "\n");
}

nlohmann::json json_of(const CheckResult& result) {
    const reference::Comparison& c = result.comparison;
    const reference::Tolerance& t = result.tolerance;
    nlohmann::json tolerance = {{"rel", t.rel},
                                {"abs", t.abs},
                                {"per_irradiance", t.per_irradiance},
                                {"per_roundoff", t.per_roundoff},
                                {"percentile", t.percentile}};
    if (t.hard < std::numeric_limits<double>::max()) {
        tolerance["hard"] = t.hard;
    }
    return {{"model", result.model},     {"pixels", c.pixels},   {"max_rel", c.max_rel},   {"rms_rel", c.rms_rel},
            {"p50_rel", c.p50_rel},      {"p99_rel", c.p99_rel}, {"p999_rel", c.p999_rel}, {"max_abs", c.max_abs},
            {"rms_abs", c.rms_abs},      {"max_ulp", c.max_ulp}, {"outside", c.outside},   {"tolerance", tolerance},
            {"trouble", result.trouble}, {"pass", result.pass},  {"worst", result.worst}};
}

} // namespace clshade::cli
