// Files and folders that appear under their real names only when they are whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace clshade {

/// Writes to ".<name>.<pid>-<n>.tmp" in the folder of the target (of what the target links to), buffered. Removed by
/// the destructor, or by remove_temporaries() on a signal, unless committed. Every failure is a RuntimeFailure that
/// names the target and the system's reason.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::filesystem::path& target);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    TemporaryFile(TemporaryFile&&) = delete;
    TemporaryFile& operator=(TemporaryFile&&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    void write(std::span<const std::byte> bytes);
    [[nodiscard]] std::uint64_t position() const { return flushed_ + buffer_.size(); }
    /// The next write goes to this offset.
    void seek(std::uint64_t offset);
    /// Flushes, forces the data to the medium and closes. Repeats the failure of any earlier write, even one whose
    /// exception was swallowed by a library.
    void close();
    /// Renames to the target, which it replaces. Call after close().
    void commit();
    /// The same, unless something has the target's name: false then. Atomic, whoever else tries.
    [[nodiscard]] bool commit_new();

  private:
    void flush();
    void committed();
    void write_out(std::span<const std::byte> bytes);
    [[noreturn]] void fail(int error) const;

    std::filesystem::path target_; ///< as named by the user, for messages
    std::filesystem::path final_;  ///< symbolic links followed
    std::filesystem::path path_;
    int slot_ = -1; ///< entry in the table of remove_temporaries()
    int descriptor_ = -1;
    int error_ = 0; ///< errno of the first failed write
    std::uint64_t flushed_ = 0;
    std::vector<std::byte> buffer_;
};

/// A folder ".<name>.<pid>-<n>.tmp" beside the target, for a set of files of the given names. Removed with them by the
/// destructor, or by remove_temporaries() on a signal, unless committed. Failures as above.
class StagedFolder {
  public:
    StagedFolder(const std::filesystem::path& target, std::span<const std::string> names);
    ~StagedFolder();
    StagedFolder(const StagedFolder&) = delete;
    StagedFolder& operator=(const StagedFolder&) = delete;
    StagedFolder(StagedFolder&&) = delete;
    StagedFolder& operator=(StagedFolder&&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Puts the folder in the target's place, in one step. A folder that stands there must hold no file but some of the
    /// given names: it is removed.
    void commit();

  private:
    void remove() noexcept;
    [[noreturn]] void fail(int error) const;

    std::filesystem::path target_; ///< as named by the user, for messages
    std::filesystem::path final_;  ///< symbolic links followed
    std::filesystem::path path_;
    std::vector<std::string> files_; ///< full names in path_
    std::vector<int> slots_;         ///< of the folder and of its files
};

} // namespace clshade
