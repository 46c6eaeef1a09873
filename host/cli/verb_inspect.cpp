#include "host/base/error.h"
#include "host/cli/chosen_scene.h"
#include "host/cli/environment_input.h"
#include "host/cli/log_level.h"
#include "host/cli/pixel_survey.h"
#include "host/cli/plan_text.h"
#include "host/cli/report_json.h"
#include "host/cli/table.h"
#include "host/cli/thread_limit.h"
#include "host/cli/verb.h"
#include "host/images/image_reader.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace clshade::cli {

namespace {

constexpr std::size_t most_ids_listed = 40;

struct InspectOptions {
    CommonOptions common;
    SceneOptions scene;
    std::string input;
};

std::string_view name_of_type(SampleType type) {
    switch (type) {
    case SampleType::half:
        return "half";
    case SampleType::float32:
        return "float";
    case SampleType::uint32:
        return "uint";
    }
    return "?";
}

std::string text_of(const Window& window) {
    return fmt::format("{}x{} from ({}, {})", window.width(), window.height(), window.x_min, window.y_min);
}

nlohmann::json json_of(const Window& window) {
    return {window.x_min, window.y_min, window.x_max, window.y_max};
}

std::vector<std::string> channel_names(const ImageLayout& layout, const std::vector<int>& channels) {
    std::vector<std::string> names;
    names.reserve(channels.size());
    for (const int channel : channels) {
        names.push_back(layout.channels[static_cast<std::size_t>(channel)].name);
    }
    return names;
}

std::string header_text(const ImageLayout& layout) {
    std::string text = fmt::format("{}\n  display window  {}\n  pixel aspect    {}\n", layout.file,
                                   text_of(layout.display_window), layout.pixel_aspect);
    if (!layout.views.empty()) {
        text += fmt::format("  views           {}\n", fmt::join(layout.views, ", "));
    }
    Table parts({{"part"},
                 {"name", Align::left},
                 {"data window", Align::left},
                 {"compression", Align::left},
                 {"storage", Align::left},
                 {"view", Align::left}});
    for (std::size_t i = 0; i < layout.parts.size(); ++i) {
        const PartInfo& part = layout.parts[i];
        parts.add_row({std::to_string(i), part.name, text_of(part.data_window), part.compression,
                       part.tiled ? "tiles" : "scan lines", part.view});
    }
    Table channels({{"channel", Align::left}, {"type", Align::left}, {"part"}, {"view", Align::left}});
    for (const ChannelInfo& channel : layout.channels) {
        channels.add_row(
            {channel.name, std::string(name_of_type(channel.type)), std::to_string(channel.part), channel.view});
    }
    return text + "\n" + parts.text() + "\n" + channels.text();
}

std::string roles_table(const ImageLayout& layout, const RoleAssignment& roles) {
    Table table({{"role", Align::left}, {"channels", Align::left}, {"why", Align::left}});
    for (const RoleChoice& choice : roles.choices) {
        std::string why = choice.rule;
        if (!choice.ambiguous.empty()) {
            why = fmt::format("ambiguous: {}; choose one in [gbuffer]", fmt::join(choice.ambiguous, ", "));
        }
        if (!choice.runners_up.empty()) {
            why += fmt::format("{}runners-up: {}", why.empty() ? "" : "; ", fmt::join(choice.runners_up, ", "));
        }
        table.add_row(
            {std::string(name_of(choice.role)),
             choice.channels.empty() ? "-" : fmt::format("{}", fmt::join(channel_names(layout, choice.channels), " ")),
             why});
    }
    return table.text();
}

std::string camera_text(const CameraSurvey& camera) {
    std::string text = "camera: " + camera.source;
    if (camera.view) {
        const View& view = *camera.view;
        text += view.orthographic ? ", orthographic"
                                  : fmt::format(", eye ({:.4f}, {:.4f}, {:.4f})", view.eye.x, view.eye.y, view.eye.z);
        text +=
            fmt::format(", looks along ({:.4f}, {:.4f}, {:.4f})", view.view_axis.x, view.view_axis.y, view.view_axis.z);
        text += view.has_rays ? "" : ", field of view unknown";
    }
    if (camera.fitted) {
        text += fmt::format("\n  fit: median {:.3g} px, p99 {:.3g} px, {} samples, {:.1f} % inliers",
                            camera.fitted->median_error_px, camera.fitted->p99_error_px, camera.fitted->samples,
                            100.0 * camera.fitted->inlier_fraction);
    }
    if (camera.residual_px >= 0.0) {
        text += fmt::format("\n  residual: positions are seen {:.3g} px off (median)", camera.residual_px);
    }
    return text + (camera.trouble.empty() ? "" : "\n  " + camera.trouble) + "\n";
}

std::string ids_text(const IdSurvey& ids) {
    Table table({{"material id"}, {"pixels"}});
    std::size_t listed = 0;
    for (const auto& [id, pixels] : ids.pixels) {
        if (++listed > most_ids_listed) {
            break;
        }
        table.add_row({std::to_string(id), std::to_string(pixels)});
    }
    std::string text = table.text();
    if (ids.pixels.size() > most_ids_listed) {
        text += fmt::format("... {} more ids (all in --json)\n", ids.pixels.size() - most_ids_listed);
    }
    if (ids.fractional > 0) {
        text += fmt::format("{} pixels hold fractions: this plane has been filtered and `shade` will refuse it\n",
                            ids.fractional);
    }
    if (ids.nonfinite > 0) {
        text += fmt::format("{} pixels hold NaN, Inf or numbers too large for an id\n", ids.nonfinite);
    }
    return text;
}

nlohmann::json json_of(const ImageLayout& layout) {
    nlohmann::json parts = nlohmann::json::array();
    for (const PartInfo& part : layout.parts) {
        parts.push_back({{"name", part.name},
                         {"view", part.view},
                         {"data_window", json_of(part.data_window)},
                         {"compression", part.compression},
                         {"tiled", part.tiled}});
    }
    nlohmann::json channels = nlohmann::json::array();
    for (const ChannelInfo& channel : layout.channels) {
        channels.push_back({{"name", channel.name},
                            {"type", name_of_type(channel.type)},
                            {"part", channel.part},
                            {"view", channel.view}});
    }
    return {{"input", layout.file},
            {"display_window", json_of(layout.display_window)},
            {"pixel_aspect", layout.pixel_aspect},
            {"views", layout.views},
            {"parts", parts},
            {"channels", channels}};
}

nlohmann::json json_of(const ImageLayout& layout, const RoleAssignment& roles) {
    nlohmann::json all = nlohmann::json::object();
    for (const RoleChoice& choice : roles.choices) {
        all[std::string(name_of(choice.role))] = {{"channels", channel_names(layout, choice.channels)},
                                                  {"rule", choice.rule},
                                                  {"runners_up", choice.runners_up},
                                                  {"ambiguous", choice.ambiguous}};
    }
    return all;
}

nlohmann::json json_of(const CameraSurvey& camera) {
    nlohmann::json result = {{"source", camera.source}, {"trouble", camera.trouble}};
    if (camera.residual_px >= 0.0) {
        result["residual_px"] = camera.residual_px;
    }
    if (camera.view) {
        const View& view = *camera.view;
        result["orthographic"] = view.orthographic;
        result["eye"] = {view.eye.x, view.eye.y, view.eye.z};
        result["view_axis"] = {view.view_axis.x, view.view_axis.y, view.view_axis.z};
        result["has_rays"] = view.has_rays;
    }
    if (camera.fitted) {
        result["fit"] = {{"median_px", camera.fitted->median_error_px},
                         {"p99_px", camera.fitted->p99_error_px},
                         {"samples", camera.fitted->samples},
                         {"inlier_fraction", camera.fitted->inlier_fraction}};
    }
    return result;
}

nlohmann::json json_of(const IdSurvey& ids) {
    nlohmann::json pixels = nlohmann::json::object();
    for (const auto& [id, count] : ids.pixels) {
        pixels[std::to_string(id)] = count;
    }
    return {{"pixels", pixels}, {"fractional", ids.fractional}, {"nonfinite", ids.nonfinite}};
}

std::string environment_text(const EnvironmentInput& environment) {
    std::string text = fmt::format("environment: {}, {}\n", environment.name, environment.description());
    for (const std::string& warning : environment.warnings) {
        text += "  warning: " + warning + "\n";
    }
    return text;
}

nlohmann::json json_of(const EnvironmentInput& environment) {
    const glm::dvec3 mean = environment.mean();
    nlohmann::json result = {{"name", environment.name},
                             {"hash", environment.hash},
                             {"mean", {mean.r, mean.g, mean.b}},
                             {"prefiltered", environment.image == nullptr},
                             {"warnings", environment.warnings}};
    if (environment.image != nullptr) {
        result["width"] = environment.image->width;
        result["height"] = environment.image->height;
        result["negative"] = environment.image->negative;
        result["nonfinite"] = environment.image->nonfinite;
        result["halvings"] = environment.image->halvings;
    }
    return result;
}

// Prints a paragraph unless --quiet.
void show(const InspectOptions& options, const std::string& text) {
    if (!options.common.quiet && !text.empty()) {
        fmt::print("{}\n", text);
    }
}

ExitCode inspect(const InspectOptions& options, JsonReport& report) {
    if (options.input.empty()) {
        throw UsageError("inspect: INPUT is missing; write `clshade inspect INPUT`");
    }
    const RunScene scene = choose_scene(options.scene);
    const ImageLayout layout = read_layout(options.input);
    show(options, header_text(layout)); // first of all, so that broken pixels do not hide a good header
    nlohmann::json result = json_of(layout);
    const RoleAssignment roles = assign_roles(layout, scene.scene.gbuffer, options.scene.view);
    show(options, roles_table(layout, roles));
    result["roles"] = json_of(layout, roles);
    std::vector<std::string> warnings = layout.warnings;
    warnings.insert(warnings.end(), roles.warnings.begin(), roles.warnings.end());
    result["warnings"] = warnings;
    std::string text;
    for (const std::string& warning : warnings) {
        text += "warning: " + warning + "\n";
    }
    show(options, text);
    try {
        const CameraSurvey camera =
            survey_camera(options.input, layout, roles, scene.scene, options.common.host_threads());
        show(options, camera_text(camera));
        result["camera"] = json_of(camera);
        if (roles.has(Role::material_id)) {
            const IdSurvey ids = survey_ids(options.input, layout, roles, options.common.host_threads());
            show(options, ids_text(ids));
            result["material_ids"] = json_of(ids);
        }
        if (scene.scene.environment) {
            const EnvironmentInput environment = read_environment(scene.scene, options.common.max_memory);
            show(options, environment_text(environment));
            result["environment"] = json_of(environment);
        }
    } catch (const RuntimeFailure& error) {
        report.add(result, "error", error.what());
        throw;
    }
    report.add(result);
    return ExitCode::ok;
}

} // namespace

Action declare_inspect(CLI::App& app) {
    auto options = std::make_shared<InspectOptions>();
    app.add_option("INPUT", options->input, "any EXR file");
    add_scene_options(app, options->scene);
    add_common_options(app, options->common, CommonGroup::reporting);
    return [options] {
        set_log_level(options->common);
        const auto limit = thread_limit(options->common);
        return with_report(options->common, "inspect", [&](JsonReport& report) { return inspect(*options, report); });
    };
}

} // namespace clshade::cli
