#include "host/images/temporary_file.h"

#include "host/base/error.h"
#include "host/images/image_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>
#include <set>
#include <string_view>
#include <system_error>

namespace clshade {

namespace {

/// Longer pieces go straight to the file.
constexpr std::size_t buffer_size = std::size_t{1} << 17U;

// A signal handler can reach nothing but statics, may not lock, and may call little more than unlink. So the names of
// the temporaries stand in a fixed table. A name is written while its slot is `claimed`, and read while `active`.
enum class SlotState : int { free, claimed, active };
struct Slot {
    std::atomic<SlotState> state{SlotState::free};
    std::array<char, PATH_MAX> path{};
};
static_assert(std::atomic<SlotState>::is_always_lock_free);
constexpr int slot_count = 64; // one per frame worker, and those of a folder
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

[[noreturn]] void fail_writing(const std::filesystem::path& target, int error) {
    const char* advice = "check the folder";
    if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
        advice = "free some space";
    } else if (error == EACCES || error == EPERM || error == EROFS) {
        advice = "check the permissions";
    }
    throw RuntimeFailure(fmt::format("{}: cannot be written: {}; {}", target.string(), std::strerror(error), advice));
}

[[noreturn]] void fail_crowded(const std::filesystem::path& target) {
    throw RuntimeFailure(fmt::format(
        "{}: cannot be written: too many files at once or too long a path; use fewer workers", target.string()));
}

/// What a temporary's name begins with, up to the process's number.
std::string temporary_prefix(const std::filesystem::path& file) {
    return fmt::format(".{}.", file.filename().string().substr(0, 200));
}

/// A name that nobody else uses beside `file`. Long names are cut: a file's name has at most 255 bytes.
std::filesystem::path name_beside(const std::filesystem::path& file) {
    return file.parent_path() / fmt::format("{}{}-{}.tmp", temporary_prefix(file), ::getpid(), next_number++);
}

/// Locks a temporary for as long as this process has it open: that is how others tell it from one whose writer was
/// killed. False: somebody took it for such a one before the lock was there, and has removed it. File systems without
/// locks go without.
bool lock_own(int descriptor) {
    static_cast<void>(::flock(descriptor, LOCK_EX | LOCK_NB));
    struct stat info {};
    return ::fstat(descriptor, &info) != 0 || info.st_nlink > 0;
}

/// Removes a temporary unless its writer lives.
void remove_if_stale(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW); // NFS locks no readers
    if (descriptor < 0) {
        return;
    }
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
        ::unlink(file.c_str());
    }
    ::close(descriptor);
}

/// "<pid>-<n>.tmp"
bool is_temporary_suffix(std::string_view text) {
    constexpr std::string_view end = ".tmp";
    if (!text.ends_with(end)) {
        return false;
    }
    text.remove_suffix(end.size());
    const std::size_t dash = text.find('-');
    const auto is_number = [](std::string_view digits) {
        return !digits.empty() && digits.find_first_not_of("0123456789") == std::string_view::npos;
    };
    return dash != std::string_view::npos && is_number(text.substr(0, dash)) && is_number(text.substr(dash + 1));
}

/// Where the bytes shall lie in the end: renaming onto a link would replace the link, not the file. The file need not
/// be there yet.
std::filesystem::path followed(const std::filesystem::path& file) {
    constexpr int most_links = 40; // as in Linux
    std::error_code error;
    std::filesystem::path real = file;
    for (int i = 0; i < most_links && std::filesystem::is_symlink(real, error); ++i) {
        const std::filesystem::path next = std::filesystem::read_symlink(real, error);
        if (error) {
            break;
        }
        real = real.parent_path() / next; // an absolute one stands alone
    }
    return real;
}

} // namespace

void remove_temporaries() noexcept {
    for (const Slot& slot : slots) {
        if (slot.state.load() == SlotState::active) {
            ::unlink(slot.path.data());
        }
    }
    for (const Slot& slot : slots) { // folders, empty by now
        if (slot.state.load() == SlotState::active) {
            ::rmdir(slot.path.data());
        }
    }
}

