// The files of the binary cache: whole or absent, whatever happens to them.
#include "host/device/program.h"
#include "host/device/whole_file.h"
#include "tests/device/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace clshade {
namespace {

namespace fs = std::filesystem;
using tests::TemporaryFolder;

const std::string identity = "0123456789abcdef0123456789abcdef";
const std::string other_identity = "ffffffffffffffffffffffffffffffff";

std::vector<std::byte> payload(std::size_t size, unsigned seed = 1) {
    std::vector<std::byte> bytes(size);
    for (std::size_t i = 0; i < size; ++i) {
        bytes[i] = static_cast<std::byte>(i * 31 + seed);
    }
    return bytes;
}

std::string content(const fs::path& path) {
    return read_whole_file(path).value_or("");
}

void overwrite(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        files.push_back(entry.path());
    }
    return files;
}

class ProgramCacheTest : public ::testing::Test {
  protected:
    TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path() / "deep" / "clshade";
    ProgramCache cache_{folder_};

    fs::path only_file() const {
        const auto files = files_in(folder_);
        EXPECT_EQ(files.size(), 1U);
        return files.at(0);
    }
};

TEST_F(ProgramCacheTest, GivesBackWhatWasStored) {
    EXPECT_FALSE(cache_.load(identity));
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{100000}}) {
        cache_.store(identity, payload(size));
        const auto loaded = cache_.load(identity);
        ASSERT_TRUE(loaded);
        EXPECT_EQ(*loaded, payload(size));
    }
    EXPECT_FALSE(cache_.load(other_identity));
    cache_.discard(identity);
    EXPECT_FALSE(cache_.load(identity));
    cache_.discard(identity);
}

TEST_F(ProgramCacheTest, BelongsToTheUserAlone) {
    cache_.store(identity, payload(10));
    struct stat status {};
    ASSERT_EQ(::stat(folder_.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0700U);
    ASSERT_EQ(::stat(only_file().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(ProgramCacheTest, AnyFlippedBitIsSeenAndTheFileRemoved) {
    cache_.store(identity, payload(40));
    const fs::path path = only_file();
    const std::string whole = content(path);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const char bit : {'\x01', '\x80'}) {
            std::string damaged = whole;
            damaged[i] = static_cast<char>(damaged[i] ^ bit);
            overwrite(path, damaged);
            ASSERT_FALSE(cache_.load(identity)) << "byte " << i;
            ASSERT_FALSE(fs::exists(path)) << "byte " << i;
        }
    }
    overwrite(path, whole);
    EXPECT_TRUE(cache_.load(identity));
}

TEST_F(ProgramCacheTest, AnyCutOrGrownFileIsSeen) {
    cache_.store(identity, payload(40));
    const fs::path path = only_file();
    const std::string whole = content(path);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        overwrite(path, whole.substr(0, size));
        ASSERT_FALSE(cache_.load(identity)) << size << " bytes";
        ASSERT_FALSE(fs::exists(path));
    }
    overwrite(path, whole + "x");
    EXPECT_FALSE(cache_.load(identity));
}

TEST_F(ProgramCacheTest, HugeFilesAndPipesAreNotRead) {
    cache_.store(identity, payload(40));
    fs::resize_file(only_file(), std::uintmax_t{1} << 40); // sparse
    EXPECT_FALSE(cache_.load(identity));
    EXPECT_TRUE(files_in(folder_).empty());
    ASSERT_EQ(::mkfifo((folder_ / (identity + ".bin")).c_str(), 0600), 0);
    EXPECT_FALSE(cache_.load(identity));
    cache_.store(identity, payload(40));
    EXPECT_TRUE(cache_.load(identity));
}

TEST_F(ProgramCacheTest, DoubtIsLoggedInOneLineThatNamesTheFile) {
    cache_.store(identity, payload(40));
    const std::string path = only_file().string();
    overwrite(path, "nonsense");
    ::testing::internal::CaptureStdout(); // where spdlog writes unless told otherwise
    EXPECT_FALSE(cache_.load(identity));
    EXPECT_FALSE(cache_.load(identity)); // absent by now: nothing to say
    const std::string log = ::testing::internal::GetCapturedStdout();
    EXPECT_THAT(log, ::testing::HasSubstr(path));
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1) << log;
}

TEST_F(ProgramCacheTest, FileOfAnotherProgramIsSeen) {
    cache_.store(identity, payload(40));
    const fs::path path = only_file();
    const fs::path wrong = folder_ / (other_identity + path.extension().string());
    fs::rename(path, wrong);
    EXPECT_FALSE(cache_.load(other_identity));
    EXPECT_FALSE(fs::exists(wrong));
}

TEST_F(ProgramCacheTest, UnwritableFolderIsNoError) {
    const fs::path file = temporary_.path() / "file";
    overwrite(file, "not a folder");
    const ProgramCache below_file(file / "clshade"); // fails for root too, unlike a read-only folder
    below_file.store(identity, payload(10));
    EXPECT_FALSE(below_file.load(identity));
    const ProgramCache is_file(file);
    is_file.store(identity, payload(10));
    EXPECT_FALSE(is_file.load(identity));
    EXPECT_EQ(content(file), "not a folder");
    if (::geteuid() != 0) {
        fs::create_directories(folder_);
        fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
        cache_.store(identity, payload(10));
        EXPECT_TRUE(files_in(folder_).empty());
        fs::permissions(folder_, fs::perms::owner_all);
    }
}

