#include "host/cli/pixel_survey.h"

#include "host/base/error.h"
#include "host/gbuffer/frame_builder.h"
#include "host/images/image_reader.h"
#include "host/scene/frame_camera.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace clshade::cli {

namespace {

Window united(const Window& a, const Window& b) {
    return {std::min(a.x_min, b.x_min), std::min(a.y_min, b.y_min), std::max(a.x_max, b.x_max),
            std::max(a.y_max, b.y_max)};
}

// A plan that reads the channels of some roles and nothing else, with no scene bound to it.
class RolePlan {
  public:
    RolePlan(const ImageLayout& layout, const RoleAssignment& roles) : layout_(layout), roles_(roles) {}

    // The role's planes; no_plane where the file lacks it.
    std::vector<PlaneIndex> add(Role role) {
        std::vector<PlaneIndex> planes;
        for (const int channel : roles_[role].channels) {
            planes.push_back(static_cast<PlaneIndex>(plan_.channels.size()));
            plan_.channels.push_back(channel);
            plan_.frame.plane_names.push_back(layout_.channels[static_cast<std::size_t>(channel)].name);
        }
        return planes;
    }

    Frame read(const std::filesystem::path& file, int threads) {
        Frame& frame = plan_.frame;
        frame.file = file.string();
        frame.display_window = layout_.display_window;
        frame.pixel_aspect = layout_.pixel_aspect;
        frame.data_window = window();
        allocate_planes(plan_);
        read_planes(file, layout_, plan_, threads);
        return std::move(frame);
    }

    [[nodiscard]] Window window() const {
        std::optional<Window> all;
        for (const int channel : plan_.channels) {
            const int part = layout_.channels[static_cast<std::size_t>(channel)].part;
            const Window& one = layout_.parts[static_cast<std::size_t>(part)].data_window;
            all = all ? united(*all, one) : one;
        }
        return all.value_or(layout_.display_window);
    }

  private:
    const ImageLayout& layout_;
    const RoleAssignment& roles_;
    FramePlan plan_;
};

PlaneIndex single(const std::vector<PlaneIndex>& planes) {
    return planes.empty() ? no_plane : planes.front();
}

void assign_three(std::array<PlaneIndex, 3>& target, const std::vector<PlaneIndex>& planes) {
    if (planes.size() == target.size()) {
        std::copy(planes.begin(), planes.end(), target.begin());
    }
}

Frame read_geometry(const std::filesystem::path& file, const ImageLayout& layout, const RoleAssignment& roles,
                    int threads) {
    RolePlan plan(layout, roles);
    RolePlanes planes;
    assign_three(planes.position, plan.add(Role::position));
    assign_three(planes.normal, plan.add(Role::normal));
    planes.depth = single(plan.add(Role::depth));
    planes.coverage = single(plan.add(Role::coverage));
    Frame frame = plan.read(file, threads);
    frame.roles = planes;
    return frame;
}

Window window_of(const ImageLayout& layout) {
    return layout.parts.empty() ? layout.display_window : layout.parts.front().data_window;
}

} // namespace

CameraSurvey survey_camera(const std::filesystem::path& file, const ImageLayout& layout, const RoleAssignment& roles,
                           const Scene& scene, int threads) {
    CameraSurvey survey;
    survey.source = "none";
    std::optional<Frame> frame;
    if (roles.has(Role::position)) {
        frame = read_geometry(file, layout, roles, threads);
    }
    const Window window = frame ? frame->data_window : window_of(layout);
    try {
        // Throws where only frames of a sequence have cameras: a single file does not tell which it is.
        if (const std::optional<Camera> camera = camera_of_frame(scene, std::nullopt)) {
            survey.view = view_from_camera(*camera, window, layout.display_window, layout.pixel_aspect);
            survey.source = "[camera] of " + (scene.file.empty() ? "--set" : scene.file);
        } else if (const std::optional<View> header = view_from_header(layout, window)) {
            survey.view = header;
            survey.source = "worldToCamera in the header";
        } else if (frame) {
            survey.fitted = recover_view(*frame);
            survey.view = survey.fitted->view;
            survey.source = "recovered from the position plane";
        } else {
            survey.trouble = "no worldToCamera in the header and no position plane; `shade` needs [camera] in a scene";
        }
    } catch (const Error& error) {
        survey.trouble = error.what();
    }
    if (frame && survey.view) {
        frame->view = *survey.view;
        survey.residual_px = reprojection_error(*frame);
    }
    return survey;
}

IdSurvey survey_ids(const std::filesystem::path& file, const ImageLayout& layout, const RoleAssignment& roles,
                    int threads) {
    constexpr double whole_tolerance = 0.01; // as in the pixel rules
    constexpr double largest_exact = 9.0e15; // beyond, a double holds no fractions and an int64 soon overflows
    RolePlan plan(layout, roles);
    const PlaneIndex plane = single(plan.add(Role::material_id));
    const Frame frame = plan.read(file, threads);
    IdSurvey survey;
    for (int y = 0; y < frame.planes.height(); ++y) {
        for (const float value : frame.planes.row(plane, y)) {
            const double id = static_cast<double>(value);
            if (!(std::abs(id) < largest_exact)) {
                ++survey.nonfinite;
            } else if (std::abs(id - std::round(id)) > whole_tolerance) {
                ++survey.fractional;
            } else {
                ++survey.pixels[std::llround(id)];
            }
        }
    }
    return survey;
}

} // namespace clshade::cli
