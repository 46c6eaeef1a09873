#include "host/images/temporary_file.h"

#include "host/base/error.h"
#include "host/images/image_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <system_error>

namespace clshade {

namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 20;

// A signal handler can reach nothing but statics, may not lock, and may call little more than unlink. So the names of
// the temporaries stand in a fixed table. A name is written while its slot is `claimed`, and read while `active`.
enum class SlotState : int { free, claimed, active };
struct Slot {
    std::atomic<SlotState> state{SlotState::free};
    std::array<char, PATH_MAX> path{};
};
static_assert(std::atomic<SlotState>::is_always_lock_free);
constexpr int slot_count = 64; // files written at the same time; one per frame worker
std::array<Slot, slot_count> slots;
std::atomic<unsigned> next_number{0};

/// Returns the slot, or -1 when all are taken or the path is too long.
int register_temporary(const std::string& path) {
    if (path.size() >= PATH_MAX) {
        return -1;
    }
    for (int i = 0; i < slot_count; ++i) {
        Slot& slot = slots[static_cast<std::size_t>(i)];
        SlotState expected = SlotState::free;
        if (slot.state.compare_exchange_strong(expected, SlotState::claimed)) {
            std::memcpy(slot.path.data(), path.c_str(), path.size() + 1);
            slot.state.store(SlotState::active);
            return i;
        }
    }
    return -1;
}

void forget_temporary(int slot) {
    if (slot >= 0) {
        slots[static_cast<std::size_t>(slot)].state.store(SlotState::free);
    }
}

/// Where the bytes shall lie in the end: renaming onto a link would replace the link, not the file.
std::filesystem::path followed(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::is_symlink(file, error)) {
        std::filesystem::path real = std::filesystem::weakly_canonical(file, error);
        if (!error) {
            return real;
        }
    }
    return file;
}

} // namespace

void remove_temporaries() noexcept {
    for (const Slot& slot : slots) {
        if (slot.state.load() == SlotState::active) {
            ::unlink(slot.path.data());
        }
    }
}

TemporaryFile::TemporaryFile(const std::filesystem::path& target) : target_(target), final_(followed(target)) {
    // Long names are cut: a file's name has at most 255 bytes.
    const std::string name = final_.filename().string().substr(0, 200);
    const std::filesystem::path folder = final_.parent_path();
    buffer_.reserve(buffer_size);
    for (int attempt = 0; attempt < 100; ++attempt) {
        path_ = folder / fmt::format(".{}.{}-{}.tmp", name, ::getpid(), next_number++);
        slot_ = register_temporary(path_.string());
        if (slot_ < 0) {
            throw RuntimeFailure(
                fmt::format("{}: cannot be written: too many files at once or too long a path; use fewer workers",
                            target_.string()));
        }
        descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ >= 0) {
            return;
        }
        const int error = errno;
        forget_temporary(slot_);
        slot_ = -1;
        if (error != EEXIST) { // left behind by a process of the same number that was killed
            fail(error);
        }
    }
    fail(EEXIST);
}

TemporaryFile::~TemporaryFile() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
    if (slot_ >= 0) {
        ::unlink(path_.c_str());
        forget_temporary(slot_);
    }
}

void TemporaryFile::fail(int error) const {
    const char* advice = "check the folder";
    if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
        advice = "free some space";
    } else if (error == EACCES || error == EPERM || error == EROFS) {
        advice = "check the permissions";
    }
    throw RuntimeFailure(fmt::format("{}: cannot be written: {}; {}", target_.string(), std::strerror(error), advice));
}

void TemporaryFile::write_out(std::span<const std::byte> bytes) {
    if (error_ != 0) {
        fail(error_);
    }
    while (!bytes.empty()) {
        const ssize_t done = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(flushed_));
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            error_ = done < 0 ? errno : ENOSPC;
            fail(error_);
        }
        flushed_ += static_cast<std::uint64_t>(done);
        bytes = bytes.subspan(static_cast<std::size_t>(done));
    }
}

void TemporaryFile::flush() {
    write_out(buffer_);
    buffer_.clear();
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
    if (buffer_.size() + bytes.size() > buffer_size) {
        flush();
    }
    if (bytes.size() >= buffer_size) {
        write_out(bytes);
        return;
    }
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

void TemporaryFile::seek(std::uint64_t offset) {
    flush();
    flushed_ = offset;
}

void TemporaryFile::close() {
    flush();
    // File systems that know no such thing as forcing (EINVAL, ENOSYS) have done what they can.
    if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOSYS && errno != EROFS) {
        fail(errno);
    }
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0 && errno != EINTR) {
        fail(errno);
    }
}

void TemporaryFile::commit() {
    if (::rename(path_.c_str(), final_.c_str()) != 0) {
        fail(errno);
    }
    forget_temporary(slot_);
    slot_ = -1;
}

} // namespace clshade
