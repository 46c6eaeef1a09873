#include "tests/cli/run_program.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace clshade::tests {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// In the child: never returns.
[[noreturn]] void become_clshade(const std::vector<std::string>& arguments, const RunSettings& settings,
                                 const std::string& out, const std::string& err) {
    const auto redirect = [](const std::string& file, int descriptor) {
        const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(opened, descriptor);
        close(opened);
    };
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    if (settings.file_size_limit >= 0) {
        // Writing past the limit fails with EFBIG, as it fails with ENOSPC on a full disk.
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{static_cast<rlim_t>(settings.file_size_limit),
                           static_cast<rlim_t>(settings.file_size_limit)};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (!settings.folder.empty() && chdir(settings.folder.c_str()) != 0) {
        _exit(126);
    }
    std::vector<char*> argv;
    std::string program = CLSHADE_PROGRAM;
    argv.push_back(program.data());
    std::vector<std::string> copies = arguments;
    for (std::string& argument : copies) {
        argv.push_back(argument.data());
    }
    argv.push_back(nullptr);
    execv(program.c_str(), argv.data());
    _exit(127);
}

} // namespace

std::vector<std::string> Outcome::error_lines() const {
    std::vector<std::string> lines;
    std::istringstream stream(err);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

Outcome run_clshade(const std::vector<std::string>& arguments, const RunSettings& settings) {
    const TemporaryFolder capture;
    const std::string out = (capture / "out").string();
    const std::string err = (capture / "err").string();
    const auto start = Clock::now();
    const pid_t child = fork();
    if (child < 0) {
        throw std::runtime_error("cannot fork");
    }
    if (child == 0) {
        become_clshade(arguments, settings, out, err);
    }
    Outcome run;
    rusage usage{};
    int status = 0;
    while (wait4(child, &status, WNOHANG, &usage) == 0) {
        const double passed = seconds_since(start);
        if (!run.timed_out && passed > settings.timeout_seconds) {
            run.timed_out = true;
            kill(child, SIGKILL);
        } else if (settings.meanwhile) {
            if (const int signal = settings.meanwhile(passed); signal != 0) {
                kill(child, signal);
            }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    run.seconds = seconds_since(start);
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    run.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    run.peak_mib = static_cast<double>(usage.ru_maxrss) / 1024.0;
    run.out = bytes_of(out);
    run.err = bytes_of(err);
    return run;
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "clshade-cli-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error("no temporary folder: " + name);
    }
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return bytes.str();
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

} // namespace clshade::tests
