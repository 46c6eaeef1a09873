#include "host/gbuffer/parameter_binding.h"

#include "host/base/error.h"
#include "host/gbuffer/channel_layers.h"
#include "host/gbuffer/find_named.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>

namespace clshade {

namespace {

/// Scale, offset and conversion folded into a constant (pixel rule 6), so that no evaluator need ask.
double fold(double value, const Parameter& parameter) {
    constexpr double upper_clamp = 65536.0; // what division by zero gives
    const auto ratio = [](double numerator, double denominator) {
        return denominator > 0.0 ? numerator / denominator : upper_clamp + 2.0;
    };
    const double x = value * parameter.scale + parameter.offset;
    const auto ggx = [&](double r) { return ratio(2.0, r * r * r * r) - 2.0; };
    switch (parameter.convert) {
    case Conversion::none:
        return x;
    case Conversion::ggx_roughness:
        return ggx(x);
    case Conversion::smoothness:
        return ggx(1.0 - x);
    case Conversion::oren_nayar_sigma:
        return ratio(2.0, x * x);
    case Conversion::index_of_refraction: {
        const double n = std::max(x, 1.0);
        const double root = (n - 1.0) / (n + 1.0);
        return root * root;
    }
    }
    return x;
}

BoundParameter bind_channels(PlaneTable& table, const std::vector<int>& channels) {
    BoundParameter bound;
    for (std::size_t i = 0; i < 3; ++i) {
        bound.planes[i] = table.add(channels.size() == 3 ? channels[i] : channels.front());
    }
    bound.averaged = true;
    return bound;
}

/// A parameter of a material; `scalar` ones take one channel only.
BoundParameter bind(PlaneTable& table, const RoleAssignment& roles, const Parameter& parameter, bool scalar,
                    const std::string& what) {
    if (parameter.is_constant()) {
        BoundParameter bound;
        for (int i = 0; i < 3; ++i) {
            bound.constant[i] = fold(parameter.constant[i], parameter);
        }
        return bound;
    }
    const std::vector<int> channels = find_channels(table.layout(), roles, parameter, what);
    if (scalar && channels.size() != 1) {
        throw UsageError(fmt::format("{}: '{}' has {} channels and one is needed; name one, such as '{}'",
                                     located(parameter.where, what), parameter.channels.front(), channels.size(),
                                     table.layout().channels[static_cast<std::size_t>(channels.front())].name));
    }
    BoundParameter bound = bind_channels(table, channels);
    bound.scale = parameter.scale;
    bound.offset = parameter.offset;
    bound.convert = parameter.convert;
    return bound;
}

/// An automatic parameter takes the first of these roles that the file has.
struct Source {
    Role role;
    Conversion convert;
};

BoundParameter bind_automatic(PlaneTable& table, const RoleAssignment& roles, std::initializer_list<Source> sources,
                              const Parameter& fallback, bool scalar, const std::string& what) {
    for (const Source& source : sources) {
        const RoleChoice& choice = roles[source.role];
        if (!choice.ambiguous.empty()) {
            throw UsageError(fmt::format("{}: {}: role '{}' may be {}; say which in [gbuffer]", table.layout().file,
                                         what, name_of(source.role), list_names(choice.ambiguous)));
        }
        if (!choice.channels.empty()) {
            return bind_role(table, choice, source.convert);
        }
    }
    return bind(table, roles, fallback, scalar, what);
}

bool needs_diffuse_shininess(DiffuseModel model) {
    return model != DiffuseModel::none && model != DiffuseModel::lambert;
}

bool needs_f0(SpecularModel model) {
    return model != SpecularModel::none && model != SpecularModel::blinn_phong_spectral;
}

bool is_zero(const BoundParameter& parameter) {
    return parameter.is_constant() && parameter.constant == glm::dvec3(0.0);
}

/// Where to point a message about a layer.
const SourceLocation& place_of(const Material& material, const Layer& layer) {
    return layer.where.file.empty() ? material.where : layer.where;
}

/// Binds one material; holds what every step needs.
class MaterialBinder {
  public:
    MaterialBinder(PlaneTable& table, const RoleAssignment& roles, const Material& material,
                   const AutomaticParameters& automatic)
        : table_(table), roles_(roles), material_(material), automatic_(automatic) {}

