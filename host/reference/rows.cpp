#include "host/reference/rows.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace clshade::reference {

void for_each_row(int height, int threads, const std::function<void(int)>& shade_row) {
    tbb::task_arena arena(std::clamp(threads, 1, std::max(tbb::info::default_concurrency(), 1)));
    arena.execute([&] { tbb::parallel_for(0, height, shade_row); });
}

} // namespace clshade::reference
