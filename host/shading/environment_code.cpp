#include "host/shading/environment_code.h"

#include "host/environment/filter_layout.h"
#include "host/shading/layer_constants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace clshade {

namespace {

bool zero(const Value& value) {
    return value.is(0.0);
}

/// A record's number as a kernel computes with it.
std::string record_text(std::size_t record) {
    return fmt::format("{}.0f", record);
}

bool grey_number(const Value& value) {
    return value.known && value.grey;
}

} // namespace

EnvironmentCode::EnvironmentCode(const BoundMaterial& material, const StackCode& stack, MapsLayout& maps)
    : material_(&material), stack_(&stack), maps_(&maps) {
    for (std::size_t k = 0; k < material_->layers.size(); ++k) {
        add_layer(k);
    }
    add_diffuse();
    end_.line(fmt::format("const rgb specular = {};", rgb_text(specular_)));
}

std::string EnvironmentCode::answering() const {
    return body_.text() + end_.text();
}

std::string EnvironmentCode::name(std::string_view what, std::size_t k) const {
    return material_->layers.size() == 1 ? std::string(what) : fmt::format("{}_{}", what, k);
}

std::string EnvironmentCode::ask(std::string_view type, const std::string& name, std::string_view function,
                                 const std::string& arguments) {
    if (requests_.insert(name).second) {
        members_ += fmt::format("    {}_request {};\n", type, name);
        asked_.line(fmt::format("{}(&q->{}, {});", function, name, arguments));
    }
    return name;
}

void EnvironmentCode::add_layer(std::size_t k) {
    if (facts(k).present) {
        add_lobe(k);
    }
    if (!is_base(k)) {
        if (facts(k).present) {
            pass(k);
        }
        absorb(k);
    }
}

void EnvironmentCode::add_lobe(std::size_t k) {
    const Value seen = radiance(k);
    const Value share = end_.name(name("reflected", k), product(reflected(k), reaching_));
    const Value own = end_.name(name("lobe", k), product(seen, share));
    specular_ = zero(specular_) ? own : end_.name(name("specular", k), sum(specular_, own));
}

Value EnvironmentCode::radiance(std::size_t k) {
    const LayerFacts& layer = facts(k);
    if (material_->layers[k].specular == SpecularModel::blinn_phong_anisotropic) {
        return streak_radiance(k);
    }
    const std::string request = name("seen", k);
    if (!layer.shininess.known) {
        maps_->ask_levels();
        return Value::rgb(
            fmt::format("answer_blend(around.maps, &q->{})",
                        ask("blend", request, "ask_radiance", "a.mirror, " + real_text(layer.shininess))));
    }
    const BlendedLevel level = maps_->ask_level(layer.shininess.number.x);
    return Value::rgb(
        fmt::format("answer_colour(around.maps, &q->{})",
                    ask("colour", request, "ask_colour",
                        fmt::format("tap_of_map(a.mirror, {}.0f, {})", level.cells, record_text(level.first)))));
}

Value EnvironmentCode::streak_radiance(std::size_t k) {
    const LayerFacts& layer = facts(k);
    const std::string streak = body_.declare("streak", name("streak", k),
                                             fmt::format("streak_of({}, {}, {})", layer.tangents,
                                                         real_text(layer.shininess_u), real_text(layer.shininess_v)));
    std::string map = "0.0f, 0.0f"; // none for one exponent: between levels
    if (layer.shininess_u.known && layer.shininess_v.known) {
        const BlendedLevel level =
            maps_->ask_level(streak_shininess(layer.shininess_u.number.x, layer.shininess_v.number.x));
        map = fmt::format("{}.0f, {}", level.cells, record_text(level.first));
    } else {
        maps_->ask_levels();
    }
    return end_.name(name("seen", k), Value::rgb(fmt::format("streak_at(around, s, {}, {})", streak, map)));
}

bool EnvironmentCode::is_linear(std::size_t k) const {
    const SpecularModel model = material_->layers[k].specular;
    return !is_exact() && (model == SpecularModel::blinn_phong || model == SpecularModel::blinn_phong_spectral);
}

