#include "host/batch/memory.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace clshade {

std::uint64_t resident_memory() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t all = 0;
    std::uint64_t resident = 0;
    statm >> all >> resident;
    return statm ? resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

std::uint64_t machine_memory() {
    std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();
    const long pages = sysconf(_SC_PHYS_PAGES);
    if (pages > 0) {
        memory = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    }
    // Containers and Slurm limit a job by its control group; "max" does not parse and means no limit.
    for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        std::ifstream stream(file);
        std::uint64_t limit = 0;
        if (stream >> limit && limit > 0) {
            memory = std::min(memory, limit);
        }
    }
    return memory;
}

std::uint64_t band_memory(int width, int planes_read, int planes_written, int rows) {
    const std::uint64_t pitch = (static_cast<std::uint64_t>(width) + row_alignment - 1) / row_alignment * row_alignment;
    const auto planes = static_cast<std::uint64_t>(planes_read) + 2 * static_cast<std::uint64_t>(planes_written);
    return pitch * static_cast<std::uint64_t>(rows) * planes * sizeof(float);
}

std::uint64_t frame_memory(const FramePlan& plan, int outputs) {
    const Window& window = plan.frame.data_window;
    return band_memory(window.width(), static_cast<int>(plan.channels.size()),
                       outputs + static_cast<int>(plan.keep.size()), window.height());
}

} // namespace clshade
