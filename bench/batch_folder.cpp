#include "bench/batch_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>

namespace clshade {

namespace {

constexpr std::array<const char*, 3> kinds{"in", "ours", "theirs"};

std::vector<std::string> names_of(int frames) {
    std::vector<std::string> names;
    for (const char* const kind : kinds) {
        for (int frame = 1; frame <= frames; ++frame) {
            names.push_back(fmt::format("{}.{:04}.exr", kind, frame));
        }
    }
    return names;
}

} // namespace

BatchFolder::BatchFolder(int frames) : BatchFolder(names_of(frames)) {}

BatchFolder::BatchFolder(std::vector<std::string> names)
    : folder_(std::filesystem::temp_directory_path() / "clshade-bench", names) {
    const std::array<std::vector<std::filesystem::path>*, 3> lists{&inputs_, &ours_, &theirs_};
    const std::size_t frames = names.size() / lists.size();
    for (std::size_t i = 0; i < names.size(); ++i) {
        lists.at(i / frames)->push_back(folder_.path() / names[i]);
    }
}

void BatchFolder::settle() const {
    const int descriptor = ::open(folder_.path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
        ::syncfs(descriptor); // failing only costs accuracy
        ::close(descriptor);
    }
}

} // namespace clshade