Value EnvironmentCode::ambient_shininess(std::size_t k) {
    const LayerFacts& layer = facts(k);
    if (material_->layers[k].specular != SpecularModel::blinn_phong_anisotropic) {
        return layer.shininess;
    }
    const Value& u = layer.shininess_u;
    const Value& v = layer.shininess_v;
    if (u.known && v.known) {
        return Value::of(std::sqrt((u.number.x + 2.0) * (v.number.x + 2.0)) - 2.0);
    }
    return call("isotropic_shininess", {u, v});
}

Value EnvironmentCode::ambient_row(std::size_t k) {
    const Value shininess = ambient_shininess(k);
    if (shininess.known) {
        const double n = std::min(shininess.number.x, std::exp2(ambient_octaves) - 1.0);
        return Value::of(ambient_exponents * std::log2(n + 1.0) / ambient_octaves);
    }
    return Value::real(fmt::format("ambient_row({})", shininess.text));
}

Value EnvironmentCode::ambient(std::size_t k, const Value& scale_factor, const Value& bias_factor) {
    const Value shininess = ambient_shininess(k);
    if (shininess.known) {
        const auto curve = [&](double scale, double bias) {
            const std::size_t first = maps_->ask_curve(shininess.number.x, is_linear(k), scale, bias);
            return once(fmt::format("curve_{}", first),
                        [&] { return Value::real(fmt::format("ambient_curve_at(around, s.ne, {})", first)); });
        };
        if (grey_number(scale_factor) && grey_number(bias_factor)) {
            return curve(scale_factor.number.x, bias_factor.number.x);
        }
        if (scale_factor.known && bias_factor.known && bias_factor.number == scale_factor.number) {
            return product(scale_factor, curve(1.0, 1.0));
        }
        return sum(product(scale_factor, curve(1.0, 0.0)), product(bias_factor, curve(0.0, 1.0)));
    }
    const std::string request = ask("pair", name("ambient", k), "ask_pair",
                                    fmt::format("ambient_tap(s.ne, {}, {})", real_text(ambient_row(k)),
                                                is_linear(k) ? "AMBIENT_LINEAR" : "AMBIENT_EXACT"));
    const std::string pair = name("scale_bias", k);
    if (requests_.insert(pair).second) {
        end_.line(fmt::format("const pair {} = answer_pair(around.ambient, &q->{});", pair, request));
    }
    const Value scale = Value::real(pair + ".first");
    const Value bias = Value::real(pair + ".second");
    return sum(product(scale_factor, scale), product(bias_factor, bias));
}

Value EnvironmentCode::metallic(std::size_t k) {
    const std::size_t first = maps_->ask_metal(material_->layers[k].metal, is_linear(k));
    const std::string request =
        ask("colour", name("metallic", k), "ask_colour",
            fmt::format("ambient_tap(s.ne, {}, {})", real_text(ambient_row(k)), record_text(first)));
    return product(Value::rgb(fmt::format("answer_colour(around.maps, &q->{})", request)), facts(k).reflecting);
}

Value EnvironmentCode::reflected(std::size_t k) {
    const LayerFacts& layer = facts(k);
    const Value one = Value::of(1.0);
    const Value in_air = outer(k);
    const auto met_in_air = [&] {
        return material_->layers[k].specular == SpecularModel::blinn_phong_spectral
                   ? metallic(k)
                   : ambient(k, is_exact() ? layer.f0 : layer.r, present(k));
    };
    const auto met_inside = [&] {
        const Value inner = is_exact() ? fresnel(k) : layer.r;
        return inner.known ? ambient(k, inner, inner) : product(inner, ambient(k, one, one));
    };
    if (in_air.is(1.0)) {
        return met_in_air();
    }
    if (in_air.is(0.0)) {
        return met_inside();
    }
    return sum(product(in_air, met_in_air()), product(complement(in_air), met_inside()));
}

Value EnvironmentCode::present(std::size_t k) {
    const Value& f0 = facts(k).f0;
    if (is_base(k)) {
        return Value::of(1.0);
    }
    return f0.known ? Value::of(glm::dvec3(glm::greaterThan(f0.number, glm::dvec3(0.0))))
                    : once(name("present", k), [&] { return call("has_interface", {f0}); });
}

