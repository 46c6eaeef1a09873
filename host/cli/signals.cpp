#include "host/cli/signals.h"

#include "host/base/error.h"
#ifdef CLSHADE_IMAGES
#include "host/images/image_writer.h"
#endif

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace clshade::cli {

namespace {

// A signal handler can reach nothing but statics: the temporary of the text file being written, or null.
std::atomic<const char*> text_temporary{nullptr};
static_assert(std::atomic<const char*>::is_always_lock_free);

// Only async-signal-safe calls in here.
extern "C" void discard_and_exit(int signal) {
#ifdef CLSHADE_IMAGES
    remove_temporaries();
#endif
    if (const char* path = text_temporary.load(); path != nullptr) {
        unlink(path);
    }
    _exit(static_cast<int>(signal == SIGINT ? ExitCode::interrupted : ExitCode::terminated));
}

// Writes everything or says why not (errno).
int write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = write(descriptor, text.data(), text.size());
        if (written < 0 && errno != EINTR) {
            return errno;
        }
        text.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
    }
    return fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno; // pipes and the like cannot be synced
}

template <class Fail>
void write_in_place(const std::filesystem::path& file, std::string_view text, const Fail& fail) {
    const int descriptor = open(file.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) {
        fail(errno);
    }
    const int error = write_all(descriptor, text);
    close(descriptor);
    if (error != 0) {
        fail(error);
    }
}

} // namespace

void install_signal_handlers() {
    struct sigaction action {};
    action.sa_handler = discard_and_exit;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
    const auto fail = [&](int error) {
        throw RuntimeFailure(fmt::format("{}: cannot write: {}", file.string(), std::strerror(error)));
    };
    std::error_code ignored;
    if (std::filesystem::is_character_file(file, ignored) || std::filesystem::is_fifo(file, ignored)) {
        write_in_place(file, text, fail); // /dev/stdout and the like must not be replaced
        return;
    }
    const std::string temporary = fmt::format("{}.{}.tmp", file.string(), getpid());
    text_temporary = temporary.c_str();
    const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        const int error = errno;
        text_temporary = nullptr;
        fail(error);
    }
    int error = write_all(descriptor, text);
    if (close(descriptor) != 0 && error == 0) {
        error = errno;
    }
    if (error == 0 && rename(temporary.c_str(), file.c_str()) != 0) {
        error = errno;
    }
    if (error != 0) {
        unlink(temporary.c_str());
    }
    text_temporary = nullptr;
    if (error != 0) {
        fail(error);
    }
}

} // namespace clshade::cli