void remove_stale_temporaries(std::span<const std::filesystem::path> targets) noexcept {
    try {
        std::map<std::filesystem::path, std::set<std::string>> prefixes; // by folder
        for (const std::filesystem::path& target : targets) {
            const std::filesystem::path real = followed(target);
            prefixes[real.has_parent_path() ? real.parent_path() : "."].insert(temporary_prefix(real));
        }
        for (const auto& [folder, wanted] : prefixes) {
            std::error_code error;
            for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
                const std::string name = it->path().filename().string();
                const std::size_t dash = name.rfind('-');
                const std::size_t dot = dash == std::string::npos ? dash : name.rfind('.', dash);
                if (dot != std::string::npos && wanted.contains(name.substr(0, dot + 1)) &&
                    is_temporary_suffix(std::string_view(name).substr(dot + 1))) {
                    remove_if_stale(it->path());
                }
            }
        }
    } catch (const std::exception&) { // NOLINT(bugprone-empty-catch): a tidy folder is a wish
    }
}

TemporaryFile::TemporaryFile(const std::filesystem::path& target) : target_(target), final_(followed(target)) {
    buffer_.reserve(buffer_size);
    for (int attempt = 0; attempt < 100; ++attempt) {
        path_ = name_beside(final_);
        slot_ = register_temporary(path_.string());
        if (slot_ < 0) {
            fail_crowded(target_);
        }
        descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ >= 0 && lock_own(descriptor_)) {
            return;
        }
        const int error = descriptor_ >= 0 ? EEXIST : errno;
        if (descriptor_ >= 0) {
            ::close(descriptor_);
            descriptor_ = -1;
        }
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
    fail_writing(target_, error);
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

void TemporaryFile::committed() {
    forget_temporary(slot_);
    slot_ = -1;
}

void TemporaryFile::commit() {
    if (::rename(path_.c_str(), final_.c_str()) != 0) {
        fail(errno);
    }
    committed();
}

bool TemporaryFile::commit_new() {
    if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, final_.c_str(), RENAME_NOREPLACE) == 0) {
        committed();
        return true;
    }
    if (errno == EEXIST) {
        return false;
    }
    if (errno != EINVAL && errno != ENOSYS) {
        fail(errno);
    }
    // A file system that cannot (NFS): a second name, which must not exist. The destructor removes the first one.
    if (::link(path_.c_str(), final_.c_str()) == 0) {
        return true;
    }
    if (errno == EEXIST) {
        return false;
    }
    // One that knows no second names (FAT): an empty file holds the place.
    const int place = ::open(final_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (place < 0) {
        if (errno == EEXIST) {
            return false;
        }
        fail(errno);
    }
    ::close(place);
    commit();
    return true;
}

StagedFolder::StagedFolder(const std::filesystem::path& target, std::span<const std::string> names)
    : target_(target), final_(followed(target)) {
    int error = EEXIST;
    for (int attempt = 0; attempt < 100 && error == EEXIST; ++attempt) {
        path_ = name_beside(final_);
        slots_.assign(1, register_temporary(path_.string()));
        if (slots_[0] < 0) {
            fail_crowded(target_);
        }
        error = ::mkdir(path_.c_str(), 0777) == 0 ? 0 : errno;
        if (error != 0) {
            forget_temporary(slots_[0]);
        }
    }
    if (error != 0) {
        fail(error);
    }
    for (const std::string& name : names) {
        files_.push_back((path_ / name).string());
        slots_.push_back(register_temporary(files_.back()));
        if (slots_.back() < 0) {
            remove();
            fail_crowded(target_);
        }
    }
}

StagedFolder::~StagedFolder() {
    remove();
}

void StagedFolder::remove() noexcept {
    if (slots_.empty()) {
        return;
    }
    for (const std::string& file : files_) {
        ::unlink(file.c_str());
    }
    ::rmdir(path_.c_str());
    for (const int slot : slots_) {
        forget_temporary(slot);
    }
    slots_.clear();
}

void StagedFolder::fail(int error) const {
    fail_writing(target_, error);
}

void StagedFolder::commit() {
    // Replaces nothing, or an empty folder.
    if (::rename(path_.c_str(), final_.c_str()) == 0) {
        for (const int slot : slots_) {
            forget_temporary(slot);
        }
        slots_.clear();
        return;
    }
    // The set that stands there and the new one change places, and what then is the temporary is removed.
    if (errno != ENOTEMPTY && errno != EEXIST) {
        fail(errno);
    }
    if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, final_.c_str(), RENAME_EXCHANGE) != 0) {
        fail(errno);
    }
    remove();
}

} // namespace clshade