Value EnvironmentCode::outer(std::size_t k) {
    return once(name("in_air", k), [&] { return new_outer(k); });
}

Value EnvironmentCode::fresnel(std::size_t k) {
    return once(name("fresnel", k), [&] { return new_fresnel(k); });
}

Value EnvironmentCode::once(const std::string& name, const std::function<Value()>& make) {
    const auto found = made_.find(name);
    return found == made_.end() ? made_.emplace(name, body_.name(name, make())).first->second : found->second;
}

Value EnvironmentCode::new_outer(std::size_t k) const {
    const LayerFacts& layer = facts(k);
    if (zero(layer.above)) {
        return Value::of(1.0);
    }
    if (layer.inside) {
        return Value::of(0.0);
    }
    if (layer.above.known) {
        return Value::of(glm::dvec3(glm::equal(layer.above.number, glm::dvec3(0.0))));
    }
    return call("met_from_air", {layer.above});
}

Value EnvironmentCode::weight(SpecularModel model) {
    return model == SpecularModel::blinn_phong ? shared("weight", "schlick_weight_gaussian_of(2.0f * s.ne)")
                                               : shared("weight_exact", "schlick_weight_of(s.ne)");
}

Value EnvironmentCode::new_fresnel(std::size_t k) {
    const LayerFacts& layer = facts(k);
    if (!layer.metal.empty()) {
        return product(Value::rgb(fmt::format("{}(s.ne)", layer.metal)), layer.reflecting);
    }
    if (is_exact()) {
        const std::string square = shared("square", "s.ne * s.ne").text;
        const Value above = zero(layer.above)
                                ? Value::real("s.ne")
                                : body_.name(name("bent_above", k), call("refracted", square, {layer.above}));
        const Value below = body_.name(name("bent_below", k), call("refracted", square, {layer.below}));
        return call("interface_reflectance", square, {above, below, layer.above, layer.below});
    }
    return zero(layer.gain) ? layer.r : sum(layer.r, product(layer.gain, weight(material_->layers[k].specular)));
}

void EnvironmentCode::pass(std::size_t k) {
    const LayerFacts& layer = facts(k);
    const Value in_air = outer(k);
    const bool literal = material_->transmittance_ibl == AmbientTransmittance::none;
    Value f = literal && in_air.is(1.0) ? Value::of(0.0) : fresnel(k);
    if (literal && !in_air.is(1.0)) { // only where light comes from inside
        f = product(f, complement(in_air));
    }
    const Value through = body_.name(name("through", k), complement(f));
    if (is_exact()) {
        const Value both = body_.name(name("both", k), product(through, through));
        reaching_ = product(reaching_, both);
        entering_ = product(entering_, both);
    } else {
        reaching_ = product(reaching_, product(through, complement(layer.r)));
        // Where light comes from inside: 1 - r U in place of 1 - r.
        const Value inner = complement(product(layer.r, layer.up));
        const Value diffuse = in_air.is(1.0)   ? through
                              : in_air.is(0.0) ? inner
                                               : sum(product(in_air, through), product(complement(in_air), inner));
        entering_ = product(entering_, diffuse);
    }
    reaching_ = body_.name(name("reaching", k), reaching_);
    entering_ = body_.name(name("entering", k), entering_);
}

