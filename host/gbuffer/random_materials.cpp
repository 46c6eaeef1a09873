#include "host/gbuffer/random_materials.h"

#include "host/scene/metal_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace clshade {

namespace {

BoundParameter bound_to(const std::array<PlaneIndex, 3>& planes) {
    BoundParameter parameter;
    parameter.planes = planes;
    return parameter;
}

BoundParameter constant_of(const glm::dvec3& value) {
    BoundParameter parameter;
    parameter.constant = value;
    return parameter;
}

/// Chooses between planes and constants as a shape asks.
class Binder {
  public:
    Binder(const StackShape& shape, RandomGenerator& random, PlaneNames& names)
        : shape_(shape), random_(random), names_(names) {}

    /// One plane, or a constant out of `draw`.
    template <typename Draw>
    BoundParameter scalar(const std::string& name, Draw draw) {
        return takes_constant() ? constant_of(glm::dvec3(draw())) : one_plane(name);
    }

    /// Three planes (with constants about also a single one), or a constant out of `draw`.
    template <typename Draw>
    BoundParameter colour(const std::string& name, Draw draw, bool only_constant = false) {
        if (only_constant || takes_constant()) {
            return constant_of(draw());
        }
        const bool grey = shape_.some_constant && random_.below(4) == 0;
        return grey ? one_plane(name) : bound_to(names_.three(name, "RGB"));
    }

    BoundParameter shininess(const std::string& name) {
        return scalar(name, [&] { return random_shininess(random_, shape_.largest_shininess); });
    }

    BoundParameter tangent(const std::string& name) {
        return takes_constant() ? constant_of(random_tangent(random_, glm::dvec3(0.0)))
                                : bound_to(names_.three(name, "XYZ"));
    }

  private:
    bool takes_constant() { return shape_.some_constant && random_.below(2) == 0; }
    BoundParameter one_plane(const std::string& name) {
        const PlaneIndex plane = names_.one(name);
        return bound_to({plane, plane, plane});
    }

    const StackShape& shape_;
    RandomGenerator& random_;
    PlaneNames& names_;
};

bool has_spectral_below(const StackShape& shape, std::size_t k) {
    return std::any_of(shape.layers.begin() + static_cast<std::ptrdiff_t>(k) + 1, shape.layers.end(),
                       [](SpecularModel model) { return model == SpecularModel::blinn_phong_spectral; });
}

bool is_zero(const BoundParameter& parameter) {
    return parameter.is_constant() && parameter.constant == glm::dvec3(0.0);
}

Metal random_metal(RandomGenerator& random) {
    return built_in_metal(random.below(2) == 0 ? "gold" : "copper").value();
}

BoundLayer random_layer(const StackShape& shape, std::size_t k, RandomGenerator& random, Binder& binder) {
    const bool base = k + 1 == shape.layers.size();
    const std::string prefix = shape.layers.size() == 1 ? "" : fmt::format("Layer{}.", k + 1);
    BoundLayer layer;
    layer.specular = shape.layers[k];
    switch (layer.specular) {
    case SpecularModel::none:
        break;
    case SpecularModel::blinn_phong:
    case SpecularModel::blinn_phong_exact:
    case SpecularModel::blinn_phong_anisotropic:
        layer.f0 = binder.colour(
            prefix + "F0", [&] { return base ? random_colour(random) : random_coat_f0(random); },
            has_spectral_below(shape, k));
        break;
    case SpecularModel::blinn_phong_spectral:
        layer.metal = random_metal(random);
        break;
    }
    if (layer.specular == SpecularModel::blinn_phong_anisotropic) {
        layer.shininess_u = binder.shininess(prefix + "ShininessU");
        layer.shininess_v = binder.shininess(prefix + "ShininessV");
        layer.tangent = binder.tangent(prefix + "Tangent");
    } else if (layer.specular != SpecularModel::none) {
        layer.shininess = binder.shininess(prefix + "Shininess");
    }
    if (!base && shape.absorption != AbsorptionModel::none) {
        layer.absorption = binder.colour(prefix + "Absorption", [&] { return random_absorption(random); });
    }
    return layer;
}

} // namespace

PlaneIndex PlaneNames::one(const std::string& name) {
    names_->push_back(name);
    return static_cast<PlaneIndex>(names_->size()) - 1;
}

std::array<PlaneIndex, 3> PlaneNames::three(const std::string& layer, const char* suffixes) {
    std::array<PlaneIndex, 3> planes{};
    for (std::size_t i = 0; i < planes.size(); ++i) {
        planes[i] = one(layer + "." + suffixes[i]);
    }
    return planes;
}

BoundMaterial random_material(const StackShape& shape, RandomGenerator& random, PlaneNames& names) {
    Binder binder(shape, random, names);
    BoundMaterial material;
    material.name = "default";
    material.fresnel = shape.fresnel;
    material.absorption_ibl = shape.absorption_ibl;
    material.transmittance_ibl = shape.transmittance_ibl;
    material.ambient = shape.ambient;
    material.diffuse = shape.diffuse;
    if (shape.diffuse != DiffuseModel::none) {
        material.albedo = binder.colour("Albedo", [&] { return random_colour(random); });
    }
    material.layers.clear();
    for (std::size_t k = 0; k < shape.layers.size(); ++k) {
        material.layers.push_back(random_layer(shape, k, random, binder));
    }
    if (shape.diffuse != DiffuseModel::none && shape.diffuse != DiffuseModel::lambert) {
        material.diffuse_shininess = binder.shininess("DiffuseShininess");
    }
    const bool absorbs = std::any_of(material.layers.begin(), material.layers.end(),
                                     [](const BoundLayer& layer) { return !is_zero(layer.absorption); });
    material.absorption = absorbs ? shape.absorption : AbsorptionModel::none;
    return material;
}

LayerValues random_coat(RandomGenerator& random, double largest_shininess) {
    LayerValues values;
    values.f0 = random_coat_f0(random);
    values.absorption = random_absorption(random);
    values.shininess = random_shininess(random, largest_shininess);
    values.shininess_u = random_shininess(random, largest_shininess);
    values.shininess_v = random_shininess(random, largest_shininess);
    return values;
}

glm::dvec3 value_of(const BoundParameter& parameter, const glm::dvec3& drawn) {
    if (parameter.is_constant()) {
        return parameter.constant;
    }
    return parameter.is_grey() ? glm::dvec3(drawn.x) : drawn;
}

double lobe_shininess(const BoundLayer& layer, const LayerValues& drawn, RandomGenerator& random) {
    if (layer.specular != SpecularModel::blinn_phong_anisotropic) {
        return value_of(layer.shininess, glm::dvec3(drawn.shininess)).x;
    }
    return random.below(2) == 0 ? value_of(layer.shininess_u, glm::dvec3(drawn.shininess_u)).x
                                : value_of(layer.shininess_v, glm::dvec3(drawn.shininess_v)).x;
}

} // namespace clshade
