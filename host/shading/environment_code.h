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
    EnvironmentCode(const Frame& frame, std::size_t material, const StackCode& stack, const MapsLayout& layout);

    /// Body of a function of (m, s, a, around); names `diffuse` and `specular`, both rgb.
    [[nodiscard]] const std::string& text() const { return body_.text(); }

  private:
    void add_layer(std::size_t k);
    void add_lobe(std::size_t k);
    void pass(std::size_t k);
    void absorb(std::size_t k);
    void add_diffuse();

    /// The radiance that the lobe sees.
    [[nodiscard]] Value radiance(std::size_t k);
    /// The lobe's part of the light it sees: r scale + bias, r (scale + bias), or what a metal's table says.
    [[nodiscard]] Value reflected(std::size_t k);
    /// F of the interface at N.E.
    [[nodiscard]] Value fresnel(std::size_t k);
    /// 1 in the channels where light meets the interface in air.
    [[nodiscard]] Value outer(std::size_t k);
    [[nodiscard]] Value new_fresnel(std::size_t k);
    [[nodiscard]] Value new_outer(std::size_t k) const;
    /// A value by its name, written when first asked for.
    [[nodiscard]] Value once(const std::string& name, const std::function<Value()>& make);
    /// Row of the ambient tables for an exponent.
    [[nodiscard]] Value ambient_row(const Value& shininess, std::size_t k);
    [[nodiscard]] Value shared(const std::string& name, const std::string& expression);
    [[nodiscard]] Value weight(SpecularModel model);
    /// E/pi of the diffuse model.
    [[nodiscard]] std::string diffuse_light();

    [[nodiscard]] const LayerFacts& facts(std::size_t k) const { return stack_->layers()[k]; }
    [[nodiscard]] bool is_base(std::size_t k) const { return k + 1 == material_->layers.size(); }
    [[nodiscard]] bool is_exact() const { return material_->fresnel == FresnelModel::exact; }
    [[nodiscard]] std::string name(std::string_view what, std::size_t k) const;

    const BoundMaterial* material_;
    std::size_t index_;
    const StackCode* stack_;
    const MapsLayout* layout_;
    CodeBlock body_{4};
    std::set<std::string> shared_;
    std::map<std::string, Value> made_;
    Value reaching_ = Value::of(1.0); ///< of the light for the lobe at hand: prod T As
    Value entering_ = Value::of(1.0); ///< of the light for the base's diffuse part: prod Td Ad
    Value specular_ = Value::of(0.0);
};

} // namespace clshade
