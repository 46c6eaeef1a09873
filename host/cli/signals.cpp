#include "host/cli/signals.h"

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
#include <ctime>

namespace clshade::cli {

namespace {

// A signal handler can reach nothing but statics: the temporary of the text file being written, or null.
std::atomic<const char*> text_temporary{nullptr};
static_assert(std::atomic<const char*>::is_always_lock_free);

// The signal that a run was asked to stop by (0: none), whether a run stops by itself, and the clock of its grace.
std::atomic<int> stop_signal{0};
std::atomic<bool> graceful{false};
std::atomic<timer_t> grace{};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<timer_t>::is_always_lock_free);
constexpr long grace_nanoseconds = 800'000'000;

ExitCode exit_code_of(int signal) {
    return signal == SIGINT ? ExitCode::interrupted : ExitCode::terminated;
}

// Only async-signal-safe calls in these.
extern "C" void discard_and_exit(int signal) {
#ifdef CLSHADE_IMAGES
    remove_temporaries();
#endif
    if (const char* path = text_temporary.load(); path != nullptr) {
        unlink(path);
    }
    _exit(static_cast<int>(exit_code_of(signal)));
}

extern "C" void stop_or_exit(int signal) {
    int none = 0;
    if (!graceful.load() || !stop_signal.compare_exchange_strong(none, signal)) {
        discard_and_exit(signal);
    }
    itimerspec after{};
    after.it_value.tv_nsec = grace_nanoseconds;
    timer_settime(grace.load(), 0, &after, nullptr);
}

extern "C" void end_of_grace(int /*signal*/) {
    discard_and_exit(stop_signal.load());
}

void handle(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART; // a run that stops by itself must not fail in a read
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
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
    handle(SIGINT, stop_or_exit);
    handle(SIGTERM, stop_or_exit);
}

GracefulStop::GracefulStop() {
    handle(SIGALRM, end_of_grace);
    sigevent event{};
    event.sigev_notify = SIGEV_SIGNAL;
    event.sigev_signo = SIGALRM;
    timer_t timer{};
    // Without a clock the first signal ends the process at once.
    if (timer_create(CLOCK_MONOTONIC, &event, &timer) == 0) {
        grace = timer;
        graceful = true;
    }
}

GracefulStop::~GracefulStop() {
    if (graceful.exchange(false)) {
        timer_delete(grace.load());
    }
}

bool GracefulStop::requested() const noexcept {
    return stop_signal.load(std::memory_order_relaxed) != 0;
}

ExitCode GracefulStop::exit_code() const noexcept {
    return requested() ? exit_code_of(stop_signal.load()) : ExitCode::ok;
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
