#include "host/images/image_reader.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace clshade {

void read_planes(const std::filesystem::path& path, const ImageLayout& layout, FramePlan& plan, int threads) {
    const auto most = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    tbb::task_arena arena(std::clamp(threads, 1, static_cast<int>(most)));
    arena.execute([&] { PlaneReader(path, layout, plan.channels, plan.frame.data_window).read(0, plan.frame.planes); });
}

} // namespace clshade
