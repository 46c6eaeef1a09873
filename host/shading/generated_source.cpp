#include "host/shading/generated_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

namespace clshade {

namespace {

bool has_light(const Frame& frame, LightType type) {
    return std::any_of(frame.lights.begin(), frame.lights.end(),
                       [type](const Light& light) { return light.type == type; });
}

/// What a diffuse model is called in kernels/diffuse.cl.
struct DiffuseCode {
    std::string_view terms_type; ///< empty: the model has no terms
    std::string_view terms_function;
    std::string_view value; ///< expression for one light
};

DiffuseCode code_of(DiffuseModel model) {
    switch (model) {
    case DiffuseModel::none:
        return {"", "", "splat(0.0f)"};
    case DiffuseModel::lambert:
        return {"", "", "lambert(i)"};
    case DiffuseModel::oren_nayar:
        return {"oren_nayar_terms", "oren_nayar_terms_of", "oren_nayar(i, s, terms)"};
    case DiffuseModel::oren_nayar_full:
        return {"oren_nayar_full_terms", "oren_nayar_full_terms_of", "oren_nayar_full(i, s, terms)"};
    case DiffuseModel::oren_nayar_qualitative:
        return {"oren_nayar_terms", "oren_nayar_qualitative_terms_of", "oren_nayar_qualitative(i, s, terms)"};
    case DiffuseModel::oren_nayar_simplified_1:
        return {"oren_nayar_terms", "oren_nayar_qualitative_terms_of", "oren_nayar_simplified_1(i, s, terms)"};
    case DiffuseModel::oren_nayar_simplified_2:
        return {"oren_nayar_terms", "oren_nayar_qualitative_terms_of", "oren_nayar_simplified_2(i, s, terms)"};
    case DiffuseModel::oren_nayar_shininess:
        return {"oren_nayar_terms", "oren_nayar_shininess_terms_of", "oren_nayar_simplified_2(i, s, terms)"};
    }
    return {};
}

/// One component of a parameter, up to and including its conversion. `field` is the C expression of its constants.
std::string component(const Frame& frame, const BoundParameter& parameter, int index, const std::string& field) {
    if (parameter.is_constant()) {
        return fmt::format("splat({}.value[{}])", field, index);
    }
    std::string value = fmt::format("load_input(in, {})", parameter.planes[static_cast<std::size_t>(index)]);
    if (parameter.averaged && frame.roles.coverage != no_plane) {
        value = fmt::format("averaged({}, s)", value);
    }
    if (parameter.scale != 1.0 || parameter.offset != 0.0) {
        value = fmt::format("scaled({}, &{})", value, field);
    }
    switch (parameter.convert) {
    case Conversion::none:
        return value;
    case Conversion::ggx_roughness:
        return fmt::format("shininess_from_ggx_roughness({})", value);
    case Conversion::smoothness:
        return fmt::format("shininess_from_smoothness({})", value);
    case Conversion::oren_nayar_sigma:
        return fmt::format("shininess_from_oren_nayar_sigma({})", value);
    }
    return value;
}

std::string colour(const Frame& frame, const BoundParameter& parameter, const std::string& field) {
    if (parameter.is_constant()) {
        return fmt::format("constant_rgb(&{})", field);
    }
    if (parameter.is_grey()) {
        return fmt::format("grey({})", component(frame, parameter, 0, field));
    }
    return fmt::format("make_rgb({},\n        {},\n        {})", component(frame, parameter, 0, field),
                       component(frame, parameter, 1, field), component(frame, parameter, 2, field));
}

/// A material's name as it may stand in a comment.
std::string comment_text(const std::string& name) {
    std::string text;
    for (const char c : name) {
        text += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == ' ' ? c : '?';
    }
    return text;
}

/// The lines that read one colour and clamp it; what was out of range goes into `clamped`.
std::string read_colour(const Frame& frame, const BoundParameter& parameter, const std::string& name,
                        std::vector<std::string>& clamped) {
    const std::string value = colour(frame, parameter, "m->" + name);
    if (parameter.is_constant()) {
        return fmt::format("    const rgb {} = {};\n", name, value);
    }
    clamped.push_back(fmt::format("outside_unit(raw_{})", name));
    return fmt::format("    const rgb raw_{0} = {1};\n    const rgb {0} = clamp_unit_rgb(raw_{0});\n", name, value);
}

std::string read_shininess(const Frame& frame, const BoundParameter& parameter, const std::string& name) {
    return fmt::format("    const real {} = clamp_shininess({});\n", name,
                       component(frame, parameter, 0, "m->" + name));
}

/// One sum over the lights: its field of light_sums and the name of the value that is added.
struct Share {
    std::string_view field;
    std::string_view value;
};

std::string add_shares(const std::vector<Share>& shares, std::string_view sums) {
    std::string text;
    for (const Share& share : shares) {
        text += fmt::format("        {0}.{1} = add_share({0}.{1}, e0, {2});\n", sums, share.field, share.value);
    }
    return text;
}

/// What a material reads before its loop over the lights, and which parameters to watch for being out of range.
std::string read_parameters(const Frame& frame, const BoundMaterial& material, std::vector<std::string>& clamped) {
    std::string text;
    if (material.specular != SpecularModel::none) {
        text += read_colour(frame, material.f0, "f0", clamped);
        text += read_shininess(frame, material.shininess, "shininess");
        text += "    const real half_shininess = 0.5f * shininess;\n";
    } else {
        text += "    const rgb f0 = grey(splat(0.0f));\n";
    }
    if (material.diffuse != DiffuseModel::none) {
        text += read_colour(frame, material.albedo, "albedo", clamped);
        const DiffuseCode code = code_of(material.diffuse);
        if (!code.terms_type.empty()) {
            text += read_shininess(frame, material.diffuse_shininess, "diffuse_shininess");
            text += fmt::format("    const {} terms = {}(diffuse_shininess);\n", code.terms_type, code.terms_function);
        }
    } else {
        text += "    const rgb albedo = grey(splat(0.0f));\n";
    }
    text += material.specular == SpecularModel::none
                ? "    const rgb colour = scale_rgb(albedo, INV_PI_F);\n"
                : "    const rgb colour = scale_rgb(multiply_rgb(albedo, complement(f0)), INV_PI_F);\n";
    return text;
}

/// The body of the loop over the lights up to the values to be summed.
std::string evaluate_light(const BoundMaterial& material, std::vector<Share>& shares) {
    const bool exact = material.specular == SpecularModel::blinn_phong_exact;
    const std::string_view weight = exact ? " * diffuse_weight_exact(i)" : "";
    const std::string_view value = code_of(material.diffuse).value;
    std::string text;
    if (material.diffuse == DiffuseModel::oren_nayar_full) {
        text += fmt::format("        const oren_nayar_full_value both = {};\n", value);
        text += fmt::format("        const real diffuse = both.first{};\n", weight);
        text += fmt::format("        const real square = both.second{};\n", weight);
        shares = {{"diffuse", "diffuse"}, {"square", "square"}};
    } else if (material.diffuse != DiffuseModel::none) {
        text += fmt::format("        const real diffuse = {}{};\n", value, weight);
        shares = {{"diffuse", "diffuse"}};
    }
    if (material.specular != SpecularModel::none) {
        text += "        const real specular = blinn_phong(i, half_shininess);\n";
        text += fmt::format("        const real weighted = specular * {}(i);\n",
                            exact ? "schlick_weight" : "schlick_weight_gaussian");
        shares.push_back({"specular", "specular"});
        shares.push_back({"weighted", "weighted"});
    }
    return text;
}

std::string_view normaliser_of(SpecularModel model) {
    switch (model) {
    case SpecularModel::none:
        return "splat(0.0f)";
    case SpecularModel::blinn_phong:
        return "normaliser_linear(shininess)";
    case SpecularModel::blinn_phong_exact:
        return "normaliser_exact(shininess)";
    }
    return {};
}

std::string material_function(const Frame& frame, std::size_t index) {
    const BoundMaterial& material = frame.materials[index];
    std::vector<std::string> clamped;
    std::vector<Share> shares;
    const std::string setup = read_parameters(frame, material, clamped);
    const std::string light = evaluate_light(material, shares);
    const std::string_view normaliser = normaliser_of(material.specular);

    std::string text = fmt::format("// Material {}, \"{}\": {} over {}.\n", index, comment_text(material.name),
                                   name_of(material.specular), name_of(material.diffuse));
    text += fmt::format("static inline radiance shade_material_{}(inputs in, surface s, mask mine, results out,\n"
                        "                                        __constant const MaterialConstants* m,\n"
                        "                                        __global const LightConstants* lights,\n"
                        "                                        int light_count) {{\n",
                        index);
    text += setup;
    text += "\n    light_sums sums = no_light();\n"
            "    for (int k = 0; k < light_count; ++k) {\n"
            "        const incidence i = incidence_of(s, lights + k);\n"
            "        const rgb e0 = irradiance(lights + k, i);\n";
    text += light + add_shares(shares, "sums");
    text += "#if OUTPUT_LIGHTS >= 0\n        light_sums own = no_light();\n" + add_shares(shares, "own");
    text += fmt::format("        store_light(out, mine, s, k, reflect(own, colour, albedo, f0, {}));\n#endif\n    }}\n",
                        normaliser);
    text += fmt::format("    radiance sum = reflect(sums, colour, albedo, f0, {});\n", normaliser);
    if (!clamped.empty()) {
        text += fmt::format("    sum.clamped = {};\n", fmt::join(clamped, " | "));
    }
    return text + "    return sum;\n}\n\n";
}

std::string claim(const BoundMaterial& material) {
    std::vector<std::string> tests;
    for (const std::int64_t id : material.ids) {
        tests.push_back(fmt::format("has_id(id, {}.0f)", id));
    }
    return fmt::format("s.alive & ({})", fmt::join(tests, " | "));
}

/// Which material each pixel goes to: those with ids in turn, the first for what is left.
std::string material_choice(const Frame& frame) {
    std::string text =
        "static inline radiance shade_materials(inputs in, surface s, results out,\n"
        "                                       __constant const MaterialConstants* materials,\n"
        "                                       __global const LightConstants* lights, int light_count) {\n";
    if (frame.roles.material_id == no_plane || frame.materials.size() == 1) {
        return text + "    return shade_material_0(in, s, s.alive, out, materials, lights, light_count);\n}\n\n";
    }
    text += "    const real id = load_input(in, PLANE_MATERIAL_ID);\n";
    text += "    mask rest = s.alive;\n";
    text += "    radiance sum = no_radiance();\n";
    for (std::size_t k = 1; k < frame.materials.size(); ++k) {
        text += fmt::format("    const mask mine_{0} = {1};\n"
                            "    rest = rest & negated(mine_{0});\n"
                            "    if (any_lane(mine_{0})) {{\n"
                            "        sum = choose_radiance(mine_{0}, shade_material_{0}(in, s, mine_{0}, out, "
                            "materials + {0}, lights, light_count), sum);\n"
                            "    }}\n",
                            k, claim(frame.materials[k]));
    }
    text += "    if (any_lane(rest)) {\n"
            "        sum = choose_radiance(rest, shade_material_0(in, s, rest, out, materials, lights, light_count), "
            "sum);\n"
            "    }\n"
            "    sum.fractional_id = is_fractional(id);\n"
            "    return sum;\n}\n\n";
    return text;
}

std::string emission_function(const Frame& frame) {
    std::string text = "static inline radiance add_emission(radiance sum, inputs in, surface s, __constant const "
                       "ParameterConstants* p) {\n";
    if (frame.has_emission) {
        text += fmt::format("    const rgb emission = {};\n"
                            "    sum.total = add_rgb(sum.total, larger_rgb(emission, 0.0f));\n",
                            colour(frame, frame.emission, "(*p)"));
    }
    return text + "    return sum;\n}\n";
}

void add_parameter(std::set<PlaneIndex>& planes, const BoundParameter& parameter) {
    for (const PlaneIndex plane : parameter.planes) {
        planes.insert(plane);
    }
}

} // namespace

std::vector<PlaneIndex> planes_read(const Frame& frame) {
    std::set<PlaneIndex> planes(frame.roles.normal.begin(), frame.roles.normal.end());
    planes.insert(frame.roles.position.begin(), frame.roles.position.end());
    planes.insert({frame.roles.depth, frame.roles.coverage, frame.roles.material_id});
    for (const BoundMaterial& material : frame.materials) {
        if (material.specular != SpecularModel::none) {
            add_parameter(planes, material.f0);
            add_parameter(planes, material.shininess);
        }
        if (material.diffuse != DiffuseModel::none) {
            add_parameter(planes, material.albedo);
            if (!code_of(material.diffuse).terms_type.empty()) {
                add_parameter(planes, material.diffuse_shininess);
            }
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
    text += "\n";
    int next = 4; // after R, G, B, A; the order of output_plane_names
    const auto define_output = [&](std::string_view name, bool wanted, int planes) {
        define(name, wanted && planes > 0 ? next : no_plane);
        next += wanted ? planes : 0;
    };
    define_output("OUTPUT_DIFFUSE", aovs.diffuse, 3);
    define_output("OUTPUT_SPECULAR", aovs.specular, 3);
    define_output("OUTPUT_LIGHTS", aovs.lights, 3 * static_cast<int>(frame.lights.size()));
    return text + "\n#endif\n";
}

std::string materials_source(const Frame& frame) {
    std::string text =
        "// Written by clshade for one set of materials; kernels/materials.cl is the same for one material\n"
        "// whose parameters all come from planes.\n"
        "#ifndef CLSHADE_MATERIALS_CL\n#define CLSHADE_MATERIALS_CL\n\n"
        "#include \"blinn_phong.cl\"\n#include \"diffuse.cl\"\n#include \"parameters.cl\"\n"
        "#include \"radiance.cl\"\n\n";
    const bool by_id = frame.roles.material_id != no_plane;
    const std::size_t count = by_id ? frame.materials.size() : 1;
    for (std::size_t k = 0; k < count; ++k) {
        text += material_function(frame, k);
    }
    return text + material_choice(frame) + emission_function(frame) + "\n#endif\n";
}

std::string kernel_key(const Frame& frame) {
    std::string key = "shade.";
    if (frame.materials.size() == 1) {
        key += fmt::format("{}.{}", name_of(frame.materials[0].specular), name_of(frame.materials[0].diffuse));
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
    return fmt::format("{}.{}", key, lights.empty() ? "unlit" : fmt::format("{}", fmt::join(lights, "_")));
}

} // namespace clshade
