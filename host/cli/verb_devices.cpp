#include "host/cli/log_level.h"
#include "host/cli/options.h"
#include "host/cli/report_json.h"
#include "host/cli/table.h"
#include "host/cli/verb.h"
#include "host/device/device.h"
#include "host/shading/shader.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>

namespace clshade::cli {

namespace {

constexpr double mebibyte = 1024.0 * 1024.0;

nlohmann::json json_of(const DeviceInfo& device) {
    return {{"index", device.index},
            {"platform", device.platform},
            {"name", device.name},
            {"vendor", device.vendor},
            {"driver", device.driver},
            {"version", device.version},
            {"kind", name_of(device.kind)},
            {"compute_units", device.compute_units},
            {"global_memory", device.global_memory},
            {"max_allocation", device.max_allocation},
            {"preferred_float_lanes", device.preferred_float_lanes},
            {"lanes", automatic_lanes(device)},
            {"unified_memory", device.unified_memory}};
}

std::string table_of(const std::vector<DeviceInfo>& devices) {
    Table table({{"index"},
                 {"kind", Align::left},
                 {"platform/name", Align::left},
                 {"driver", Align::left},
                 {"units"},
                 {"memory [MiB]"},
                 {"lanes"},
                 {"zero-copy", Align::left}});
    for (const DeviceInfo& device : devices) {
        table.add_row({std::to_string(device.index), std::string(name_of(device.kind)),
                       device.platform + "/" + device.name, device.driver, std::to_string(device.compute_units),
                       fmt::format("{:.0f}", static_cast<double>(device.global_memory) / mebibyte),
                       std::to_string(automatic_lanes(device)), device.unified_memory ? "yes" : "no"});
    }
    return table.text();
}

ExitCode list(const CommonOptions& options, JsonReport& report) {
    DeviceList found = list_devices();
    for (const std::string& warning : found.warnings) {
        spdlog::warn(warning);
    }
    if (!options.device.empty()) { // shows what a selector would choose
        const DeviceInfo chosen = select_device(found, options.device);
        found.devices = {chosen};
    }
    if (found.devices.empty()) {
        throw DeviceError("no OpenCL device found; install a driver, for a CPU the package pocl-opencl-icd");
    }
    for (const DeviceInfo& device : found.devices) {
        report.add(json_of(device));
    }
    if (!options.quiet) {
        fmt::print("{}", table_of(found.devices));
    }
    return ExitCode::ok;
}

} // namespace

Action declare_devices(CLI::App& app) {
    auto options = std::make_shared<CommonOptions>();
    add_common_options(app, *options, CommonGroup::reporting);
    return [options] {
        set_log_level(*options);
        return with_report(*options, "devices", [&](JsonReport& report) { return list(*options, report); });
    };
}

} // namespace clshade::cli