    [[nodiscard]] BoundMaterial bind_all() {
        BoundMaterial bound;
        bound.name = material_.name;
        bound.ids = material_.ids;
        bound.fresnel = material_.fresnel;
        bound.absorption_ibl = material_.absorption_ibl;
        bound.transmittance_ibl = material_.transmittance_ibl;
        bound.layers.clear();
        for (std::size_t k = 0; k < material_.layers.size(); ++k) {
            bound.layers.push_back(bind_layer(k));
        }
        check_spectral(bound);
        const bool absorbs = std::any_of(bound.layers.begin(), bound.layers.end(),
                                         [](const BoundLayer& layer) { return !is_zero(layer.absorption); });
        bound.absorption = absorbs ? material_.absorption_model : AbsorptionModel::none;
        bind_diffuse(bound);
        return bound;
    }

  private:
    [[nodiscard]] std::size_t base() const { return material_.layers.size() - 1; }

    /// "material 'paint', layer 2"
    [[nodiscard]] std::string layer_text(std::size_t k) const {
        return fmt::format("material '{}', layer {}", material_.name, k + 1);
    }
    /// "material 'paint', layer 2, f0"; a stack of one has no layer numbers.
    [[nodiscard]] std::string what(std::size_t k, const char* parameter) const {
        return material_.layers.size() == 1 ? what(parameter) : fmt::format("{}, {}", layer_text(k), parameter);
    }
    [[nodiscard]] std::string what(const char* parameter) const {
        return fmt::format("material '{}', {}", material_.name, parameter);
    }
    [[noreturn]] void fail(std::size_t k, const std::string& message) const {
        throw UsageError(
            fmt::format("{}: {}", located(place_of(material_, material_.layers[k]), layer_text(k)), message));
    }

    BoundParameter bind_scalar(const Parameter& parameter, const std::string& text) {
        return bind(table_, roles_, parameter, true, text);
    }
    BoundParameter bind_colour(const Parameter& parameter, const std::string& text) {
        return bind(table_, roles_, parameter, false, text);
    }

    BoundLayer bind_layer(std::size_t k) {
        const Layer& layer = material_.layers[k];
        const Specular& specular = layer.specular;
        BoundLayer bound;
        bound.specular = specular.model;
        if (needs_f0(specular.model)) {
            bound.f0 = k == base() && automatic_.f0 ? bind_automatic(table_, roles_, {{Role::f0, Conversion::none}},
                                                                     specular.f0, false, what(k, "f0"))
                                                    : bind_colour(specular.f0, what(k, "f0"));
        }
        if (specular.model == SpecularModel::blinn_phong_anisotropic) {
            bound.shininess_u = bind_scalar(specular.shininess_u, what(k, "specular shininess_u"));
            bound.shininess_v = bind_scalar(specular.shininess_v, what(k, "specular shininess_v"));
            bound.tangent = bind_tangent(k);
        } else if (specular.model != SpecularModel::none) {
            bound.shininess = bind_shininess(k);
        }
        if (specular.model == SpecularModel::blinn_phong_spectral) {
            bound.metal = specular.metal;
        }
        if (k != base() && material_.absorption_model != AbsorptionModel::none) {
            bound.absorption = bind_colour(layer.absorption, what(k, "absorption"));
        }
        return bound;
    }

    BoundParameter bind_shininess(std::size_t k) {
        const Parameter& shininess = material_.layers[k].specular.shininess;
        const std::string text = what(k, "specular shininess");
        if (k == base() && automatic_.shininess) {
            return bind_automatic(table_, roles_,
                                  {{Role::roughness, Conversion::ggx_roughness}, {Role::shininess, Conversion::none}},
                                  shininess, true, text);
        }
        return bind_scalar(shininess, text);
    }

