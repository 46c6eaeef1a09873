// Binaries on disk, one file per program identity.
//
// A file is: magic, format version, identity, length of the payload, checksum of all that stands before it and of the
// payload, payload. It is written under a temporary name and renamed, so that readers see a whole file or none; any
// doubt means that the program is built again.
#include "host/base/hash.h"
#include "host/device/program.h"
#include "host/device/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace clshade {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic("CLSHADEB", 8);
constexpr std::uint32_t format_version = 1;
constexpr std::size_t identity_size = 32; ///< hexadecimal digits of hash_hex
constexpr std::size_t checksum_size = 32;
constexpr std::size_t head_size = magic.size() + sizeof(std::uint32_t) + identity_size + sizeof(std::uint64_t);

constexpr std::string_view entry_suffix = ".bin";
constexpr std::string_view temporary_prefix = ".new-";
constexpr std::size_t most_entries = 256;
constexpr std::uintmax_t most_bytes = std::uintmax_t{256} << 20;
constexpr auto temporary_life = std::chrono::hours(1); ///< older ones were left by a process that died

bool is_identity(std::string_view text) {
    return text.size() == identity_size && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

fs::path entry_path(const fs::path& folder, const std::string& identity) {
    return folder / (identity + std::string(entry_suffix));
}

template <class T>
void append(std::string& bytes, const T& value) {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes.append(raw.data(), raw.size());
}

std::string head_of(const std::string& identity, std::uint64_t length) {
    std::string head(magic);
    append(head, format_version);
    head += identity;
    append(head, length);
    return head;
}

std::string checksum_of(std::string_view head, std::string_view payload) {
    std::string both(head);
    both += payload;
    return hash_hex(std::string_view(both));
}

/// The payload of a whole file, or why it cannot be trusted.
struct Checked {
    std::string_view payload;
    std::string_view fault;
};

Checked check(std::string_view file, const std::string& identity) {
    if (file.size() < head_size + checksum_size) {
        return {{}, "it is cut short"};
    }
    const std::string_view payload = file.substr(head_size + checksum_size);
    // Compares magic, version, identity and length at once.
    if (file.substr(0, head_size) != head_of(identity, payload.size())) {
        return {{}, "its header is wrong"};
    }
    if (file.substr(head_size, checksum_size) != checksum_of(file.substr(0, head_size), payload)) {
        return {{}, "its checksum is wrong"};
    }
    return {payload, {}};
}

/// A file descriptor that is closed whatever happens.
class Descriptor {
  public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) {
            ::close(number_);
        }
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    Descriptor(Descriptor&&) = delete;
    Descriptor& operator=(Descriptor&&) = delete;

    [[nodiscard]] int number() const { return number_; }
    /// Closes now and tells whether that went well; a full disk may show only here.
    [[nodiscard]] bool close() {
        const int number = number_;
        number_ = -1;
        return ::close(number) == 0;
    }

  private:
    int number_;
};

[[noreturn]] void fail(const fs::path& path) {
    throw std::system_error(errno, std::generic_category(), path.string());
}

void write_all(int descriptor, std::string_view bytes, const fs::path& path) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            fail(path);
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

/// Makes the folder for this user alone; parents get the usual rights.
void make_folder(const fs::path& folder) {
    if (fs::is_directory(folder)) {
        return;
    }
    fs::create_directories(folder.parent_path());
    if (::mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
        fail(folder);
    }
}

/// Writes a new file of mode 0600 beside its final place and moves it there.
void write_and_rename(const fs::path& folder, const fs::path& final_path, std::string_view bytes) {
    std::string name = (folder / (std::string(temporary_prefix) + "XXXXXX")).string();
    Descriptor file(::mkostemp(name.data(), O_CLOEXEC));
    if (file.number() < 0) {
        fail(name);
    }
    try {
        write_all(file.number(), bytes, name);
        if (!file.close()) {
            fail(name);
        }
        fs::rename(name, final_path);
    } catch (...) {
        ::unlink(name.c_str());
        throw;
    }
}

struct Entry {
    fs::path path;
    fs::file_time_type time;
    std::uintmax_t size = 0;
};

