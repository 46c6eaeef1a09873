// Interruption: SIGINT and SIGTERM leave nothing half-written.
#pragma once

#include <filesystem>
#include <string_view>

namespace clshade::cli {

/// From now on SIGINT and SIGTERM remove the temporaries of files being written and end the process with 130 or 143.
void install_signal_handlers();

/// Writes a small text file (a report) under a temporary name in the same folder and renames it. Throws RuntimeFailure
/// naming the file; the temporary is gone then, also after a signal.
void write_text_file(const std::filesystem::path& file, std::string_view text);

} // namespace clshade::cli