void EnvironmentCode::absorb(std::size_t k) {
    Value a = facts(k).absorption;
    if (material_->absorption == AbsorptionModel::none || zero(a)) {
        return;
    }
    const AmbientAbsorption form = material_->absorption_ibl;
    const bool exponential = form == AmbientAbsorption::exponential;
    if (material_->absorption == AbsorptionModel::original && !exponential) {
        a = a.known ? Value::of(folded_approximate_absorption(a.number))
                    : body_.name(name("approximate", k), call("approximate_absorption", {a}));
    }
    // The function takes N.E after the absorption.
    const auto left = [&](std::string_view function) {
        const std::string text =
            fmt::format("{}{}({}, s.inverse_ne)", function, a.grey ? "" : "_rgb", a.grey ? real_text(a) : rgb_text(a));
        return a.grey ? Value::real(text) : Value::rgb(text);
    };
    const Value specular = left(exponential ? "ambient_specular_exponential" : "ambient_specular_deck");
    Value diffuse;
    if (form == AmbientAbsorption::deck) {
        diffuse = left("ambient_diffuse_deck");
    } else if (form == AmbientAbsorption::clamped) {
        diffuse = left("ambient_diffuse_clamped");
    } else if (a.known) { // half of the exponent of the specular form
        const Value slanted = product(Value::of(0.5), a);
        const std::string text =
            fmt::format("ambient_specular_exponential{}({}, s.inverse_ne)", slanted.grey ? "" : "_rgb",
                        slanted.grey ? real_text(slanted) : rgb_text(slanted));
        diffuse = product(Value::of(folded_diffuse_transmittance(a.number)),
                          slanted.grey ? Value::real(text) : Value::rgb(text));
    } else {
        diffuse = left("ambient_diffuse_exponential");
    }
    reaching_ = body_.name(name("kept", k), product(reaching_, specular));
    entering_ = body_.name(name("kept_diffuse", k), product(entering_, diffuse));
}

std::string EnvironmentCode::diffuse_light() {
    if (material_->diffuse == DiffuseModel::lambert) {
        return "ambient_lambert(a)";
    }
    const std::string n = real_text(stack_->diffuse().shininess);
    const std::string terms = body_.declare(
        "oren_nayar_terms", "ambient_terms",
        material_->diffuse == DiffuseModel::oren_nayar ? "m.terms" : fmt::format("oren_nayar_terms_of({})", n));
    switch (material_->ambient) {
    case AmbientDiffuse::precise:
        break;
    case AmbientDiffuse::fit:
        return fmt::format("ambient_oren_nayar(a, ambient_fit({}, s.ne))", terms);
    case AmbientDiffuse::coarse:
        return fmt::format("ambient_oren_nayar(a, ambient_coarse({}, s.ne))", terms);
    case AmbientDiffuse::coarsest:
        return fmt::format("ambient_oren_nayar(a, ambient_coarsest({}, {}, s.ne))", terms, n);
    case AmbientDiffuse::full:
        return fmt::format("ambient_oren_nayar_full(a, ambient_full_constant({0}, {1}, s.ne, {2}), "
                           "linear_factor({0}, s.ne))",
                           terms, n, rgb_text(stack_->diffuse().albedo));
    case AmbientDiffuse::order1:
        return fmt::format("ambient_order1(around, a, s, {})", terms);
    }
    return fmt::format("ambient_oren_nayar(a, ambient_precise({}, s.ne))", terms);
}

void EnvironmentCode::add_diffuse() {
    if (material_->diffuse == DiffuseModel::none || zero(stack_->diffuse().albedo)) {
        body_.line("const rgb diffuse = grey(splat(0.0f));");
        return;
    }
    const std::size_t base = material_->layers.size() - 1;
    const LayerFacts& layer = facts(base);
    Value left = entering_;
    if (layer.present && is_exact()) {
        left = product(left, complement(fresnel(base)));
    } else if (layer.present) {
        left = product(left, complement(product(layer.r, layer.up)));
        if (material_->base().specular == SpecularModel::blinn_phong_exact) { // the cosine-weighted mean of (1 - NL)^5
            const Value in_air = outer(base);
            const Value unreflected = sum(Value::of(1.0), product(in_air, Value::of(-1.0 / 21.0)));
            left = product(left, unreflected);
        }
    }
    const Value colour = product(left, stack_->diffuse().albedo);
    const std::string light = diffuse_light();
    body_.line(fmt::format("const rgb diffuse = {};", rgb_text(product(Value::rgb(light), colour))));
}

Value EnvironmentCode::shared(const std::string& name, const std::string& expression) {
    if (shared_.insert(name).second) {
        body_.line(fmt::format("const real {} = {};", name, expression));
    }
    return Value::real(name);
}

} // namespace clshade
