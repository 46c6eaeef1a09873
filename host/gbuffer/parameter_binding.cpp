#include "host/gbuffer/parameter_binding.h"

#include "host/base/error.h"
#include "host/gbuffer/channel_layers.h"
#include "host/gbuffer/find_named.h"

#include <fmt/format.h>

#include <cstddef>
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

} // namespace

BoundParameter bind_role(PlaneTable& table, const RoleChoice& choice, Conversion convert) {
    BoundParameter bound = bind_channels(table, choice.channels);
    bound.convert = convert;
    return bound;
}

BoundMaterial bind_material(PlaneTable& table, const RoleAssignment& roles, const Material& material,
                            const AutomaticParameters& automatic) {
    const auto what = [&](const char* parameter) { return fmt::format("material '{}', {}", material.name, parameter); };
    const auto specular_shininess = [&] {
        return automatic.shininess
                   ? bind_automatic(table, roles,
                                    {{Role::roughness, Conversion::ggx_roughness}, {Role::shininess, Conversion::none}},
                                    material.specular.shininess, true, what("specular shininess"))
                   : bind(table, roles, material.specular.shininess, true, what("specular shininess"));
    };
    BoundMaterial bound;
    bound.name = material.name;
    bound.ids = material.ids;
    bound.specular = material.specular.model;
    bound.diffuse = material.diffuse.model;
    if (bound.specular != SpecularModel::none) {
        bound.f0 = automatic.f0 ? bind_automatic(table, roles, {{Role::f0, Conversion::none}}, material.specular.f0,
                                                 false, what("f0"))
                                : bind(table, roles, material.specular.f0, false, what("f0"));
        bound.shininess = specular_shininess();
    }
    if (bound.diffuse != DiffuseModel::none) {
        bound.albedo = automatic.albedo ? bind_automatic(table, roles, {{Role::albedo, Conversion::none}},
                                                         material.diffuse.albedo, false, what("albedo"))
                                        : bind(table, roles, material.diffuse.albedo, false, what("albedo"));
    }
    if (needs_diffuse_shininess(bound.diffuse)) {
        bound.diffuse_shininess = material.diffuse.shininess
                                      ? bind(table, roles, *material.diffuse.shininess, true, what("diffuse shininess"))
                                      : specular_shininess();
    }
    return bound;
}

} // namespace clshade
