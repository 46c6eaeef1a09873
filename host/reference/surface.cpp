#include "host/reference/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace clshade::reference {

namespace {

constexpr double far_depth = 6e4; // rule 3: depths from here on are background sentinels
constexpr double largest_shininess = 65536.0;
constexpr double clamp_slack = 1e-3; // rule 6: rounding beyond 0..1 that is not worth a warning

double value_at(const Frame& frame, PlaneIndex plane, int x, int y) {
    return static_cast<double>(frame.planes.at(plane, x, y));
}

glm::dvec3 vector_at(const Frame& frame, const std::array<PlaneIndex, 3>& planes, int x, int y) {
    return {value_at(frame, planes[0], x, y), value_at(frame, planes[1], x, y), value_at(frame, planes[2], x, y)};
}

bool is_far(const Frame& frame, int x, int y) {
    return frame.roles.depth != no_plane && value_at(frame, frame.roles.depth, x, y) >= far_depth;
}

struct Ray {
    glm::dvec3 origin;
    glm::dvec3 direction; ///< direction . view_axis = 1
};

Ray pixel_ray(const View& view, int x, int y) {
    const double px = x + 0.5;
    const double py = y + 0.5;
    return {view.origin + px * view.origin_dx + py * view.origin_dy,
            view.direction + px * view.direction_dx + py * view.direction_dy};
}

/// Rule 2.
double read_coverage(const Frame& frame, int x, int y) {
    return frame.roles.coverage == no_plane ? 1.0 : std::clamp(value_at(frame, frame.roles.coverage, x, y), 0.0, 1.0);
}

/// Rule 3, first half: the normal as stored, decoded.
glm::dvec3 raw_normal(const Frame& frame, double coverage, int x, int y) {
    const glm::dvec3 stored = vector_at(frame, frame.roles.normal, x, y);
    return frame.normal_encoding == NormalEncoding::unorm ? 2.0 * (stored / coverage) - 1.0 : stored;
}

/// Rule 5: the position plane, where it can be believed.
std::optional<glm::dvec3> stored_position(const Frame& frame, int x, int y) {
    if (frame.roles.position[0] == no_plane || is_far(frame, x, y)) {
        return std::nullopt;
    }
    const glm::dvec3 position = vector_at(frame, frame.roles.position, x, y);
    if (frame.view.has_rays && frame.roles.depth == no_plane && position == glm::dvec3(0.0)) {
        return std::nullopt;
    }
    return position;
}

/// Rule 5: the position from depth, sentinels included (a light is practically absent there).
std::optional<glm::dvec3> position_of_depth(const Frame& frame, int x, int y) {
    if (frame.roles.depth == no_plane || !frame.view.has_rays) {
        return std::nullopt;
    }
    const double depth = value_at(frame, frame.roles.depth, x, y);
    if (std::isinf(depth)) {
        return std::nullopt;
    }
    const Ray ray = pixel_ray(frame.view, x, y);
    return ray.origin + depth * (frame.depth_kind == DepthKind::planar ? ray.direction : glm::normalize(ray.direction));
}

/// Rule 5: E.
glm::dvec3 eye_vector(const Frame& frame, const std::optional<glm::dvec3>& position, int x, int y) {
    const View& view = frame.view;
    if (view.orthographic) {
        return -glm::normalize(view.view_axis);
    }
    if (position && *position != view.eye) {
        return glm::normalize(view.eye - *position);
    }
    return view.has_rays ? -glm::normalize(pixel_ray(view, x, y).direction) : -glm::normalize(view.view_axis);
}

/// Rule 7.
void find_material(const Frame& frame, int x, int y, Surface& surface) {
    if (frame.roles.material_id == no_plane) {
        return;
    }
    const double id = value_at(frame, frame.roles.material_id, x, y);
    const double whole = std::nearbyint(id);
    surface.fractional_id = std::abs(id - whole) > 0.01;
    for (std::size_t m = 0; m < frame.materials.size(); ++m) {
        for (const std::int64_t candidate : frame.materials[m].ids) {
            if (static_cast<double>(candidate) == whole) {
                surface.material = static_cast<int>(m);
                return;
            }
        }
    }
}

/// Rule 6: conversions. Division by zero gives infinity, which the clamp turns into the upper end.
double converted(double x, Conversion convert) {
    switch (convert) {
    case Conversion::none:
        return x;
    case Conversion::ggx_roughness:
        return 2.0 / std::pow(x, 4.0) - 2.0;
    case Conversion::smoothness:
        return converted(1.0 - x, Conversion::ggx_roughness);
    case Conversion::oren_nayar_sigma:
        return 2.0 / (x * x);
    }
    return x;
}

/// Rule 6 before clamping.
glm::dvec3 read_parameter(const Frame& frame, const BoundParameter& parameter, double coverage, int x, int y) {
    glm::dvec3 value = parameter.constant;
    if (!parameter.is_constant()) {
        value = vector_at(frame, parameter.planes, x, y);
        if (parameter.averaged) {
            value /= coverage;
        }
        value = value * parameter.scale + parameter.offset;
    }
    for (int i = 0; i < 3; ++i) {
        value[i] = converted(value[i], parameter.convert);
    }
    return value;
}

} // namespace

