#include "host/shading/material_code.h"

#include "host/shading/parameter_code.h"
#include "host/shading/stack_code.h"

#include <fmt/format.h>

#include <cctype>
#include <iterator>
#include <utility>

namespace clshade {

namespace {

constexpr std::string_view arguments = "inputs in, surface s, results out, __constant const FrameConstants* frame,\n"
                                       "    __global const LightConstants* lights";

/// A name as it may stand in a comment.
std::string comment_text(const std::string& name) {
    std::string text;
    for (const char c : name) {
        text +=
            std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == ' ' || c == '.' ? c : '?';
    }
    return text;
}

std::string parameter_comment(const Frame& frame, std::string_view what, const BoundParameter& parameter) {
    if (!parameter.is_constant()) {
        return fmt::format(", {} from {}", what,
                           comment_text(frame.plane_names[static_cast<std::size_t>(parameter.planes[0])]));
    }
    const glm::dvec3& v = parameter.constant;
    return parameter.constant.x == v.y && v.x == v.z ? fmt::format(", {} {:g}", what, v.x)
                                                     : fmt::format(", {} ({:g}, {:g}, {:g})", what, v.x, v.y, v.z);
}

std::string layer_comment(const Frame& frame, const BoundMaterial& material, std::size_t k) {
    const BoundLayer& layer = material.layers[k];
    std::string text = fmt::format("//   layer {}: {}", k, name_of(layer.specular));
    if (layer.specular == SpecularModel::blinn_phong_spectral) {
        text += fmt::format(", metal {}", comment_text(layer.metal.name));
    } else if (layer.specular != SpecularModel::none) {
        text += parameter_comment(frame, "f0", layer.f0);
    }
    if (layer.specular == SpecularModel::blinn_phong_anisotropic) {
        text += parameter_comment(frame, "shininess", layer.shininess_u) +
                parameter_comment(frame, "by", layer.shininess_v);
    } else if (layer.specular != SpecularModel::none) {
        text += parameter_comment(frame, "shininess", layer.shininess);
    }
    if (k + 1 < material.layers.size() && material.absorption != AbsorptionModel::none) {
        text += parameter_comment(frame, "absorption", layer.absorption);
    }
    if (k + 1 == material.layers.size() && material.diffuse != DiffuseModel::none) {
        text +=
            fmt::format(" over {}", name_of(material.diffuse)) + parameter_comment(frame, "albedo", material.albedo);
    }
    return text + "\n";
}

/// What of the light is reflected: share times light, added to `sum` unless that is empty.
std::string reflected(const LightSum& sum, const std::string& so_far) {
    const std::string share = sum.share.grey ? real_text(sum.share) : rgb_text(sum.share);
    if (so_far.empty()) {
        return fmt::format("{}({}, {})", sum.share.grey ? "scale_rgb" : "multiply_rgb", sum.light, share);
    }
    return sum.share.grey ? fmt::format("add_share({}, {}, {})", so_far, sum.light, share)
                          : fmt::format("multiply_add_rgb({}, {}, {})", sum.light, share, so_far);
}

/// The diffuse or specular part: every sum with its colour. `prefix` + name is the variable that holds it.
std::string part(const std::vector<LightSum>& sums, bool diffuse, std::string_view prefix) {
    Value total = Value::of(0.0);
    for (const LightSum& sum_of : sums) {
        if (sum_of.diffuse == diffuse) {
            total = sum(total, product(sum_of.colour, Value::rgb(fmt::format("{}{}", prefix, sum_of.name))));
        }
    }
    return rgb_text(total);
}

std::string radiance_text(const std::vector<LightSum>& sums, std::string_view prefix) {
    return fmt::format("make_radiance({}, {})", part(sums, true, prefix), part(sums, false, prefix));
}

std::string loop_text(const StackCode& code) {
    std::string text;
    for (const LightSum& sum_of : code.sums()) {
        text += fmt::format("    rgb sum_{} = grey(splat(0.0f));\n", sum_of.name);
    }
    text += "    for (int k = 0; k < frame->light_count; ++k) {\n"
            "        const incidence i = incidence_of(s, lights + k);\n"
            "        const rgb e0 = irradiance(lights + k, i);\n";
    text += code.loop();
    for (const LightSum& sum_of : code.sums()) {
        const std::string variable = "sum_" + sum_of.name;
        text += fmt::format("        {} = {};\n", variable, reflected(sum_of, variable));
    }
    text += "#if OUTPUT_LIGHTS >= 0\n";
    for (const LightSum& sum_of : code.sums()) {
        text += fmt::format("        const rgb own_{} = {};\n", sum_of.name, reflected(sum_of, ""));
    }
    text +=
        fmt::format("        store_light(out, mine, s, k, {});\n#endif\n    }}\n", radiance_text(code.sums(), "own_"));
    return text;
}

std::string material_function(const Frame& frame, std::size_t index, std::vector<std::string>& warnings) {
    const BoundMaterial& material = frame.materials[index];
    const StackCode code(frame, index);
    warnings.insert(warnings.end(), code.warnings().begin(), code.warnings().end());
    std::string text = code.functions();
    text += fmt::format("// Material {}, \"{}\": {}\n", index, comment_text(material.name), model_key(material));
    for (std::size_t k = 0; k < material.layers.size(); ++k) {
        text += layer_comment(frame, material, k);
    }
    text += fmt::format("static inline radiance shade_material_{}(mask mine, {}) {{\n", index, arguments);
    text += code.setup() + "\n" + loop_text(code);
    text += fmt::format("    radiance sum = {};\n", radiance_text(code.sums(), "sum_"));
    const auto note = [&text](const char* field, const MaskNames& masks) {
        if (!masks.empty()) {
            text += fmt::format("    sum.{} = {};\n", field, fmt::join(masks, " | "));
        }
    };
    note("clamped", code.clamped());
    note("no_tangent", code.no_tangent());
    return text + "    return sum;\n}\n\n";
}

std::string claim(const BoundMaterial& material, bool by_id) {
    std::vector<std::string> tests;
    for (const std::int64_t id : by_id ? material.ids : std::vector<std::int64_t>{}) {
        tests.push_back(fmt::format("has_id(id, {}.0f)", id));
    }
    for (const CryptomatteClaim& name : material.cryptomatte) {
        tests.push_back(fmt::format("has_name(load_input(in, {}), 0x{:08x}u)", name.plane, name.bits));
    }
    return tests.empty() ? "FALSE_MASK" : fmt::format("{}", fmt::join(tests, " | "));
}

/// Which material each pixel goes to: those with claims in turn, the first for what is left.
std::string material_choice(const Frame& frame) {
    std::string text = fmt::format("static inline radiance shade_materials({}) {{\n", arguments);
    if (frame.materials.size() == 1) {
        return text + "    return shade_material_0(s.alive, in, s, out, frame, lights);\n}\n\n";
    }
    const bool by_id = frame.roles.material_id != no_plane;
    if (by_id) {
        text += "    const real id = load_input(in, PLANE_MATERIAL_ID);\n";
    }
    text += "    mask rest = s.alive;\n    radiance sum = no_radiance();\n";
    for (std::size_t k = 1; k < frame.materials.size(); ++k) {
        text += fmt::format(
            "    const mask mine_{0} = rest & ({1});\n"
            "    rest = rest & negated(mine_{0});\n"
            "    if (any_lane(mine_{0})) {{\n"
            "        sum = choose_radiance(mine_{0}, shade_material_{0}(mine_{0}, in, s, out, frame, lights), sum);\n"
            "    }}\n",
            k, claim(frame.materials[k], by_id));
    }
    text += "    if (any_lane(rest)) {\n"
            "        sum = choose_radiance(rest, shade_material_0(rest, in, s, out, frame, lights), sum);\n"
            "    }\n";
    if (by_id) {
        text += "    sum.fractional_id = is_fractional(id);\n";
    }
    return text + "    return sum;\n}\n\n";
}

std::string emission_function(const Frame& frame) {
    std::string text = "static inline radiance add_emission(radiance sum, inputs in, surface s) {\n";
    if (frame.has_emission) {
        CodeBlock block(4);
        ParameterReader reader(frame, block);
        const Value emission = reader.emission(frame.emission, "emission");
        text += block.text() + fmt::format("    sum.total = add_rgb(sum.total, {});\n", rgb_text(emission));
    }
    return text + "    return sum;\n}\n";
}

} // namespace

MaterialsSource materials_source(const Frame& frame) {
    MaterialsSource source;
    source.text =
        "// Written by clshade for one set of materials: a function for each, and which pixel goes to which.\n"
        "#ifndef CLSHADE_MATERIALS_CL\n#define CLSHADE_MATERIALS_CL\n\n"
        "#include \"anisotropic.cl\"\n#include \"blinn_phong.cl\"\n#include \"diffuse.cl\"\n"
        "#include \"layers.cl\"\n#include \"parameters.cl\"\n#include \"radiance.cl\"\n#include \"spectral.cl\"\n\n";
    for (std::size_t k = 0; k < frame.materials.size(); ++k) {
        source.text += material_function(frame, k, source.warnings);
    }
    source.text += material_choice(frame) + emission_function(frame) + "\n#endif\n";
    return source;
}

} // namespace clshade
