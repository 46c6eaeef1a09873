// The machine-readable report of a verb (--json).
#pragma once

#include "host/base/error.h"
#include "host/cli/options.h"
#include "host/cli/verb.h"
#include "host/device/device.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>

namespace clshade::cli {

/// Version of the report's layout; grows when a key changes its meaning.
inline constexpr int report_version = 1;

/// Results as they come in. Written once, at the end.
class JsonReport {
  public:
    /// `command`: the verb.
    explicit JsonReport(std::string command) : command_(std::move(command)) {}

    void set_device(const DeviceInfo& info);
    /// A result that is "ok".
    void add(nlohmann::json result);
    /// A result that is "skipped", "unsupported" or "error", and why.
    void add(nlohmann::json result, std::string_view status, const std::string& reason);
    /// Further keys beside `results`.
    void set(const std::string& key, nlohmann::json value) { extra_[key] = std::move(value); }
    /// Whether a result of status "error" has been added.
    [[nodiscard]] bool has_error() const { return has_error_; }
    [[nodiscard]] nlohmann::json document() const;

  private:
    std::string command_;
    nlohmann::json device_;
    nlohmann::json driver_;
    nlohmann::json results_ = nlohmann::json::array();
    bool has_error_ = false;
    nlohmann::json extra_ = nlohmann::json::object();
};

/// Runs a verb and writes its report to options.json_file (nothing if empty), also
/// when the verb throws: then with a result of status "error", if the verb has added none. What the verb threw is
/// thrown on.
ExitCode with_report(const CommonOptions& options, const std::string& command,
                     const std::function<ExitCode(JsonReport&)>& verb);

} // namespace clshade::cli