TEST_F(ProgramCacheTest, FolderInPlaceOfAFileIsNoError) {
    fs::create_directories(folder_ / (identity + ".bin") / "inside");
    EXPECT_FALSE(cache_.load(identity));
    cache_.store(identity, payload(10));
    EXPECT_FALSE(cache_.load(identity));
    EXPECT_EQ(files_in(folder_).size(), 1U) << "a temporary file was left";
}

TEST_F(ProgramCacheTest, OddIdentitiesNeverBecomePaths) {
    for (const char* const odd : {"", "../../etc/passwd", "0123456789abcdef0123456789abcde/", "short"}) {
        cache_.store(odd, payload(10));
        EXPECT_FALSE(cache_.load(odd));
        cache_.discard(odd);
    }
    EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(ProgramCacheTest, DisabledDoesNothing) {
    const ProgramCache off = ProgramCache::disabled();
    off.store(identity, payload(10));
    EXPECT_FALSE(off.load(identity));
    off.discard(identity);
    EXPECT_TRUE(off.folder().empty());
}

std::string numbered(std::size_t number) {
    std::string text = std::to_string(number);
    return std::string(32 - text.size(), '0') + text;
}

TEST_F(ProgramCacheTest, StaysSmallAndForgetsTheOldest) {
    using std::chrono::hours;
    const auto now = fs::file_time_type::clock::now();
    constexpr std::size_t most = 256;
    for (std::size_t i = 0; i < most; ++i) {
        cache_.store(numbered(i), payload(10));
        fs::last_write_time(folder_ / (numbered(i) + ".bin"), now - hours(most - i));
    }
    ASSERT_TRUE(cache_.load(numbered(0))); // used just now: no longer the oldest
    overwrite(folder_ / ".new-dead00", "left by a process that died");
    fs::last_write_time(folder_ / ".new-dead00", now - hours(2));
    overwrite(folder_ / ".new-alive0", "being written by another process");
    overwrite(folder_ / "unrelated.txt", "not ours");
    cache_.store(identity, payload(10));
    EXPECT_TRUE(fs::exists(folder_ / (identity + ".bin")));
    EXPECT_TRUE(fs::exists(folder_ / (numbered(0) + ".bin")));
    EXPECT_FALSE(fs::exists(folder_ / (numbered(1) + ".bin")));
    EXPECT_TRUE(fs::exists(folder_ / (numbered(2) + ".bin")));
    EXPECT_FALSE(fs::exists(folder_ / ".new-dead00"));
    EXPECT_TRUE(fs::exists(folder_ / ".new-alive0"));
    EXPECT_TRUE(fs::exists(folder_ / "unrelated.txt"));
}

TEST_F(ProgramCacheTest, ReadersSeeOneOfTheWritersWhole) {
    constexpr std::size_t size = 50000;
    cache_.store(identity, payload(size, 0));
    std::vector<std::thread> writers;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        writers.emplace_back([this, seed] {
            for (int i = 0; i < 100; ++i) {
                cache_.store(identity, payload(size, seed));
            }
        });
    }
    int whole = 0;
    constexpr int reads = 300;
    for (int i = 0; i < reads; ++i) {
        const auto loaded = cache_.load(identity);
        if (loaded && *loaded == payload(size, static_cast<unsigned>(loaded->at(0)))) {
            ++whole;
        }
    }
    for (std::thread& writer : writers) {
        writer.join();
    }
    EXPECT_EQ(whole, reads);
    EXPECT_EQ(files_in(folder_).size(), 1U);
}

/// Sets an environment variable (nullptr: removes it) until the end of the scope.
class ScopedVariable {
  public:
    ScopedVariable(const char* name, const char* value) : name_(name) {
        if (const char* const old = std::getenv(name)) {
            old_ = old;
        }
        set(value);
    }
    ~ScopedVariable() { set(old_ ? old_->c_str() : nullptr); }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;
    ScopedVariable(ScopedVariable&&) = delete;
    ScopedVariable& operator=(ScopedVariable&&) = delete;

  private:
    void set(const char* value) {
        if (value != nullptr) {
            ::setenv(name_, value, 1);
        } else {
            ::unsetenv(name_);
        }
    }
    const char* name_;
    std::optional<std::string> old_;
};

TEST(StandardFolder, FollowsTheXdgRules) {
    const ScopedVariable home("HOME", "/home/someone");
    {
        const ScopedVariable xdg("XDG_CACHE_HOME", "/var/cache/someone");
        EXPECT_EQ(ProgramCache::standard().folder(), "/var/cache/someone/clshade");
    }
    for (const char* const unusable : {"relative/cache", "", static_cast<const char*>(nullptr)}) {
        const ScopedVariable xdg("XDG_CACHE_HOME", unusable);
        EXPECT_EQ(ProgramCache::standard().folder(), "/home/someone/.cache/clshade");
        const ScopedVariable no_home("HOME", nullptr);
        EXPECT_TRUE(ProgramCache::standard().folder().empty());
    }
}

} // namespace
} // namespace clshade
