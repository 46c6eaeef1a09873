#include "host/device/build_lock.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

namespace clshade {

namespace {

using namespace std::chrono_literals;
constexpr auto longest_wait = 60s;
constexpr auto between_tries = 10ms;

/// A lock of the process, not of the descriptor: that is why a process does not wait for itself.
bool try_lock(int descriptor) {
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    return ::fcntl(descriptor, F_SETLK, &lock) == 0;
}

} // namespace

BuildLock::BuildLock(const std::filesystem::path& folder, const std::string& identity) {
    if (folder.empty()) {
        return;
    }
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    file_ = folder / (identity + ".lock");
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    const auto start = std::chrono::steady_clock::now();
    while (descriptor_ >= 0 && !try_lock(descriptor_)) {
        if ((errno != EAGAIN && errno != EACCES) || std::chrono::steady_clock::now() - start > longest_wait) {
            spdlog::info("kernel cache: no lock on {}; building without", file_.string());
            ::close(descriptor_);
            descriptor_ = -1;
            return;
        }
        std::this_thread::sleep_for(between_tries);
    }
}

// Whoever waited for the file has it open still and comes next; what it wants is in the cache by now.
BuildLock::~BuildLock() {
    if (descriptor_ >= 0) {
        ::unlink(file_.c_str());
        ::close(descriptor_);
    }
}

} // namespace clshade