    BoundParameter bind_tangent(std::size_t k) {
        const std::optional<Parameter>& tangent = material_.layers[k].specular.tangent;
        if (!tangent) {
            return bind_tangent_role(k);
        }
        const std::string text = what(k, "tangent");
        if (tangent->scale != 1.0 || tangent->offset != 0.0 || tangent->convert != Conversion::none) {
            throw UsageError(fmt::format("{}: a tangent takes no scale, offset or convert; write normal_encoding in "
                                         "[gbuffer] if the planes hold 0..1",
                                         located(tangent->where, text)));
        }
        if (tangent->is_constant()) {
            BoundParameter bound;
            bound.constant = tangent->constant;
            return bound;
        }
        const std::vector<int> channels = find_channels(table_.layout(), roles_, *tangent, text);
        if (channels.size() != 3) {
            throw UsageError(fmt::format("{}: '{}' is one channel and three are needed (X, Y, Z)",
                                         located(tangent->where, text), tangent->channels.front()));
        }
        return bind_channels(table_, channels);
    }

    BoundParameter bind_tangent_role(std::size_t k) {
        const RoleChoice& choice = roles_[Role::tangent];
        const std::string& file = table_.layout().file;
        if (!choice.ambiguous.empty()) {
            fail(k, fmt::format("blinn_phong_anisotropic needs a tangent, and the tangent role of {} may be {}; say "
                                "which in [gbuffer]",
                                file, list_names(choice.ambiguous)));
        }
        if (choice.channels.size() != 3) {
            fail(k, fmt::format("blinn_phong_anisotropic needs a tangent and {} has no tangent role; write tangent = "
                                "[0, 0, 1] (world space) or map tangent in [gbuffer]",
                                file));
        }
        return bind_role(table_, choice);
    }

    /// Tables of a spectral layer are baked for one medium above it.
    void check_spectral(const BoundMaterial& bound) const {
        for (std::size_t k = 0; k < bound.layers.size(); ++k) {
            if (bound.layers[k].specular != SpecularModel::blinn_phong_spectral) {
                continue;
            }
            for (std::size_t j = 0; j < k; ++j) {
                if (!bound.layers[j].f0.is_constant()) {
                    fail(j, fmt::format("f0 comes from channels, but layer {} below it is blinn_phong_spectral, whose "
                                        "tables need a constant; write a number (or ior) for f0 of layer {}",
                                        k + 1, j + 1));
                }
            }
        }
    }

    void bind_diffuse(BoundMaterial& bound) {
        const Diffuse& diffuse = material_.diffuse;
        bound.diffuse = diffuse.model;
        bound.ambient = diffuse.ambient;
        if (bound.diffuse != DiffuseModel::none) {
            bound.albedo = automatic_.albedo ? bind_automatic(table_, roles_, {{Role::albedo, Conversion::none}},
                                                              diffuse.albedo, false, what("albedo"))
                                             : bind_colour(diffuse.albedo, what("albedo"));
        }
        if (needs_diffuse_shininess(bound.diffuse)) {
            bound.diffuse_shininess =
                diffuse.shininess ? bind_scalar(*diffuse.shininess, what("diffuse shininess")) : bind_shininess(base());
        }
    }

    PlaneTable& table_;
    const RoleAssignment& roles_;
    const Material& material_;
    const AutomaticParameters& automatic_;
};

} // namespace

BoundParameter bind_role(PlaneTable& table, const RoleChoice& choice, Conversion convert) {
    BoundParameter bound = bind_channels(table, choice.channels);
    bound.convert = convert;
    return bound;
}

BoundMaterial bind_material(PlaneTable& table, const RoleAssignment& roles, const Material& material,
                            const AutomaticParameters& automatic) {
    return MaterialBinder(table, roles, material, automatic).bind_all();
}

} // namespace clshade