/// Keeps the cache small: drops the entries used longest ago. Other processes may do the same at the same time, so a
/// file that is gone already is no fault.
void prune(const fs::path& folder, const fs::path& keep) {
    std::vector<Entry> entries;
    std::error_code failed;
    std::uintmax_t bytes = 0;
    const auto now = fs::file_time_type::clock::now();
    fs::directory_iterator item(folder, failed);
    for (; !failed && item != fs::directory_iterator(); item.increment(failed)) {
        std::error_code gone;
        const fs::path& path = item->path();
        const Entry entry{path, item->last_write_time(gone), gone ? 0 : item->file_size(gone)};
        if (gone) {
            continue;
        }
        if (path.filename().string().rfind(temporary_prefix, 0) == 0) {
            if (now - entry.time > temporary_life) {
                fs::remove(path, gone);
            }
        } else if (path.extension() == entry_suffix) {
            bytes += entry.size;
            if (path != keep) {
                entries.push_back(entry);
            }
        }
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
    std::size_t count = entries.size() + 1;
    for (const Entry& entry : entries) {
        if (count <= most_entries && bytes <= most_bytes) {
            break;
        }
        std::error_code gone;
        fs::remove(entry.path, gone);
        --count;
        bytes -= entry.size;
    }
}

/// An environment variable that holds an absolute path; anything else counts as unset (XDG base directories 0.8).
fs::path absolute_path_from(const char* variable) {
    const char* const value = std::getenv(variable);
    if (value == nullptr) {
        return {};
    }
    const fs::path path(value);
    return path.is_absolute() ? path : fs::path();
}

} // namespace

ProgramCache ProgramCache::standard() {
    if (const fs::path cache = absolute_path_from("XDG_CACHE_HOME"); !cache.empty()) {
        return ProgramCache(cache / "clshade");
    }
    if (const fs::path home = absolute_path_from("HOME"); !home.empty()) {
        return ProgramCache(home / ".cache" / "clshade");
    }
    return disabled();
}

ProgramCache ProgramCache::disabled() {
    return ProgramCache(fs::path());
}

std::optional<std::vector<std::byte>> ProgramCache::load(const std::string& identity) const {
    if (folder_.empty() || !is_identity(identity)) {
        return std::nullopt;
    }
    const fs::path path = entry_path(folder_, identity);
    std::error_code absent;
    const std::uintmax_t size = fs::file_size(path, absent);
    const bool huge = !absent && size > most_bytes; // never ours; not worth reading
    const auto file = huge ? std::string() : read_whole_file(path);
    if (!file) {
        return std::nullopt;
    }
    const Checked checked = check(*file, identity);
    if (!checked.fault.empty()) {
        spdlog::warn("kernel cache: {} is dropped, {}; the program is built again", path.string(),
                     huge ? "it is too large" : checked.fault);
        discard(identity);
        return std::nullopt;
    }
    std::error_code unimportant; // the time of last use only decides what is pruned first
    fs::last_write_time(path, fs::file_time_type::clock::now(), unimportant);
    const auto bytes = std::as_bytes(std::span(checked.payload));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

void ProgramCache::store(const std::string& identity, std::span<const std::byte> binary) const {
    if (folder_.empty() || !is_identity(identity)) {
        return;
    }
    const fs::path path = entry_path(folder_, identity);
    try {
        std::string payload(binary.size(), '\0');
        std::transform(binary.begin(), binary.end(), payload.begin(), [](std::byte b) { return static_cast<char>(b); });
        const std::string head = head_of(identity, payload.size());
        make_folder(folder_);
        write_and_rename(folder_, path, head + checksum_of(head, payload) + payload);
        prune(folder_, path);
    } catch (const std::exception& error) {
        spdlog::info("kernel cache: {} cannot be stored, the next start compiles again: {}", path.string(),
                     error.what());
    }
}

void ProgramCache::discard(const std::string& identity) const {
    if (folder_.empty() || !is_identity(identity)) {
        return;
    }
    std::error_code gone;
    fs::remove(entry_path(folder_, identity), gone);
}

} // namespace clshade
