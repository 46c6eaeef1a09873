#include "host/reference/surface.h"

#include "host/reference/fresnel.h"
#include "host/reference/layers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace clshade::reference {

namespace {

constexpr double far_depth = 6e4; // rule 3: depths from here on are background sentinels
constexpr double largest_shininess = 65536.0;
constexpr double unbounded = std::numeric_limits<double>::infinity();
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

/// Rules 3 and 6: a normal or tangent as stored, decoded.
glm::dvec3 decoded_vector(const Frame& frame, const std::array<PlaneIndex, 3>& planes, double coverage, int x, int y) {
    const glm::dvec3 stored = vector_at(frame, planes, x, y);
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

/// Rule 7: does a material claim a pixel whose id was rounded to `id`?
bool claims_id(const BoundMaterial& material, double id) {
    const auto same = [&](std::int64_t candidate) { return static_cast<double>(candidate) == id; };
    return std::any_of(material.ids.begin(), material.ids.end(), same);
}

bool claims_by_name(const Frame& frame, const BoundMaterial& material, int x, int y) {
    const auto same = [&](const CryptomatteClaim& claim) {
        return std::bit_cast<std::uint32_t>(frame.planes.at(claim.plane, x, y)) == claim.bits;
    };
    return std::any_of(material.cryptomatte.begin(), material.cryptomatte.end(), same);
}

/// Rule 7.
void find_material(const Frame& frame, int x, int y, Surface& surface) {
    std::optional<double> id;
    if (frame.roles.material_id != no_plane) {
        const double read = value_at(frame, frame.roles.material_id, x, y);
        id = std::nearbyint(read);
        surface.fractional_id = std::abs(read - *id) > 0.01;
    }
    for (std::size_t m = 0; m < frame.materials.size(); ++m) {
        const BoundMaterial& material = frame.materials[m];
        if ((id && claims_id(material, *id)) || claims_by_name(frame, material, x, y)) {
            surface.material = static_cast<int>(m);
            return;
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
    case Conversion::index_of_refraction:
        return f0_between(1.0, std::max(x, 1.0));
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

/// Reads the parameters of one material at one pixel, clamps them and remembers whether that changed anything.
class ParameterReader {
  public:
    ParameterReader(const Frame& frame, double coverage, int x, int y)
        : frame_(&frame), coverage_(coverage), x_(x), y_(y) {}

    [[nodiscard]] bool clamped() const { return clamped_; }

    glm::dvec3 in_range(const BoundParameter& parameter, double low, double high) {
        const glm::dvec3 value = read_parameter(*frame_, parameter, coverage_, x_, y_);
        for (int i = 0; i < 3; ++i) {
            clamped_ |= value[i] < low - clamp_slack || value[i] > high + clamp_slack;
        }
        return glm::clamp(value, low, high);
    }
    [[nodiscard]] double shininess(const BoundParameter& parameter) const {
        return std::clamp(read_parameter(*frame_, parameter, coverage_, x_, y_)[0], 0.0, largest_shininess);
    }
    /// t of rule 6 in world space.
    [[nodiscard]] glm::dvec3 tangent(const BoundParameter& parameter) const {
        if (parameter.is_constant()) {
            return parameter.constant;
        }
        const glm::dvec3 t = decoded_vector(*frame_, parameter.planes, coverage_, x_, y_);
        return frame_->normal_space == NormalSpace::camera ? frame_->view.camera_to_world * t : t;
    }

  private:
    const Frame* frame_;
    double coverage_;
    int x_;
    int y_;
    bool clamped_ = false;
};

glm::dvec3 indices_of(const glm::dvec3& f0) {
    return {index_of_f0(f0.x), index_of_f0(f0.y), index_of_f0(f0.z)};
}

void read_lobe(ParameterReader& reader, const BoundLayer& layer, const SpectralMetal& metal,
               const MetalAmbient* metal_ambient, LayerValues& values) {
    values.specular = layer.specular;
    switch (layer.specular) {
    case SpecularModel::none:
        return;
    case SpecularModel::blinn_phong:
    case SpecularModel::blinn_phong_exact:
        values.f0 = reader.in_range(layer.f0, 0.0, 1.0);
        values.shininess = reader.shininess(layer.shininess);
        break;
    case SpecularModel::blinn_phong_anisotropic:
        values.f0 = reader.in_range(layer.f0, 0.0, 1.0);
        values.shininess_u = reader.shininess(layer.shininess_u);
        values.shininess_v = reader.shininess(layer.shininess_v);
        values.tangent_read = reader.tangent(layer.tangent);
        break;
    case SpecularModel::blinn_phong_spectral:
        values.metal = &metal;
        values.metal_ambient = metal_ambient;
        values.f0 = metal.f0();
        values.shininess = reader.shininess(layer.shininess);
        break;
    }
    values.index = indices_of(values.f0);
}

void add_planes(const BoundParameter& parameter, std::vector<PlaneIndex>& planes) {
    planes.insert(planes.end(), parameter.planes.begin(), parameter.planes.end());
}

void add_planes(const BoundMaterial& material, std::vector<PlaneIndex>& planes) {
    for (const BoundLayer& layer : material.layers) {
        for (const BoundParameter* parameter :
             {&layer.f0, &layer.shininess, &layer.shininess_u, &layer.shininess_v, &layer.tangent, &layer.absorption}) {
            add_planes(*parameter, planes);
        }
    }
    add_planes(material.albedo, planes);
    add_planes(material.diffuse_shininess, planes);
    for (const CryptomatteClaim& claim : material.cryptomatte) {
        planes.push_back(claim.plane);
    }
}

} // namespace

bool uses_diffuse_shininess(DiffuseModel model) {
    return model != DiffuseModel::none && model != DiffuseModel::lambert;
}

std::vector<PlaneIndex> planes_to_be_finite(const Frame& frame) {
    std::vector<PlaneIndex> planes{frame.roles.coverage, frame.roles.material_id};
    planes.insert(planes.end(), frame.roles.normal.begin(), frame.roles.normal.end());
    planes.insert(planes.end(), frame.roles.position.begin(), frame.roles.position.end());
    for (const BoundMaterial& material : frame.materials) {
        add_planes(material, planes);
    }
    if (frame.has_emission) {
        add_planes(frame.emission, planes);
    }
    std::sort(planes.begin(), planes.end());
    planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
    if (planes.front() == no_plane) {
        planes.erase(planes.begin());
    }
    return planes;
}

PreparedFrame::PreparedFrame(const Frame& frame) : frame_(&frame), finite_planes_(planes_to_be_finite(frame)) {
    if (frame.environment) {
        environment_.emplace(*frame.environment);
    }
    for (const BoundMaterial& material : frame.materials) {
        std::vector<SpectralMetal>& metals = metals_.emplace_back();
        auto& ambients = metal_ambients_.emplace_back();
        for (const BoundLayer& layer : material.layers) {
            const bool spectral = layer.specular == SpecularModel::blinn_phong_spectral;
            metals.push_back(spectral ? SpectralMetal(layer.metal) : SpectralMetal());
            ambients.push_back(spectral && frame.environment ? std::make_shared<const MetalAmbient>(metals.back())
                                                             : nullptr);
        }
    }
}

bool all_finite(const PreparedFrame& prepared, int x, int y) {
    const Frame& frame = prepared.frame();
    const std::vector<PlaneIndex>& planes = prepared.finite_planes();
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

glm::dvec3 ray_direction(const Frame& frame, int x, int y) {
    return glm::normalize(pixel_ray(frame.view, x, y).direction);
}

std::optional<Surface> read_surface(const Frame& frame, int x, int y) {
    Surface surface;
    surface.coverage = read_coverage(frame, x, y);
    if (!(surface.coverage > 0.0) || (frame.roles.coverage == no_plane && is_far(frame, x, y))) {
        return std::nullopt;
    }
    const glm::dvec3 raw = decoded_vector(frame, frame.roles.normal, surface.coverage, x, y);
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

MaterialValues read_material(const PreparedFrame& prepared, const Surface& surface, int x, int y) {
    const auto index = static_cast<std::size_t>(surface.material);
    const BoundMaterial& material = prepared.frame().materials[index];
    ParameterReader reader(prepared.frame(), surface.coverage, x, y);
    MaterialValues values;
    values.fresnel = material.fresnel;
    values.absorption = material.absorption;
    values.absorption_ibl = material.absorption_ibl;
    values.transmittance_ibl = material.transmittance_ibl;
    values.ambient = material.ambient;
    values.diffuse = material.diffuse;
    values.resize(material.layers.size());
    for (std::size_t k = 0; k < material.layers.size(); ++k) {
        LayerValues& layer = values.layers()[k];
        read_lobe(reader, material.layers[k], prepared.metal(index, k), prepared.metal_ambient(index, k), layer);
        if (material.absorption != AbsorptionModel::none) {
            layer.absorption = reader.in_range(material.layers[k].absorption, 0.0, unbounded);
        }
    }
    if (material.diffuse != DiffuseModel::none) {
        values.albedo = reader.in_range(material.albedo, 0.0, 1.0);
    }
    if (uses_diffuse_shininess(material.diffuse)) {
        values.diffuse_shininess = reader.shininess(material.diffuse_shininess);
    }
    values.clamped = reader.clamped();
    find_tangents(values, surface.normal);
    find_interfaces(values);
    return values;
}

void find_tangents(MaterialValues& material, const glm::dvec3& normal) {
    for (LayerValues& layer : material.layers()) {
        if (layer.specular == SpecularModel::blinn_phong_anisotropic) {
            layer.frame = tangent_frame(layer.tangent_read, normal);
            material.no_tangent |= layer.frame.missing;
        }
    }
}

glm::dvec3 read_emission(const Frame& frame, const Surface& surface, int x, int y) {
    if (!frame.has_emission) {
        return glm::dvec3(0.0);
    }
    return glm::max(read_parameter(frame, frame.emission, surface.coverage, x, y), glm::dvec3(0.0));
}

} // namespace clshade::reference
