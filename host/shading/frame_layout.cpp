#include "host/shading/frame_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace clshade {

namespace {

bool has_light(const Frame& frame, LightType type) {
    return std::any_of(frame.lights.begin(), frame.lights.end(),
                       [type](const Light& light) { return light.type == type; });
}

void add_parameter(std::set<PlaneIndex>& planes, const BoundParameter& parameter) {
    planes.insert(parameter.planes.begin(), parameter.planes.end());
}

} // namespace

std::vector<PlaneIndex> planes_read(const Frame& frame) {
    std::set<PlaneIndex> planes(frame.roles.normal.begin(), frame.roles.normal.end());
    planes.insert(frame.roles.position.begin(), frame.roles.position.end());
    planes.insert({frame.roles.depth, frame.roles.coverage, frame.roles.material_id});
    for (const BoundMaterial& material : frame.materials) {
        for (const BoundLayer& layer : material.layers) {
            for (const BoundParameter* parameter : {&layer.f0, &layer.shininess, &layer.shininess_u, &layer.shininess_v,
                                                    &layer.tangent, &layer.absorption}) {
                add_parameter(planes, *parameter);
            }
        }
        add_parameter(planes, material.albedo);
        add_parameter(planes, material.diffuse_shininess);
        for (const CryptomatteClaim& claim : material.cryptomatte) {
            planes.insert(claim.plane);
        }
    }
    if (frame.has_emission) {
        add_parameter(planes, frame.emission);
    }
    planes.erase(no_plane);
    return {planes.begin(), planes.end()};
}

std::string frame_layout_source(const Frame& frame, const AovSelection& aovs) {
    const RolePlanes& roles = frame.roles;
    std::string text =
        "// Written by clshade for one structure of frame; see kernels/frame_layout.h for what it means.\n"
        "#ifndef CLSHADE_FRAME_LAYOUT_H\n#define CLSHADE_FRAME_LAYOUT_H\n\n";
    const auto define = [&text](std::string_view name, int value) {
        text += fmt::format("#define {} {}\n", name, value);
    };
    define("PLANE_NORMAL_X", roles.normal[0]);
    define("PLANE_NORMAL_Y", roles.normal[1]);
    define("PLANE_NORMAL_Z", roles.normal[2]);
    define("PLANE_POSITION_X", roles.position[0]);
    define("PLANE_POSITION_Y", roles.position[1]);
    define("PLANE_POSITION_Z", roles.position[2]);
    define("PLANE_DEPTH", roles.depth);
    define("PLANE_COVERAGE", roles.coverage);
    define("PLANE_MATERIAL_ID", roles.material_id);
    text += "#define FOR_EACH_CHECKED_PLANE(X)";
    for (const PlaneIndex plane : planes_read(frame)) {
        if (plane != roles.depth) {
            text += fmt::format(" X({})", plane);
        }
    }
    text += "\n\n";
    define("NORMAL_IN_CAMERA_SPACE", frame.normal_space == NormalSpace::camera ? 1 : 0);
    define("NORMAL_IS_UNORM", frame.normal_encoding == NormalEncoding::unorm ? 1 : 0);
    define("DEPTH_IS_RAY_LENGTH", frame.depth_kind == DepthKind::ray ? 1 : 0);
    define("VIEW_IS_ORTHOGRAPHIC", frame.view.orthographic ? 1 : 0);
    define("VIEW_HAS_RAYS", frame.view.has_rays ? 1 : 0);
    text += "\n";
    define("HAS_POINT_LIGHTS", has_light(frame, LightType::point) ? 1 : 0);
    define("HAS_SPOT_LIGHTS", has_light(frame, LightType::spot) ? 1 : 0);
    text += "\n#define AMBIENT_SH2 0\n#define AMBIENT_SH3 1\n#define AMBIENT_MAP 2\n";
    define("HAS_ENVIRONMENT", frame.environment ? 1 : 0);
    define("AMBIENT_SOURCE", frame.environment ? static_cast<int>(frame.environment->diffuse) : 0);
    define("HAS_BACKGROUND", frame.environment && frame.environment->background ? 1 : 0);
    text += "\n";
    int next = 4; // after R, G, B, A; the order of output_plane_names
    const auto define_output = [&](std::string_view name, bool wanted, int planes) {
        define(name, wanted && planes > 0 ? next : no_plane);
        next += wanted ? planes : 0;
    };
    define_output("OUTPUT_DIFFUSE", aovs.diffuse, 3);
    define_output("OUTPUT_SPECULAR", aovs.specular, 3);
    define_output("OUTPUT_LIGHTS", aovs.lights, 3 * static_cast<int>(frame.lights.size()));
    define_output("OUTPUT_ENVIRONMENT", aovs.environment && frame.environment, 3);
    return text + "\n#endif\n";
}

std::string kernel_key(const Frame& frame) {
    std::string key = "shade.";
    if (frame.materials.size() == 1) {
        key += model_key(frame.materials[0]);
    } else {
        key += fmt::format("mixed{}", frame.materials.size());
    }
    std::vector<std::string> lights;
    constexpr std::array<std::pair<LightType, std::string_view>, 3> types = {
        {{LightType::distant, "distant"}, {LightType::point, "point"}, {LightType::spot, "spot"}}};
    for (const auto& [type, name] : types) {
        const auto count = std::count_if(frame.lights.begin(), frame.lights.end(),
                                         [wanted = type](const Light& light) { return light.type == wanted; });
        if (count > 0) {
            lights.push_back(fmt::format("{}{}", name, count));
        }
    }
    if (frame.environment) {
        lights.emplace_back("environment");
    }
    return fmt::format("{}.{}", key, lights.empty() ? "unlit" : fmt::format("{}", fmt::join(lights, "_")));
}

} // namespace clshade
