#include "host/shading/stack_code.h"

#include "host/base/error.h"
#include "host/shading/diffuse_code.h"
#include "host/shading/layer_constants.h"

#include <fmt/format.h>

#include <numbers>

namespace clshade {

namespace {

/// Further from the spectral sum than this a fitted curve is worth a warning.
constexpr double curve_warning = 1e-5;
/// And beyond this the picture would be wrong: a metal without absorption and with n below 1 reflects totally from its
/// critical angle on, a kink that no polynomial follows.
constexpr double curve_failure = 1e-3;

bool all_zero(const Value& value) {
    return value.is(0.0);
}

/// Known to be above zero in every channel.
bool all_positive(const Value& value) {
    return value.known && value.number.x > 0.0 && value.number.y > 0.0 && value.number.z > 0.0;
}

Value amplitude_value(CodeBlock& block, const std::string& name, const Value& f0) {
    return f0.known ? Value::of(amplitude_of(f0.number)) : block.name(name, call("amplitude_of", {f0}));
}

Value medium_value(CodeBlock& block, const std::string& name, const Value& amplitude, const Value& above) {
    if (amplitude.known && above.known) {
        return Value::of(folded_medium(amplitude.number, above.number));
    }
    if (all_positive(amplitude) || all_zero(above)) {
        return amplitude;
    }
    if (all_zero(amplitude)) {
        return above;
    }
    return block.name(name, call("medium_below", {amplitude, above}));
}

Value normaliser_value(const Value& n, bool exact) {
    if (n.known) {
        return Value::of(exact ? folded_normaliser_exact(n.number.x) : folded_normaliser_linear(n.number.x));
    }
    return Value::real(fmt::format("{}({})", exact ? "normaliser_exact" : "normaliser_linear", n.text));
}

} // namespace

StackCode::StackCode(const Frame& frame, std::size_t material)
    : material_(&frame.materials[material]), index_(material), reader_(frame, setup_) {
    for (std::size_t k = 0; k < material_->layers.size(); ++k) {
        add_layer(k);
    }
    for (LightSum& sum : sums_) { // every lobe has N.L / max(N.L, N.E) as a factor: once for those added up already
        for (LightSum::Term& term : sum.terms) {
            term.share = sum.diffuse ? term.share : product(Value::real("i.ratio"), term.share);
        }
    }
}

std::string StackCode::name(std::string_view what, std::size_t k) const {
    return material_->layers.size() == 1 ? std::string(what) : fmt::format("{}_{}", what, k);
}

void StackCode::add_layer(std::size_t k) {
    const BoundLayer& layer = material_->layers[k];
    LayerFacts& facts = layers_.emplace_back();
    facts.above = medium_;
    facts.inside = inside_;
    facts.up = up_;
    if (layer.specular == SpecularModel::blinn_phong_anisotropic) {
        tangents_ = setup_.declare("tangent_frame", name("tangents", k),
                                   fmt::format("tangent_frame_of(s.n, {})", reader_.tangent(layer.tangent)));
        no_tangent_.push_back(tangents_ + ".missing");
        facts.tangents = tangents_;
    }
    const Interface interface = is_exact() ? exact_interface(k) : constant_interface(k);
    facts.present = interface.present;
    facts.r = interface.r;
    facts.gain = interface.gain;
    facts.below = below_;
    if (interface.present) {
        add_lobe(k, interface);
    }
    if (is_base(k)) {
        add_base_diffuse(interface);
        return;
    }
    if (interface.present) {
        pass(k, interface);
        refracted_ = bent_;
    }
    absorb(k);
    inside_ = inside_ || all_positive(below_);
    medium_ = below_;
}

bool StackCode::read_f0(std::size_t k, Value& f0) {
    const BoundLayer& layer = material_->layers[k];
    amplitude_ = Value::of(0.0);
    below_ = medium_;
    if (layer.specular == SpecularModel::none) {
        return false;
    }
    if (layer.specular == SpecularModel::blinn_phong_spectral) {
        if (!medium_.known) {
            throw RuntimeFailure(
                fmt::format("material '{}': the layers above its metal must have constant f0", material_->name));
        }
        const glm::dvec3 in_air = glm::clamp(metal_reflectance(layer.metal, {}, 1.0), 0.0, 1.0);
        f0 = Value::of(in_air);
        amplitude_ = Value::of(amplitude_of(in_air));
        below_ = is_base(k) ? amplitude_ : Value::of(folded_medium(amplitude_.number, medium_.number));
        return is_base(k) || !all_zero(f0);
    }
    f0 = reader_.reflectance(layer.f0, name("f0", k));
    layers_[k].f0 = f0;
    if (!is_base(k) && all_zero(f0)) {
        return false;
    }
    // Against air a single layer needs F0 only.
    const bool needs_amplitude = !is_base(k) || is_exact() || !all_zero(medium_);
    if (needs_amplitude) {
        amplitude_ = amplitude_value(setup_, name("amplitude", k), f0);
    }
    below_ = is_base(k) ? amplitude_ : medium_value(setup_, name("medium", k), amplitude_, medium_);
    return true;
}

StackCode::Interface StackCode::constant_interface(std::size_t k) {
    Interface here;
    Value f0;
    here.present = read_f0(k, f0);
    if (!here.present) {
        return here;
    }
    const BoundLayer& layer = material_->layers[k];
    if (layer.specular == SpecularModel::blinn_phong_spectral) {
        const glm::dvec3 above = medium_.number;
        const MetalSurroundings where{
            .index = index_of(above), .refracted = false, .constant = glm::notEqual(above, glm::dvec3(0.0))};
        here.r = product(Value::of(glm::clamp(metal_reflectance(layer.metal, where, 1.0), 0.0, 1.0)), reflecting(k));
        if (!glm::all(where.constant)) {
            here.fresnel = metal_call(k, where);
        }
        return here;
    }
    const bool air_above = all_zero(medium_);
    if (air_above) {
        here.r = f0;
    } else {
        here.r = medium_.known && below_.known
                     ? Value::of(folded_reflectance(medium_.number, below_.number))
                     : setup_.name(name("r", k), call("normal_reflectance", {medium_, below_}));
    }
    if (inside_) {
        return here; // never met from air
    }
    const bool all_known = here.r.known && amplitude_.known && medium_.known;
    if (all_known) {
        here.gain = Value::of(folded_gain(here.r.number, amplitude_.number, medium_.number, is_base(k)));
    } else if (air_above && is_base(k)) {
        here.gain = complement(here.r);
    } else if (is_base(k)) {
        here.gain = setup_.name(name("gain", k), call("outer_gain_of_base", {here.r, medium_}));
    } else {
        here.gain = setup_.name(name("gain", k), call("outer_gain", {here.r, amplitude_, medium_}));
    }
    if (!all_zero(here.gain)) {
        here.weight = schlick_weight(layer.specular);
    }
    return here;
}

StackCode::Interface StackCode::exact_interface(std::size_t k) {
    Interface here;
    Value f0;
    here.present = read_f0(k, f0);
    if (!here.present) {
        return here;
    }
    const std::string c2 = shared("c2", "0.25f * i.two_eh * i.two_eh").text;
    const Value above = all_zero(medium_) ? shared("c", "0.5f * i.two_eh") : refracted_;
    bent_ = loop_.name(name("bent", k), call("refracted", c2, {below_}));
    const BoundLayer& layer = material_->layers[k];
    here.fresnel =
        layer.specular == SpecularModel::blinn_phong_spectral
            ? metal_call(k, {.index = index_of(medium_.number), .refracted = true, .constant = glm::bvec3(false)})
            : loop_.name(name("fresnel", k), call("interface_reflectance", c2, {above, bent_, medium_, below_}));
    return here;
}

Value StackCode::reflecting(std::size_t k) const {
    return Value::of(is_base(k) ? glm::dvec3(1.0) : glm::dvec3(glm::greaterThan(amplitude_.number, glm::dvec3(0.0))));
}

Value StackCode::metal_call(std::size_t k, const MetalSurroundings& where) {
    const Metal& metal = material_->layers[k].metal;
    const MetalCurve curve = fit_metal_curve(metal, where);
    if (curve.error > curve_failure) {
        throw UsageError(
            fmt::format("material '{}': the Fresnel curve of metal '{}' has a kink (n below 1 and hardly any "
                        "k), which clshade cannot follow closer than {:.1g}; use blinn_phong with f0",
                        material_->name, metal.name, curve.error));
    }
    if (curve.error > curve_warning) {
        warnings_.push_back(fmt::format("material '{}': the Fresnel curve of '{}' is fitted to within {:.1g} only",
                                        material_->name, metal.name, curve.error));
    }
    const std::string function = fmt::format("metal_{}_{}", index_, k);
    functions_ += fmt::format(
        "// Fresnel reflectance of layer {}'s metal at c = E.H, fitted to within {:.1g} (models.md section 4).\n"
        "static inline rgb {}(real c) {{\n"
        "    const real x = metal_argument(c, {});\n",
        k, curve.error, function, float_literal(curve.bend));
    const auto& coefficients = curve.coefficients;
    functions_ += fmt::format("    rgb p = {};\n", rgb_text(Value::of(coefficients.back())));
    for (std::size_t i = coefficients.size() - 1; i-- > 0;) {
        functions_ += fmt::format("    p = horner(p, x, {}, {}, {});\n", float_literal(coefficients[i].x),
                                  float_literal(coefficients[i].y), float_literal(coefficients[i].z));
    }
    functions_ += "    return clamp_rgb(p, 0.0f, 1.0f);\n}\n\n";
    layers_[k].metal = function;
    layers_[k].reflecting = reflecting(k);
    const Value c = shared("c", "0.5f * i.two_eh");
    return loop_.name(name("fresnel", k), product(Value::rgb(fmt::format("{}({})", function, c.text)), reflecting(k)));
}

void StackCode::add_lobe(std::size_t k, const Interface& interface) {
    const BoundLayer& layer = material_->layers[k];
    Value normaliser;
    Value half_exponent;
    if (layer.specular == SpecularModel::blinn_phong_anisotropic) {
        const Value u = reader_.shininess(layer.shininess_u, name("shininess_u", k));
        const Value v = reader_.shininess(layer.shininess_v, name("shininess_v", k));
        layers_[k].shininess_u = u;
        layers_[k].shininess_v = v;
        normaliser = u.known && v.known ? Value::of(folded_normaliser_anisotropic(u.number.x, v.number.x))
                                        : call("normaliser_anisotropic", {u, v});
        half_exponent =
            Value::real(fmt::format("anisotropic_half_exponent(i, {}, {}, {})", tangents_, real_text(u), real_text(v)));
    } else {
        const Value n = reader_.shininess(layer.shininess, name("shininess", k));
        layers_[k].shininess = n;
        normaliser = normaliser_value(n, is_exact() || layer.specular == SpecularModel::blinn_phong_exact);
        half_exponent = setup_.name(name("half_shininess", k), product(Value::of(0.5), n));
    }
    const Value lobe =
        loop_.name(name("lobe", k), Value::real(fmt::format("cosine_power(i, {})", real_text(half_exponent))));
    const Value share = product(lobe, specular_.light);
    const Value colour = setup_.name(name("scale", k), product(normaliser, specular_.pixel));

    if (interface.fresnel) {
        add_sum(false, name("specular", k), product(share, *interface.fresnel), colour);
    } else if (interface.gain.is(0.0)) {
        add_sum(false, name("specular", k), share, product(colour, interface.r));
    } else if (interface.r.grey && interface.gain.grey) {
        // A known scale goes into both terms of F = r + gain weight.
        const Value scale = colour.known && colour.grey ? colour : Value::of(1.0);
        const Value fresnel =
            sum(product(scale, interface.r), product(product(scale, interface.gain), interface.weight));
        add_sum(false, name("specular", k), product(share, fresnel), scale.is(1.0) ? colour : Value::of(1.0));
    } else {
        const Value named = loop_.name(name("share", k), share);
        add_sum(false, name("specular", k), named, product(colour, interface.r));
        add_sum(false, name("weighted", k), product(named, interface.weight), product(colour, interface.gain));
    }
}

void StackCode::pass(std::size_t k, const Interface& interface) {
    const auto attenuate = [&](Passage& passage, const char* what, const Value& pixel, const Value& light) {
        passage.pixel = setup_.name(name(std::string(what) + "_passage", k), product(passage.pixel, pixel));
        passage.light = loop_.name(name(what, k), product(passage.light, light));
    };
    if (is_exact()) { // once down, once up: F(1/n; c') = F(n; c)
        const Value through = loop_.name(name("through", k), complement(*interface.fresnel));
        attenuate(specular_, "reaching", Value::of(1.0), product(through, through));
        diffuse_ = specular_;
        return;
    }
    const Value through = complement(interface.r);
    // F_b = r U: what the deck's diffuse part loses at an interface inside the stack.
    const Value diffuse_loss = product(interface.r, up_);
    if (interface.fresnel) { // a metal: 1 - F down, 1 - r up; the diffuse part 1 - F + r (1 - U)
        const Value down = loop_.name(name("through", k), complement(*interface.fresnel));
        attenuate(specular_, "reaching", through, down);
        attenuate(diffuse_, "entering", Value::of(1.0), sum(down, product(interface.r, complement(up_))));
    } else if (interface.gain.is(0.0)) { // inside
        attenuate(specular_, "reaching", product(through, through), Value::of(1.0));
        attenuate(diffuse_, "entering", complement(diffuse_loss), Value::of(1.0));
    } else if (interface.gain.known && interface.r.known && all_zero(medium_) &&
               difference(complement(interface.r), interface.gain)
                   .is(0.0)) { // met from air: 1 - F = (1 - r)(1 - weight)
        const Value down = loop_.name(name("through", k), complement(interface.weight));
        attenuate(specular_, "reaching", product(through, through), down);
        attenuate(diffuse_, "entering", through, down);
    } else { // which of both, pixels decide
        const Value lost = loop_.name(name("lost", k), product(interface.gain, interface.weight));
        attenuate(specular_, "reaching", through, difference(through, lost));
        attenuate(diffuse_, "entering", Value::of(1.0), difference(complement(diffuse_loss), lost));
    }
    up_ = setup_.name(name("up", k), product(up_, through));
}

void StackCode::absorb(std::size_t k) {
    if (material_->absorption == AbsorptionModel::none) {
        return;
    }
    const std::string variable = name("absorption", k);
    const Value read = reader_.absorption(material_->layers[k].absorption, variable);
    layers_[k].absorption = read;
    if (all_zero(read)) {
        return;
    }
    const Value absorption = loop_.local_colour(variable, read);
    if (material_->absorption == AbsorptionModel::approximated) {
        const std::string path = shared("path", "straight_path(i, s)").text;
        const std::string arguments =
            absorption.grey ? fmt::format("transmittance_approximated({}, {})", real_text(absorption), path)
                            : fmt::format("transmittance_approximated_rgb({}, {})", rgb_text(absorption), path);
        const Value here = absorption.grey ? Value::real(arguments) : Value::rgb(arguments);
        pending_ = product(pending_, here);
        return;
    }
    const Value up = setup_.name(name("path_up", k), call("refracted_path", "s.ne", {below_}));
    const Value path = loop_.name(name("path", k), sum(call("refracted_path", "i.nl", {below_}), up));
    depth_ = loop_.name(name("exponent", k), sum(depth_, call("absorption_exponent", {absorption, path})));
    deeper_ = true;
}

std::string StackCode::light_here() {
    Value transmitted = pending_;
    Value from = light_;
    if (deeper_) {
        from = Value::rgb("e0");
        transmitted = call("exp2_clamped", {depth_});
    }
    if (!transmitted.is(1.0)) {
        light_ = loop_.name(fmt::format("e{}", ++tints_), product(from, transmitted));
        pending_ = Value::of(1.0);
        deeper_ = false;
    }
    return light_.text;
}

void StackCode::add_base_diffuse(const Interface& base) {
    const DiffuseCode code = diffuse_code(material_->diffuse);
    if (material_->diffuse == DiffuseModel::none) {
        return;
    }
    const Value albedo = reader_.reflectance(material_->albedo, "albedo");
    diffuse_facts_.albedo = albedo;
    if (!code.terms_type.empty()) {
        const Value n = reader_.shininess(material_->diffuse_shininess, "diffuse_shininess");
        diffuse_facts_.shininess = n;
        setup_.declare(code.terms_type, "terms", fmt::format("{}({})", code.terms_function, real_text(n)));
    }
    Passage left = diffuse_;
    if (base.present && is_exact()) {
        left.light = product(left.light, complement(*base.fresnel));
    } else if (base.present) {
        left.pixel = product(left.pixel, complement(product(base.r, up_)));
        if (material_->base().specular == SpecularModel::blinn_phong_exact && !base.gain.is(0.0)) {
            const Value whole = shared("unreflected", "diffuse_weight_exact(i)");
            const Value where = all_zero(medium_) ? whole : call("where_outer", whole.text, {base.gain});
            left.light = product(left.light, where);
        }
    }
    const Value lambertian = Value::of(1.0 / std::numbers::pi);
    const Value colour = left.pixel.known ? product(albedo, product(lambertian, left.pixel))
                                          : product(product(albedo, lambertian), left.pixel);
    if (material_->diffuse == DiffuseModel::oren_nayar_full) {
        loop_.line(fmt::format("const oren_nayar_full_value scattered = {};", code.value));
        add_sum(true, "diffuse", product(Value::real("scattered.first"), left.light), colour);
        add_sum(true, "interreflected", product(Value::real("scattered.second"), left.light), product(albedo, colour));
        return;
    }
    const Value scattered = loop_.name("scattered", Value::real(std::string(code.value)));
    add_sum(true, "diffuse", product(scattered, left.light), colour);
}

void StackCode::add_sum(bool diffuse, const std::string& name, const Value& share, const Value& colour) {
    if (share.is(0.0) || colour.is(0.0)) {
        return;
    }
    const std::string light = light_here();
    if (!colour.grey) {
        const Value named = setup_.name(name + "_colour", colour);
        sums_.push_back({name, named, diffuse, {{light, loop_.name(name, share)}}});
        return;
    }
    // Grey: multiplied in at once, so that all such shares need one sum only.
    const Value scaled = product(setup_.name(name + "_colour", colour), share);
    for (LightSum& so_far : sums_) {
        if (so_far.diffuse != diffuse || !so_far.colour.is(1.0)) {
            continue;
        }
        LightSum::Term& last = so_far.terms.back();
        if (last.light == light && last.share.grey && scaled.grey) {
            last.share = loop_.name(name + "_sum", sum(last.share, scaled));
        } else {
            so_far.terms.push_back({light, loop_.name(name, scaled)});
        }
        return;
    }
    sums_.push_back({diffuse ? "diffuse" : "specular", Value::of(1.0), diffuse, {{light, loop_.name(name, scaled)}}});
}

Value StackCode::shared(const std::string& name, const std::string& expression) {
    if (shared_.insert(name).second) {
        loop_.line(fmt::format("const real {} = {};", name, expression));
    }
    return Value::real(name);
}

Value StackCode::schlick_weight(SpecularModel model) {
    return model == SpecularModel::blinn_phong ? shared("weight", "schlick_weight_gaussian(i)")
                                               : shared("weight_exact", "schlick_weight(i)");
}

} // namespace clshade
