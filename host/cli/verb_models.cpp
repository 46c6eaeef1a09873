#include "host/base/suggest.h"
#include "host/cli/log_level.h"
#include "host/cli/models_text.h"
#include "host/cli/options.h"
#include "host/cli/progress.h"
#include "host/cli/report_json.h"
#include "host/cli/session.h"
#include "host/cli/thumbnails.h"
#include "host/cli/verb.h"
#include "host/scene/model_catalog.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace clshade::cli {

namespace {

struct ModelsOptions {
    CommonOptions common;
    std::string name;
    std::string thumbnails;
};

[[noreturn]] void refuse_name(const std::string& name) {
    std::vector<std::string_view> names{environment_name};
    for (const ParameterInfo& key : environment_keys()) {
        if (key.name == name) {
            throw UsageError(fmt::format("models: '{}' is a key of an environment; see `clshade models {}`", name,
                                         environment_name));
        }
    }
    for (const ModelInfo& model : model_catalog()) {
        const auto has_name = [&](const ParameterInfo& parameter) { return parameter.name == name; };
        if (std::any_of(model.parameters.begin(), model.parameters.end(), has_name)) {
            throw UsageError(fmt::format("models: '{0}' is a parameter, of {1} for one; see `clshade models {1}`", name,
                                         model.name));
        }
        names.push_back(model.name);
    }
    for (const PresetInfo& preset : preset_catalog()) {
        names.push_back(preset.name);
    }
    throw UsageError(fmt::format("models: '{}' is no model and no preset{}; `clshade models` lists them", name,
                                 did_you_mean(name, std::span<const std::string_view>(names))));
}

ExitCode make_thumbnails(const ModelsOptions& options, JsonReport& report) {
    if (!options.name.empty()) {
        throw UsageError(
            fmt::format("models: --thumbnails makes the pictures of all presets; leave '{}' out", options.name));
    }
    Session session(options.common);
    report.set_device(session.info());
    Progress progress(options.common, static_cast<int>(preset_catalog().size()), Steps::other);
    write_thumbnails(options.thumbnails, preset_catalog(), session, options.common.host_threads(),
                     [&](const std::filesystem::path& file) { progress.update("shading " + file.string()); });
    progress.clear();
    for (const PresetInfo& preset : preset_catalog()) {
        const std::string file = thumbnail_file(options.thumbnails, preset).string();
        report.add({{"model", preset.name}, {"kind", "preset"}, {"output", file}});
        if (!options.common.quiet) {
            fmt::print("{} -> {}\n", preset.name, file);
        }
    }
    return ExitCode::ok;
}

ExitCode show(const ModelsOptions& options, JsonReport& report) {
    if (!options.thumbnails.empty()) {
        return make_thumbnails(options, report);
    }
    std::string pages;
    const auto add = [&](const auto& entry) {
        if (options.name.empty() || options.name == entry.name) {
            report.add(json_of(entry));
            pages += page_of(entry);
        }
    };
    for (const ModelInfo& model : model_catalog()) {
        add(model);
    }
    if (options.name.empty() || options.name == environment_name) {
        report.add(environment_json());
        pages += environment_page();
    }
    for (const PresetInfo& preset : preset_catalog()) {
        add(preset);
    }
    if (pages.empty()) {
        refuse_name(options.name);
    }
    if (!options.common.quiet) {
        fmt::print("{}", options.name.empty() ? catalog_text() : pages);
    }
    return ExitCode::ok;
}

} // namespace

Action declare_models(CLI::App& app) {
    auto options = std::make_shared<ModelsOptions>();
    app.add_option("NAME", options->name, "show this model or preset only, with its parameters");
    app.add_option("--thumbnails", options->thumbnails,
                   "shade a picture of every preset into DIR/NAME.png, 256x256 pixels, and stop")
        ->type_name("DIR");
    add_common_options(app, options->common, CommonGroup::running);
    return [options] {
        set_log_level(options->common);
        return with_report(options->common, "models", [&](JsonReport& report) { return show(*options, report); });
    };
}

} // namespace clshade::cli
