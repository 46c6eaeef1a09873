#include "host/shading/material_code.h"

#include "host/shading/parameter_code.h"
#include "host/shading/stack_code.h"

#include <fmt/format.h>

#include <cctype>
#include <iterator>
#include <utility>

namespace clshade {

namespace {

constexpr std::string_view arguments = "inputs in, surface s, results out, __constant const FrameConstants* frame, "
                                       "__global const LightConstants* lights";

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

/// What of the light is reflected: share times light.
std::string reflected(const LightSum& sum) {
    return sum.share.grey ? fmt::format("scale_rgb({}, {})", sum.light, real_text(sum.share))
                          : fmt::format("multiply_rgb({}, {})", sum.light, rgb_text(sum.share));
}

std::string add_reflected(const LightSum& sum) {
    const std::string variable = "sum_" + sum.name;
    const std::string text =
        sum.share.grey ? fmt::format("add_share({}, {}, {})", variable, sum.light, real_text(sum.share))
                       : fmt::format("multiply_add_rgb({}, {}, {})", sum.light, rgb_text(sum.share), variable);
    return fmt::format("{} = {};", variable, text);
}

/// The lines that add up the diffuse or the specular part, each sum times its colour. `term` gives the code of a sum.
template <class Term>
void add_part(CodeBlock& block, const std::string& part, bool diffuse, const std::vector<LightSum>& sums, Term term) {
    std::string type = "rgb ";
    for (const LightSum& sum : sums) {
        if (sum.diffuse != diffuse) {
            continue;
        }
        const std::string value = term(sum);
        if (!type.empty()) {
            block.line(fmt::format("{}{} = {};", type, part, rgb_text(product(sum.colour, Value::rgb(value)))));
        } else if (sum.colour.is(1.0)) {
            block.line(fmt::format("{0} = add_rgb({0}, {1});", part, value));
        } else {
            block.line(fmt::format("{0} = multiply_add_rgb({1}, {2}, {0});", part, rgb_text(sum.colour), value));
        }
        type.clear();
    }
    if (!type.empty()) {
        block.line(fmt::format("rgb {} = grey(splat(0.0f));", part));
    }
}

std::string loop_text(const StackCode& code) {
    CodeBlock before(4);
    for (const LightSum& sum : code.sums()) {
        before.line(fmt::format("rgb sum_{} = grey(splat(0.0f));", sum.name));
    }
    CodeBlock loop(8);
    for (const LightSum& sum : code.sums()) {
        loop.line(add_reflected(sum));
    }
    CodeBlock own(8);
    add_part(own, "own_diffuse", true, code.sums(), reflected);
    add_part(own, "own_specular", false, code.sums(), reflected);
    return before.text() +
           "    for (int k = 0; k < frame->light_count; ++k) {\n"
           "        const incidence i = incidence_of(s, lights + k);\n"
           "        const rgb e0 = irradiance(lights + k, i);\n" +
           code.loop() + loop.text() + "#if OUTPUT_LIGHTS >= 0\n" + own.text() +
           "        store_light(out, mine, s, k, make_radiance(own_diffuse, own_specular));\n#endif\n    }\n";
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
    text += wrapped(fmt::format("static inline radiance shade_material_{}(mask mine, {}) {{", index, arguments));
    text += code.setup() + "\n" + loop_text(code);
    CodeBlock end(4);
    const auto sum_name = [](const LightSum& sum) { return "sum_" + sum.name; };
    add_part(end, "diffuse", true, code.sums(), sum_name);
    add_part(end, "specular", false, code.sums(), sum_name);
    end.line("radiance sum = make_radiance(diffuse, specular);");
    const auto note = [&end](const char* field, const MaskNames& masks) {
        if (!masks.empty()) {
            end.line(fmt::format("sum.{} = {};", field, fmt::join(masks, " | ")));
        }
    };
    note("clamped", code.clamped());
    note("no_tangent", code.no_tangent());
    end.line("return sum;");
    return text + end.text() + "}\n\n";
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
    std::string text = wrapped(fmt::format("static inline radiance shade_materials({}) {{", arguments));
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
