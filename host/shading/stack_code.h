// Private to host/shading: kernel code of one stack of layers (pixel rule 9; models.md section 5).
#pragma once

#include "host/gbuffer/frame.h"
#include "host/shading/code_value.h"
#include "host/shading/metal_curve.h"
#include "host/shading/parameter_code.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace clshade {

/// Where light is added up: one sum for every colour that is multiplied in at the end.
struct LightSum {
    /// What of the light that has come so far is reflected.
    struct Term {
        std::string light; ///< the tinted irradiance
        Value share;
    };
    std::string name; ///< of the member of the sums
    Value colour;     ///< multiplied in after the loop over the lights
    bool diffuse = false;
    std::vector<Term> terms;
};

/// What a stack's code knows of a layer, for the light of an environment. Values hold once `setup` has run.
struct LayerFacts {
    bool present = false;              ///< it has an interface
    Value f0 = Value::of(0.0);         ///< in air
    Value r = Value::of(0.0);          ///< constant model: at normal incidence
    Value gain = Value::of(0.0);       ///< constant model: F = r + gain weight
    Value above = Value::of(0.0);      ///< amplitude of the medium above
    Value below = Value::of(0.0);      ///< and of the one below
    bool inside = false;               ///< never met from air
    Value up = Value::of(1.0);         ///< U of rule 9
    std::string metal;                 ///< function of its Fresnel curve, if it has one
    Value reflecting = Value::of(1.0); ///< of a metal: 1 in the channels where it has an interface
    Value shininess = Value::of(0.0);
    Value shininess_u = Value::of(0.0);
    Value shininess_v = Value::of(0.0);
    std::string tangents; ///< the tangent frame of an anisotropic layer
    Value absorption = Value::of(0.0);
};

/// The same of the base's diffuse part.
struct DiffuseFacts {
    Value albedo = Value::of(0.0);
    Value shininess = Value::of(0.0);
};

/// Writes a material's code, layer by layer, top first: what a pixel does once (`setup`, which fills the struct `m`),
/// what it does for every light (`light`), and the sums over the lights with the colours that are multiplied in at the
/// end.
class StackCode {
  public:
    StackCode(const Frame& frame, std::size_t material);

    /// Functions that the material's own call: curves of metals.
    [[nodiscard]] const std::string& functions() const { return functions_; }
    [[nodiscard]] const CodeBlock& setup() const { return setup_; }
    [[nodiscard]] const std::string& light() const { return loop_.text(); }
    [[nodiscard]] const std::vector<LightSum>& sums() const { return sums_; }
    /// Expressions of type mask, to be used in `setup`.
    [[nodiscard]] const MaskNames& clamped() const { return reader_.clamped(); }
    [[nodiscard]] const MaskNames& no_tangent() const { return no_tangent_; }
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
    /// Top first.
    [[nodiscard]] const std::vector<LayerFacts>& layers() const { return layers_; }
    [[nodiscard]] const DiffuseFacts& diffuse() const { return diffuse_facts_; }

  private:
    /// An interface as light meets it: F = r + gain weight in the constant model, `fresnel` for metals and in the exact
    /// one.
    struct Interface {
        bool present = false;
        Value r = Value::of(0.0);
        Value gain = Value::of(0.0);
        Value weight = Value::of(0.0);
        std::optional<Value> fresnel; ///< varies with the light in a way of its own: metals, exact model
    };
    /// What is left of light, on its way down and up again through the layers above: a part that depends on the pixel
    /// only and a part that depends on the light.
    struct Passage {
        Value pixel = Value::of(1.0);
        Value light = Value::of(1.0);
    };

    void add_layer(std::size_t k);
    void add_base_diffuse(const Interface& base);
    /// Reads F0 and sets amplitude_. False: the layer has no interface.
    [[nodiscard]] bool read_f0(std::size_t k, Value& f0);
    [[nodiscard]] Interface constant_interface(std::size_t k);
    [[nodiscard]] Interface exact_interface(std::size_t k);
    /// Of the metal at hand: 1 in the channels where it has an interface, 0 where its spectrum left none above the
    /// base.
    [[nodiscard]] Value reflecting(std::size_t k) const;
    /// Writes the polynomial of a metal and returns a call of it.
    [[nodiscard]] Value metal_call(std::size_t k, const MetalSurroundings& where);
    void add_lobe(std::size_t k, const Interface& interface);
    void pass(std::size_t k, const Interface& interface);
    void absorb(std::size_t k);

    // Values of the light at hand that several layers use; written when first asked for.
    [[nodiscard]] Value shared(const std::string& name, const std::string& expression);
    [[nodiscard]] Value schlick_weight(SpecularModel model);
    /// Name of the irradiance that reaches the interface at hand and comes back.
    [[nodiscard]] std::string light_here();

    void add_sum(bool diffuse, const std::string& name, const Value& share, const Value& colour);

    [[nodiscard]] bool is_base(std::size_t k) const { return k + 1 == material_->layers.size(); }
    [[nodiscard]] bool is_exact() const { return material_->fresnel == FresnelModel::exact; }
    /// "shininess", or "shininess_2" in a stack.
    [[nodiscard]] std::string name(std::string_view what, std::size_t k) const;

    const BoundMaterial* material_;
    std::size_t index_;
    std::string functions_;
    CodeBlock setup_{4, "m"};
    CodeBlock loop_{4};
    ParameterReader reader_;
    std::set<std::string> shared_;
    std::vector<LightSum> sums_;
    MaskNames no_tangent_;
    std::vector<std::string> warnings_;
    std::vector<LayerFacts> layers_;
    DiffuseFacts diffuse_facts_;

    // State while going down.
    Value medium_ = Value::of(0.0);    ///< amplitude of the medium above the layer at hand
    Value amplitude_ = Value::of(0.0); ///< of the layer at hand, against air
    bool inside_ = false;              ///< medium_ is above 0 in every channel of every pixel
    Value below_ = Value::of(0.0);     ///< of the medium below its interface
    Value refracted_ = Value::of(0.0); ///< exact model: cosine in the medium above, as `refracted` gives it
    Value bent_ = Value::of(0.0);      ///< exact model: the same in the medium below
    Value up_ = Value::of(1.0);        ///< constant model: U, product of 1 - r
    Passage specular_;                 ///< to the interface at hand and back
    Passage diffuse_;
    Value light_ = Value::rgb("e0"); ///< irradiance in the medium above
    Value pending_ = Value::of(1.0); ///< transmittance not yet applied to it (approximated absorption)
    Value depth_ = Value::of(0.0);   ///< exponent of 2 of the transmittance down to here (original absorption)
    bool deeper_ = false;            ///< depth_ has grown since light_ was named
    int tints_ = 0;
    std::string tangents_; ///< text of the tangent frame of the layer at hand
};

} // namespace clshade
