// Interruption: SIGINT and SIGTERM leave nothing half-written.
#pragma once

#include "host/base/error.h"

#include <filesystem>
#include <string_view>

namespace clshade::cli {

/// From now on SIGINT and SIGTERM remove the temporaries of files being written and end the process with 130 or 143.
void install_signal_handlers();

/// While one lives, the first SIGINT or SIGTERM is only noted, so that a run can stop by itself and write its report. A
/// second one, or the grace of less than a second running out, ends the process as above. One at a time.
class GracefulStop {
  public:
    GracefulStop();
    ~GracefulStop();
    GracefulStop(const GracefulStop&) = delete;
    GracefulStop& operator=(const GracefulStop&) = delete;
    GracefulStop(GracefulStop&&) = delete;
    GracefulStop& operator=(GracefulStop&&) = delete;

    [[nodiscard]] bool requested() const noexcept;
    /// `interrupted` or `terminated`, by the signal that came; `ok` without one.
    [[nodiscard]] ExitCode exit_code() const noexcept;
};

/// Writes a small text file (a report) under a temporary name in the same folder and renames it. Throws RuntimeFailure
/// naming the file; the temporary is gone then, also after a signal.
void write_text_file(const std::filesystem::path& file, std::string_view text);

} // namespace clshade::cli
