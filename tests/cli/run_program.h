// Runs clshade as a user would and catches everything it says.
#pragma once

#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace clshade::tests {

struct Outcome {
    int exit_code = -1; ///< -1: ended by a signal or by the timeout
    int signal = 0;
    bool timed_out = false;
    std::string out;
    std::string err;
    double seconds = 0.0;
    double peak_mib = 0.0; ///< largest resident memory

    /// Lines on stderr.
    [[nodiscard]] std::vector<std::string> error_lines() const;
};

struct RunSettings {
    double timeout_seconds = 120.0;
    std::filesystem::path folder; ///< working directory; empty: the test's
    long file_size_limit = -1;    ///< bytes any written file may have (a full disk); negative: no limit
    /// Called about every millisecond with the seconds passed; a signal returned is sent, 0: none.
    std::function<int(double)> meanwhile;
};

[[nodiscard]] Outcome run_clshade(const std::vector<std::string>& arguments, const RunSettings& settings = {});

/// A fresh folder, removed at the end.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    TemporaryFolder(TemporaryFolder&&) = delete;
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Names of everything in it, hidden files too, sorted.
    [[nodiscard]] std::vector<std::string> names() const;

  private:
    std::filesystem::path path_;
};

[[nodiscard]] std::string bytes_of(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

} // namespace clshade::tests
