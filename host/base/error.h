// Errors: three families, each with the exit code a user sees (interface of the command line, "Exit codes").
#pragma once

#include <stdexcept>
#include <string>

namespace clshade {

/// Process exit codes; fixed by the public interface.
enum class ExitCode {
    ok = 0,
    runtime_failure = 1,   ///< trouble with the content of an input or output file, or with the device at run time
    usage = 2,             ///< bad flags, scene, roles or materials
    comparison_failed = 3, ///< `check` or a baseline comparison failed
    some_frames_failed = 4,
    no_device = 5,
    interrupted = 130, ///< SIGINT
    terminated = 143,  ///< SIGTERM
};

/// Base of all errors clshade reports. The message is one clear line, without the leading "clshade: ", that names the
/// file, channel, material or device at fault and says what to do: "FILE:LINE:COL: what is wrong; what to do".
class Error : public std::runtime_error {
  public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    [[nodiscard]] ExitCode exit_code() const { return code_; }

  private:
    ExitCode code_;
};

/// Content of a file, an unwritable output, a failed launch: exit code 1.
class RuntimeFailure : public Error {
  public:
    explicit RuntimeFailure(const std::string& message) : Error(ExitCode::runtime_failure, message) {}
};

/// Flags, scene, roles, materials: exit code 2.
class UsageError : public Error {
  public:
    explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
};

/// No device, or an ambiguous selector: exit code 5.
class DeviceError : public Error {
  public:
    explicit DeviceError(const std::string& message) : Error(ExitCode::no_device, message) {}
};

} // namespace clshade