bool uses_diffuse_shininess(DiffuseModel model) {
    return model != DiffuseModel::none && model != DiffuseModel::lambert;
}

std::vector<PlaneIndex> planes_to_be_finite(const Frame& frame) {
    std::vector<PlaneIndex> planes;
    const auto add = [&](PlaneIndex plane) {
        if (plane != no_plane) {
            planes.push_back(plane);
        }
    };
    const auto add_parameter = [&](const BoundParameter& parameter) {
        std::for_each(parameter.planes.begin(), parameter.planes.end(), add);
    };
    std::for_each(frame.roles.normal.begin(), frame.roles.normal.end(), add);
    std::for_each(frame.roles.position.begin(), frame.roles.position.end(), add);
    add(frame.roles.coverage);
    add(frame.roles.material_id);
    for (const BoundMaterial& material : frame.materials) {
        add_parameter(material.f0);
        add_parameter(material.shininess);
        add_parameter(material.albedo);
        add_parameter(material.diffuse_shininess);
    }
    if (frame.has_emission) {
        add_parameter(frame.emission);
    }
    std::sort(planes.begin(), planes.end());
    planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
    return planes;
}

bool all_finite(const Frame& frame, const std::vector<PlaneIndex>& planes, int x, int y) {
    const auto finite = [&](PlaneIndex plane) { return std::isfinite(frame.planes.at(plane, x, y)); };
    if (!std::all_of(planes.begin(), planes.end(), finite)) {
        return false;
    }
    const glm::dvec3 normal = vector_at(frame, frame.roles.normal, x, y);
    if (glm::dot(normal, normal) > static_cast<double>(std::numeric_limits<float>::max())) {
        return false;
    }
    if (frame.roles.depth == no_plane) {
        return true;
    }
    const double depth = value_at(frame, frame.roles.depth, x, y);
    return std::isfinite(depth) || depth > 0.0; // NaN compares false
}

std::optional<Surface> read_surface(const Frame& frame, int x, int y) {
    Surface surface;
    surface.coverage = read_coverage(frame, x, y);
    if (!(surface.coverage > 0.0) || (frame.roles.coverage == no_plane && is_far(frame, x, y))) {
        return std::nullopt;
    }
    const glm::dvec3 raw = raw_normal(frame, surface.coverage, x, y);
    if (!(glm::length(raw) >= 1e-6)) {
        return std::nullopt;
    }
    surface.normal = glm::normalize(raw);
    if (frame.normal_space == NormalSpace::camera) { // rule 4
        surface.normal = glm::normalize(frame.view.camera_to_world * surface.normal);
    }
    const std::optional<glm::dvec3> stored = stored_position(frame, x, y);
    surface.eye = eye_vector(frame, stored, x, y);
    surface.position = stored ? stored : position_of_depth(frame, x, y);
    surface.position_from_depth = !stored && surface.position;
    find_material(frame, x, y, surface);
    return surface;
}

MaterialValues read_material(const Frame& frame, const Surface& surface, int x, int y) {
    const BoundMaterial& material = frame.materials[static_cast<std::size_t>(surface.material)];
    MaterialValues values;
    values.specular = material.specular;
    values.diffuse = material.diffuse;
    const auto unit_interval = [&](const BoundParameter& parameter) {
        const glm::dvec3 value = read_parameter(frame, parameter, surface.coverage, x, y);
        for (int i = 0; i < 3; ++i) {
            values.clamped |= value[i] < -clamp_slack || value[i] > 1.0 + clamp_slack;
        }
        return glm::clamp(value, 0.0, 1.0);
    };
    const auto shininess = [&](const BoundParameter& parameter) {
        return std::clamp(read_parameter(frame, parameter, surface.coverage, x, y)[0], 0.0, largest_shininess);
    };
    if (material.specular != SpecularModel::none) {
        values.f0 = unit_interval(material.f0);
        values.shininess = shininess(material.shininess);
    }
    if (material.diffuse != DiffuseModel::none) {
        values.albedo = unit_interval(material.albedo);
    }
    if (uses_diffuse_shininess(material.diffuse)) {
        values.diffuse_shininess = shininess(material.diffuse_shininess);
    }
    return values;
}

glm::dvec3 read_emission(const Frame& frame, const Surface& surface, int x, int y) {
    if (!frame.has_emission) {
        return glm::dvec3(0.0);
    }
    return glm::max(read_parameter(frame, frame.emission, surface.coverage, x, y), glm::dvec3(0.0));
}

} // namespace clshade::reference
