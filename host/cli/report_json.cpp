#include "host/cli/report_json.h"

#include "host/cli/signals.h"

namespace clshade::cli {

void JsonReport::set_device(const DeviceInfo& info) {
    device_ = info.platform + "/" + info.name;
    driver_ = info.driver;
}

void JsonReport::add(nlohmann::json result) {
    result["status"] = "ok";
    results_.push_back(std::move(result));
}

void JsonReport::add(nlohmann::json result, std::string_view status, const std::string& reason) {
    result["status"] = status;
    result["reason"] = reason;
    has_error_ = has_error_ || status == "error";
    results_.push_back(std::move(result));
}

nlohmann::json JsonReport::document() const {
    nlohmann::json document = extra_;
    document["version"] = report_version;
    document["clshade"] = CLSHADE_VERSION;
    document["device"] = device_; // null where no device was opened
    document["driver"] = driver_;
    document["command"] = command_;
    document["results"] = results_;
    return document;
}

ExitCode with_report(const CommonOptions& options, const std::string& command,
                     const std::function<ExitCode(JsonReport&)>& verb) {
    JsonReport report(command);
    const auto write = [&] {
        if (!options.json_file.empty()) {
            // File names need not be UTF-8; a report with a replaced byte is better than none.
            write_text_file(options.json_file,
                            report.document().dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
        }
    };
    ExitCode code = ExitCode::ok;
    try {
        code = verb(report);
    } catch (const std::exception& error) {
        if (!report.has_error()) {
            report.add(nlohmann::json::object(), "error", error.what());
        }
        try {
            write();
        } catch (const Error&) { // the first trouble is the one to tell
        }
        throw;
    }
    write();
    return code;
}

} // namespace clshade::cli
