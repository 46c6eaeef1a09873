#include "host/base/error.h"
#include "host/images/image_writer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace clshade {

void check_output_path(const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    std::error_code error;
    const std::string name = file.string();
    const fs::file_status status = fs::status(file, error);
    if (fs::is_directory(status)) {
        throw RuntimeFailure(fmt::format("{}: is a folder; name a file in it", name));
    }
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        throw RuntimeFailure(
            fmt::format("{}: is not a regular file and cannot be replaced by an image; name another file", name));
    }
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension != ".exr" && extension != ".png") {
        throw UsageError(fmt::format("{}: unknown kind of output '{}'; use .exr, or .png for a preview", name,
                                     file.extension().string()));
    }
    const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
    const fs::file_status folder_status = fs::status(folder, error);
    if (!fs::exists(folder_status)) {
        throw RuntimeFailure(fmt::format("{}: the folder {} does not exist; create it first", name, folder.string()));
    }
    if (!fs::is_directory(folder_status)) {
        throw RuntimeFailure(fmt::format("{}: {} is not a folder; name another file", name, folder.string()));
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0) {
        throw RuntimeFailure(fmt::format("{}: the folder {} cannot be written ({}); check its permissions", name,
                                         folder.string(), std::strerror(errno)));
    }
    if (fs::exists(status) && ::access(file.c_str(), W_OK) != 0) {
        throw RuntimeFailure(
            fmt::format("{}: cannot be replaced ({}); check its permissions", name, std::strerror(errno)));
    }
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) noexcept {
    std::error_code error;
    return std::filesystem::equivalent(a, b, error) && !error;
}

} // namespace clshade
