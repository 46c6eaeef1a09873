// Private to host/shading: kernel code of one material under an environment (pixel rule 11; models.md sections 6, 7,
// 9).
#pragma once

#include "host/gbuffer/frame.h"
#include "host/shading/environment_layout.h"
#include "host/shading/stack_code.h"

#include <functional>
#include <map>
#include <set>
#include <string>

namespace clshade {

/// Writes the lines that reflect an environment's light from a stack: every layer's lobe by its ambient BRDF and a
/// lookup, the base's diffuse part by E/pi, and what the layers above leave of both.
class EnvironmentCode {
  public:
    /// Asks `maps` for what the material looks up.
    EnvironmentCode(const BoundMaterial& material, const StackCode& stack, MapsLayout& maps);

    /// Members of a struct `q` of requests, empty without any. Lookups are asked for before the lights are met and
    /// answered after them, since each takes long.
    [[nodiscard]] const std::string& requests() const { return members_; }
    /// Body of a function of (q, m, s, a).
    [[nodiscard]] const std::string& asking() const { return asked_.text(); }
    /// Body of a function of (q, m, s, a, around); names `diffuse` and `specular`, both rgb.
    [[nodiscard]] std::string answering() const;

  private:
    void add_layer(std::size_t k);
    void add_lobe(std::size_t k);
    void pass(std::size_t k);
    void absorb(std::size_t k);
    void add_diffuse();

    /// The radiance that the lobe sees.
    [[nodiscard]] Value radiance(std::size_t k);
    [[nodiscard]] Value streak_radiance(std::size_t k);
    /// The lobe's part of the light it sees: r scale + bias, r (scale + bias), or what a metal's table says.
    [[nodiscard]] Value reflected(std::size_t k);
    /// scale_factor scale + bias_factor bias.
    [[nodiscard]] Value ambient(std::size_t k, const Value& scale_factor, const Value& bias_factor);
    /// A metal's own table.
    [[nodiscard]] Value metallic(std::size_t k);
    /// The exponent for the ambient tables.
    [[nodiscard]] Value ambient_shininess(std::size_t k);
    /// Row of the ambient tables for an exponent.
    [[nodiscard]] Value ambient_row(std::size_t k);
    [[nodiscard]] bool is_linear(std::size_t k) const;
    /// F of the interface at N.E.
    [[nodiscard]] Value fresnel(std::size_t k);
    /// 1 in the channels where there is an interface, 0 where an f0 of 0 above the base leaves none.
    [[nodiscard]] Value present(std::size_t k);
    /// 1 in the channels where light meets the interface in air.
    [[nodiscard]] Value outer(std::size_t k);
    [[nodiscard]] Value new_fresnel(std::size_t k);
    [[nodiscard]] Value new_outer(std::size_t k) const;
    /// A value by its name, written when first asked for.
    [[nodiscard]] Value once(const std::string& name, const std::function<Value()>& make);
    [[nodiscard]] Value shared(const std::string& name, const std::string& expression);
    [[nodiscard]] Value weight(SpecularModel model);
    /// E/pi of the diffuse model.
    [[nodiscard]] std::string diffuse_light();
    /// A request of that type, asked for by a call with these arguments; its name.
    [[nodiscard]] std::string ask(std::string_view type, const std::string& name, std::string_view function,
                                  const std::string& arguments);

    [[nodiscard]] const LayerFacts& facts(std::size_t k) const { return stack_->layers()[k]; }
    [[nodiscard]] bool is_base(std::size_t k) const { return k + 1 == material_->layers.size(); }
    [[nodiscard]] bool is_exact() const { return material_->fresnel == FresnelModel::exact; }
    [[nodiscard]] std::string name(std::string_view what, std::size_t k) const;

    const BoundMaterial* material_;
    const StackCode* stack_;
    MapsLayout* maps_;
    std::string members_;
    CodeBlock asked_{4};
    CodeBlock body_{4};
    CodeBlock end_{4}; ///< what needs the answers
    std::set<std::string> shared_;
    std::map<std::string, Value> made_;
    std::set<std::string> requests_;
    Value reaching_ = Value::of(1.0); ///< of the light for the lobe at hand: prod T As
    Value entering_ = Value::of(1.0); ///< of the light for the base's diffuse part: prod Td Ad
    Value specular_ = Value::of(0.0);
};

} // namespace clshade
