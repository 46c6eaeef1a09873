#include "host/shading/material_code.h"

#include "host/shading/environment_code.h"
#include "host/shading/parameter_code.h"
#include "host/shading/stack_code.h"

#include <fmt/format.h>

#include <cctype>
#include <iterator>
#include <utility>

namespace clshade {

namespace {

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
        text += parameter_comment(frame, "shininess_u", layer.shininess_u) +
                parameter_comment(frame, "shininess_v", layer.shininess_v);
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

std::string add_reflected(const LightSum& sum, const LightSum::Term& term) {
    const std::string text =
        term.share.grey ? fmt::format("add_share(sums.{}, {}, {})", sum.name, term.light, real_text(term.share))
                        : fmt::format("multiply_add_rgb({}, {}, sums.{})", term.light, rgb_text(term.share), sum.name);
    return fmt::format("sums.{} = {};", sum.name, text);
}

/// The lines that add up the diffuse or the specular part, each sum times its colour.
void add_part(CodeBlock& block, const std::string& part, bool diffuse, const std::vector<LightSum>& sums) {
    Value total = Value::of(0.0);
    for (const LightSum& sum : sums) {
        if (sum.diffuse != diffuse) {
            continue;
        }
        const Value colour = block.local_colour(sum.name + "_colour", sum.colour);
        const Value own = Value::rgb("sums." + sum.name);
        if (total.known) {
            total = product(colour, own);
        } else if (colour.is(1.0)) {
            total = Value::rgb(fmt::format("add_rgb({}, {})", own.text, total.text));
        } else {
            total = Value::rgb(fmt::format("multiply_add_rgb({}, {}, {})", rgb_text(colour), own.text, total.text));
        }
    }
    block.line(fmt::format("const rgb {} = {};", part, rgb_text(total)));
}

/// The two structs of a material: what it knows of a pixel, and its sums over the lights.
std::string structs(const StackCode& code, std::size_t index) {
    std::string members = code.setup().members();
    if (!code.clamped().empty()) {
        members += "    mask clamped;\n";
    }
    if (!code.no_tangent().empty()) {
        members += "    mask no_tangent;\n";
    }
    if (members.empty()) {
        members = "    mask none; // everything about it is constant\n";
    }
    std::string text = fmt::format("typedef struct {{\n{}}} material_{};\n\ntypedef struct {{\n", members, index);
    for (const LightSum& sum : code.sums()) {
        text += fmt::format("    rgb {};\n", sum.name);
    }
    return text + (code.sums().empty() ? "    mask none;\n" : "") + fmt::format("}} sums_{};\n\n", index);
}

std::string read_function(const StackCode& code, std::size_t index) {
    CodeBlock body(4);
    const auto note = [&body](const char* field, const MaskNames& masks) {
        if (!masks.empty()) {
            body.line(fmt::format("m.{} = {};", field, fmt::join(masks, " | ")));
        }
    };
    note("clamped", code.clamped());
    note("no_tangent", code.no_tangent());
    const std::string all = code.setup().text() + body.text();
    return fmt::format("// What the pixel's parameters say.\n"
                       "static inline material_{0} read_material_{0}(inputs in, surface s, __constant const "
                       "FrameConstants* frame) {{\n    material_{0} m;\n{1}    return m;\n}}\n\n",
                       index, all.empty() ? "    m.none = FALSE_MASK;\n" : all);
}

std::string light_function(const StackCode& code, std::size_t index) {
    CodeBlock sums(4);
    for (const LightSum& sum : code.sums()) {
        for (const LightSum::Term& term : sum.terms) {
            sums.line(add_reflected(sum, term));
        }
    }
    return fmt::format(
        "// Adds a light of irradiance e0.\n"
        "static inline sums_{0} add_light_{0}(sums_{0} sums, material_{0} m, surface s, incidence i, rgb e0) "
        "{{\n{1}{2}    return sums;\n}}\n\n",
        index, code.light(), sums.text());
}

std::string reflect_function(const StackCode& code, std::size_t index) {
    CodeBlock body(4);
    add_part(body, "diffuse", true, code.sums());
    add_part(body, "specular", false, code.sums());
    body.line("radiance sum = make_radiance(diffuse, specular);");
    if (!code.clamped().empty()) {
        body.line("sum.clamped = m.clamped;");
    }
    if (!code.no_tangent().empty()) {
        body.line("sum.no_tangent = m.no_tangent;");
    }
    return fmt::format(
        "// Multiplies the colours in.\n"
        "static inline radiance reflect_{0}(material_{0} m, sums_{0} sums) {{\n{1}    return sum;\n}}\n\n",
        index, body.text());
}

std::string claim(const BoundMaterial& material, bool by_id) {
    std::vector<std::string> tests;
    for (const std::int64_t id : by_id ? material.ids : std::vector<std::int64_t>{}) {
        tests.push_back(fmt::format("has_id(whole_id, {}.0f)", id));
    }
    for (const CryptomatteClaim& name : material.cryptomatte) {
        tests.push_back(fmt::format("has_name(load_input(in, {}), 0x{:08x}u)", name.plane, name.bits));
    }
    return tests.empty() ? "FALSE_MASK" : fmt::format("{}", fmt::join(tests, " | "));
}

/// Parameters and arguments that a material's function has for the environment.
constexpr std::string_view environment_parameters = ", surroundings a, environment around";
constexpr std::string_view environment_arguments = ", a, around";

std::string environment_functions(const EnvironmentCode& code, std::size_t index) {
    const std::string members = code.requests().empty() ? "    mask none;\n" : code.requests();
    return fmt::format(
        "typedef struct {{\n{1}}} requests_{0};\n\n"
        "// Asks for what the material sees of the environment.\n"
        "static inline void ask_{0}(requests_{0}* q, material_{0} m, surface s, surroundings a) {{\n{2}}}\n\n"
        "// Adds the light of the environment.\n"
        "static inline radiance surround_{0}(radiance sum, requests_{0}* q, material_{0} m, surface s,\n"
        "    surroundings a, environment around) {{\n{3}    return add_environment(sum, diffuse, specular);\n"
        "}}\n\n",
        index, members, code.asking(), code.answering());
}

/// The function that takes a material from planes to radiance. One light is met by the caller, once for all materials.
std::string shade_material_function(std::size_t index, bool one_light, bool surrounded) {
    const std::string own =
        fmt::format("#if OUTPUT_LIGHTS >= 0\n"
                    "{1}store_light(out, mine, s, {2}, reflect_{0}(m, add_light_{0}(none, m, s, i, e0)));\n#endif\n",
                    index, one_light ? "    " : "        ", one_light ? "0" : "k");
    std::string text =
        fmt::format("// From planes to radiance; store_light needs to know which pixels are its own.\n"
                    "static inline radiance shade_material_{}(mask mine, inputs in, surface s, results out,\n"
                    "    __constant const FrameConstants* frame, ",
                    index);
    text += one_light ? "incidence i, rgb e0" : "__global const LightConstants* lights";
    text += fmt::format("{}) {{\n", surrounded ? environment_parameters : "");
    text +=
        fmt::format("    const material_{0} m = read_material_{0}(in, s, frame);\n"
                    "{1}"
                    "    const sums_{0} none = {{0}};\n"
                    "    sums_{0} sums = none;\n",
                    index, surrounded ? fmt::format("    requests_{0} q;\n    ask_{0}(&q, m, s, a);\n", index) : "");
    if (one_light) {
        text += fmt::format("    sums = add_light_{}(sums, m, s, i, e0);\n", index) + own;
    } else {
        text += fmt::format("    for (int k = 0; k < frame->light_count; ++k) {{\n"
                            "        const incidence i = incidence_of(s, lights + k);\n"
                            "        const rgb e0 = irradiance(lights + k, i);\n"
                            "        sums = add_light_{}(sums, m, s, i, e0);\n",
                            index) +
                own + "    }\n";
    }
    const std::string_view result =
        surrounded ? "surround_{0}(reflect_{0}(m, sums), &q, m, s, a, around)" : "reflect_{0}(m, sums)";
    return text + fmt::format("    return {};\n}}\n\n", fmt::format(fmt::runtime(result), index));
}

std::string material_functions(const Frame& frame, std::size_t index, MaterialsSource& source) {
    const BoundMaterial& material = frame.materials[index];
    const StackCode code(frame, index);
    source.warnings.insert(source.warnings.end(), code.warnings().begin(), code.warnings().end());
    std::string text = code.functions();
    text += fmt::format("// Material {}, \"{}\": {}\n", index, comment_text(material.name), model_key(material));
    for (std::size_t k = 0; k < material.layers.size(); ++k) {
        text += layer_comment(frame, material, k);
    }
    text +=
        structs(code, index) + read_function(code, index) + light_function(code, index) + reflect_function(code, index);
    if (frame.environment) {
        text += environment_functions(EnvironmentCode(material, code, source.maps), index);
    }
    return text + shade_material_function(index, frame.lights.size() == 1, frame.environment.has_value());
}

/// Which material each pixel goes to: those with claims in turn, the first for what is left.
std::string shade_function(const Frame& frame) {
    const bool one_light = frame.lights.size() == 1;
    const bool by_id = frame.materials.size() > 1 && frame.roles.material_id != no_plane;
    const std::string lights =
        fmt::format("{}{}", one_light ? "i, e0" : "lights", frame.environment ? environment_arguments : "");
    CodeBlock body(4);
    if (one_light) {
        body.line("const incidence i = incidence_of(s, lights);");
        body.line("const rgb e0 = irradiance(lights, i);");
    }
    if (frame.environment) {
        body.line("const surroundings a = surroundings_of(around, s);");
    }
    if (frame.materials.size() == 1) {
        body.line(fmt::format("return shade_material_0(s.alive, in, s, out, frame, {});", lights));
    } else {
        if (by_id) {
            body.line("const real id = load_input(in, PLANE_MATERIAL_ID);");
            body.line("const real whole_id = nearest_whole(id);");
        }
        body.line("mask rest = s.alive;");
        body.line("radiance sum = no_radiance();");
        const auto shade_mine = [&](std::size_t k, const std::string& mine) {
            body.line(fmt::format("if (any_lane({})) {{", mine));
            body.line(
                fmt::format("    sum = choose_radiance({1}, shade_material_{0}({1}, in, s, out, frame, {2}), sum);", k,
                            mine, lights));
            body.line("}");
        };
        for (std::size_t k = 1; k < frame.materials.size(); ++k) {
            const std::string mine = fmt::format("mine_{}", k);
            body.line(fmt::format("const mask {} = rest & ({});", mine, claim(frame.materials[k], by_id)));
            body.line(fmt::format("rest = rest & negated({});", mine));
            shade_mine(k, mine);
        }
        shade_mine(0, "rest");
        if (by_id) {
            body.line("sum.fractional_id = is_fractional(id, whole_id);");
        }
        body.line("return sum;");
    }
    return "static inline radiance shade_materials(inputs in, surface s, results out, __constant const FrameConstants* "
           "frame,\n                                       __global const LightConstants* lights" +
           std::string(frame.environment ? ", environment around" : "") + ") {\n" + body.text() + "}\n\n";
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
        "// Written by clshade (host/shading/material_code.cpp) for one set of materials: functions for each, and\n"
        "// which pixel goes to which. The copy in kernels/ is for Blinn-Phong + Lambert with every parameter from "
        "planes.\n"
        "#ifndef CLSHADE_MATERIALS_CL\n#define CLSHADE_MATERIALS_CL\n\n"
        "#include \"anisotropic.cl\"\n#include \"blinn_phong.cl\"\n#include \"diffuse.cl\"\n"
        "#include \"environment.cl\"\n"
        "#include \"layers.cl\"\n#include \"parameters.cl\"\n#include \"radiance.cl\"\n#include \"spectral.cl\"\n\n";
    for (std::size_t k = 0; k < frame.materials.size(); ++k) {
        source.text += material_functions(frame, k, source);
    }
    source.text += shade_function(frame) + emission_function(frame) + "\n#endif\n";
    return source;
}

} // namespace clshade
