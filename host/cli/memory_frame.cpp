#include "host/cli/memory_frame.h"

#include "host/gbuffer/frame_builder.h"
#include "host/gbuffer/roles.h"

#include <algorithm>
#include <utility>

namespace clshade::cli {

Frame frame_from_planes(const PlaneSlab& planes, std::span<const std::string> names, const Scene& scene,
                        const std::string& name) {
    ImageLayout layout;
    layout.file = name;
    layout.display_window = {0, 0, planes.width() - 1, planes.height() - 1};
    PartInfo part;
    part.data_window = layout.display_window;
    part.compression = "none";
    layout.parts = {part};
    for (const std::string& channel : names) {
        layout.channels.push_back(
            {.name = channel, .file_name = channel, .part = 0, .view = {}, .type = SampleType::float32});
    }
    FramePlan plan = plan_frame(layout, assign_roles(layout, scene.gbuffer, {}), scene);
    allocate_planes(plan);
    PlaneSlab& wanted = plan.frame.planes;
    for (std::size_t i = 0; i < plan.channels.size(); ++i) {
        for (int y = 0; y < planes.height(); ++y) {
            const auto source = planes.row(plan.channels[i], y);
            std::copy(source.begin(), source.end(), wanted.row(static_cast<int>(i), y).begin());
        }
    }
    return finish_frame(std::move(plan));
}

} // namespace clshade::cli
