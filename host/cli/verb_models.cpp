#include "host/base/suggest.h"
#include "host/cli/log_level.h"
#include "host/cli/options.h"
#include "host/cli/report_json.h"
#include "host/cli/table.h"
#include "host/cli/verb.h"
#include "host/scene/model_catalog.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace clshade::cli {

namespace {

constexpr std::size_t text_width = 100;
constexpr std::size_t label_width = 11;

struct ModelsOptions {
    CommonOptions common;
    std::string name;
};

nlohmann::json json_of(const ModelInfo& model) {
    nlohmann::json parameters = nlohmann::json::array();
    for (const ParameterInfo& parameter : model.parameters) {
        parameters.push_back({{"name", parameter.name},
                              {"unit", parameter.unit},
                              {"range", parameter.range},
                              {"default", parameter.fallback}});
    }
    return {{"model", model.name},    {"kind", model.kind},     {"summary", model.summary},
            {"source", model.source}, {"advice", model.advice}, {"parameters", parameters}};
}

void add_to(JsonReport& report, const ModelInfo& model) {
    report.add(json_of(model));
}

std::string overview_of(std::span<const ModelInfo> models) {
    Table table({{"model", Align::left}, {"kind", Align::left}, {"summary", Align::left}});
    for (const ModelInfo& model : models) {
        table.add_row({std::string(model.name), std::string(model.kind), std::string(model.summary)});
    }
    return table.text() + "\n`clshade models NAME` shows parameters, ranges and source.\n";
}

std::string page_of(const ModelInfo& model) {
    const auto line = [](std::string_view label, std::string_view text) {
        return text.empty()
                   ? std::string()
                   : fmt::format("{:<{}}{}\n", label, label_width, wrap(text, text_width - label_width, label_width));
    };
    std::string page = fmt::format("{} ({})\n\n", model.name, model.kind);
    page += line("what", model.summary) + line("when", model.advice) + line("source", model.source);
    if (!model.parameters.empty()) {
        Table table(
            {{"parameter", Align::left}, {"unit", Align::left}, {"range", Align::left}, {"default", Align::left}});
        for (const ParameterInfo& parameter : model.parameters) {
            table.add_row({std::string(parameter.name), std::string(parameter.unit), std::string(parameter.range),
                           std::string(parameter.fallback)});
        }
        page += "\n" + table.text();
    }
    return page;
}

ExitCode show(const ModelsOptions& options, JsonReport& report) {
    const std::span<const ModelInfo> models = model_catalog();
    std::string text;
    std::vector<std::string_view> names;
    for (const ModelInfo& model : models) {
        names.push_back(model.name);
        if (options.name.empty() || options.name == model.name) {
            add_to(report, model);
            text += options.name.empty() ? "" : page_of(model);
        }
    }
    if (options.name.empty()) {
        text = overview_of(models);
    } else if (text.empty()) {
        throw UsageError(fmt::format("models: '{}' is not a model{}; `clshade models` lists them", options.name,
                                     did_you_mean(options.name, std::span<const std::string_view>(names))));
    }
    if (!options.common.quiet) {
        fmt::print("{}", text);
    }
    return ExitCode::ok;
}

} // namespace

Action declare_models(CLI::App& app) {
    auto options = std::make_shared<ModelsOptions>();
    app.add_option("NAME", options->name, "show this model only, with its parameters");
    add_common_options(app, options->common, CommonGroup::reporting);
    return [options] {
        set_log_level(options->common);
        return with_report(options->common, "models", [&](JsonReport& report) { return show(*options, report); });
    };
}

} // namespace clshade::cli
