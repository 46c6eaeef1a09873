#include "host/cli/environment_file.h"

#include "host/images/environment_file.h"

namespace clshade::cli {

EnvironmentFile read_environment_file(const std::filesystem::path& path, std::uint64_t max_memory, bool whole) {
    EnvironmentFile file;
    if (is_filtered_set(path)) {
        file.maps = read_filtered_set(path);
    } else {
        file.image = read_lat_long(path, max_memory, whole);
    }
    return file;
}

} // namespace clshade::cli
