#include "host/reference/environment_light.h"

#include "host/reference/layers.h"
#include "host/reference/preintegrated_absorption.h"
#include "host/reference/sh_oren_nayar.h"

#include <algorithm>
#include <cmath>

namespace clshade::reference {

namespace {

glm::dvec3 select(const glm::bvec3& condition, const glm::dvec3& yes, const glm::dvec3& no) {
    return glm::mix(no, yes, condition);
}

/// S_k: what a lobe in air, or inside the stack, makes of L.
glm::dvec3 split_sum(const LayerValues& layer, FresnelModel model, double x, const LayerAmbient& ambient) {
    const Interface& interface = layer.interface;
    const double a = ambient.brdf.scale + ambient.brdf.bias;
    const glm::dvec3 outer = layer.specular == SpecularModel::blinn_phong_spectral
                                 ? ambient.metal
                                 : interface.r * ambient.brdf.scale + ambient.brdf.bias;
    const glm::dvec3 inside = (model == FresnelModel::exact ? interface_fresnel(layer, model, x) : interface.r) * a;
    return select(interface.present, select(interface.outer, outer, inside), glm::dvec3(0.0));
}

/// Absorption of a layer's medium, in the coefficient that section 7's form wants.
PreintegratedAbsorption medium_absorption(const MaterialValues& material, const LayerValues& layer, double x) {
    glm::dvec3 a = layer.absorption;
    switch (material.absorption) {
    case AbsorptionModel::none:
        return {};
    case AbsorptionModel::approximated:
        break;
    case AbsorptionModel::original: // section 5: a' = (1 - exp(-2 alpha d))/2
        if (material.absorption_ibl != AmbientAbsorption::exponential) {
            a = 0.5 * (1.0 - glm::exp(-2.0 * a));
        }
        break;
    }
    return preintegrated_absorption(material.absorption_ibl, a, x);
}

/// What the base's own interface leaves to the diffuse part.
glm::dvec3 base_weight(const MaterialValues& material, double x, const glm::dvec3& u) {
    const LayerValues& base = material.base();
    if (material.fresnel == FresnelModel::exact) {
        return 1.0 - interface_fresnel(base, material.fresnel, x);
    }
    const glm::dvec3 weight = 1.0 - base.interface.r * u;
    if (base.specular != SpecularModel::blinn_phong_exact) {
        return weight;
    }
    // Section 6: 20/21 is the cosine-weighted mean of 1 - (1 - NL)^5.
    return select(base.interface.outer, weight * (20.0 / 21.0), weight);
}

struct Node {
    double z;
    double weight;
};
/// Gauss-Hermite for a normal distribution of variance 1, as rule 11 prints it.
constexpr std::array<Node, 5> hermite{{{0.0, 8.0 / 15.0},
                                       {1.3556262, 0.22207592},
                                       {-1.3556262, 0.22207592},
                                       {2.8569700, 0.011257411},
                                       {-2.8569700, 0.011257411}}};

glm::dvec3 gathered_along_axis(const LayerValues& layer, const PreparedEnvironment& environment,
                               const glm::dvec3& normal, const glm::dvec3& eye) {
    const bool along_tangent = layer.shininess_u <= layer.shininess_v;
    const glm::dvec3 axis = along_tangent ? layer.frame.tangent : layer.frame.bitangent;
    const double wide = 1.0 / std::max(std::min(layer.shininess_u, layer.shininess_v), 1.0);
    const double narrow = std::max(1.0 / std::max(std::max(layer.shininess_u, layer.shininess_v), 1.0), wide / 8.0);
    const double step = std::sqrt(std::max(wide - narrow, 0.0));
    glm::dvec3 sum(0.0);
    for (const Node& node : hermite) {
        const glm::dvec3 half = normal + node.z * step * axis;
        const glm::dvec3 reflected = 2.0 * glm::dot(half, eye) / glm::dot(half, half) * half - eye;
        sum += node.weight * environment.radiance(reflected, 1.0 / narrow);
    }
    return sum;
}

/// t of rule 11.
glm::dvec3 tangential_eye(const glm::dvec3& normal, const glm::dvec3& eye) {
    const glm::dvec3 t = eye - glm::dot(normal, eye) * normal;
    const double length = glm::length(t);
    return length < 1e-6 ? glm::dvec3(0.0) : t / length;
}

} // namespace

double ambient_shininess(const LayerValues& layer) {
    if (layer.specular == SpecularModel::blinn_phong_anisotropic) {
        return std::sqrt((layer.shininess_u + 2.0) * (layer.shininess_v + 2.0)) - 2.0;
    }
    return layer.shininess;
}

Normaliser ambient_normaliser(const LayerValues& layer, FresnelModel model) {
    const bool linear_lobe =
        layer.specular == SpecularModel::blinn_phong || layer.specular == SpecularModel::blinn_phong_spectral;
    return linear_lobe && model == FresnelModel::constant ? Normaliser::linear : Normaliser::exact;
}

LayerAmbient layer_ambient(const LayerValues& layer, FresnelModel model, double x) {
    const double n = ambient_shininess(layer);
    const Normaliser normaliser = ambient_normaliser(layer, model);
    LayerAmbient ambient;
    ambient.brdf = ambient_brdf_of_table(n, x, normaliser);
    if (layer.specular == SpecularModel::blinn_phong_spectral && glm::any(layer.interface.outer)) {
        ambient.metal = layer.metal_ambient->of_table(n, x, normaliser);
    }
    return ambient;
}

AmbientWeights ambient_weights(const MaterialValues& material, double x,
                               const std::array<LayerAmbient, most_layers>& ambient) {
    const bool exact = material.fresnel == FresnelModel::exact;
    const bool all_enters = material.transmittance_ibl == AmbientTransmittance::none;
    const std::span<const LayerValues> layers = material.layers();
    AmbientWeights weights;
    glm::dvec3 above(1.0); // prod T_j As_j
    glm::dvec3 u(1.0);     // U_k of layers.h
    for (std::size_t k = 0; k < layers.size(); ++k) {
        const LayerValues& layer = layers[k];
        weights.specular[k] = split_sum(layer, material.fresnel, x, ambient[k]) * above;
        if (k + 1 == layers.size()) {
            weights.diffuse *= base_weight(material, x, u);
            break;
        }
        const glm::dvec3 r = layer.interface.r;
        const glm::dvec3 reflected = interface_fresnel(layer, material.fresnel, x);
        const glm::dvec3 f = all_enters ? select(layer.interface.outer, glm::dvec3(0.0), reflected) : reflected;
        const glm::dvec3 through = (1.0 - f) * (exact ? 1.0 - f : 1.0 - r);
        const PreintegratedAbsorption absorption = medium_absorption(material, layer, x);
        weights.diffuse *= (exact ? through : select(layer.interface.outer, 1.0 - f, 1.0 - r * u)) * absorption.diffuse;
        above *= through * absorption.specular;
        u *= 1.0 - r;
    }
    return weights;
}

glm::dvec3 diffuse_response(const MaterialValues& material, double x, const DiffuseLight& light) {
    switch (material.diffuse) {
    case DiffuseModel::none:
        return glm::dvec3(0.0);
    case DiffuseModel::lambert:
        return glm::max(light.all(), glm::dvec3(0.0));
    case DiffuseModel::oren_nayar:
    case DiffuseModel::oren_nayar_full:
    case DiffuseModel::oren_nayar_qualitative:
    case DiffuseModel::oren_nayar_simplified_1:
    case DiffuseModel::oren_nayar_simplified_2:
    case DiffuseModel::oren_nayar_shininess:
        break;
    }
    const double n = material.diffuse_shininess;
    const glm::dvec3 d = sh_dc_factor(material.ambient, n, x, material.albedo);
    const double s = sh_linear_factor(n, x);
    glm::dvec3 sum = d * light.constant + s * (light.linear + light.rest);
    if (material.ambient == AmbientDiffuse::order1) { // 9.5
        const ShLinearExact exact = sh_linear_exact(n, x);
        sum = d * light.constant + s * light.rest + 1.5 * exact.along_normal * light.linear +
              exact.along_tangent * light.tangent;
    }
    return glm::max(sum, glm::dvec3(0.0));
}

glm::dvec3 gathered_radiance(const LayerValues& layer, const PreparedEnvironment& environment, const glm::dvec3& normal,
                             const glm::dvec3& eye) {
    if (layer.specular == SpecularModel::blinn_phong_anisotropic) {
        return gathered_along_axis(layer, environment, normal, eye);
    }
    const double x = std::max(glm::dot(normal, eye), 1e-4);
    return environment.radiance(2.0 * x * normal - eye, layer.shininess);
}

EnvironmentLight environment_light(const MaterialValues& material, const PreparedEnvironment& environment,
                                   const glm::dvec3& normal, const glm::dvec3& eye) {
    const double x = std::clamp(glm::dot(normal, eye), 1e-4, 1.0);
    const std::span<const LayerValues> layers = material.layers();
    std::array<LayerAmbient, most_layers> ambient{};
    for (std::size_t k = 0; k < layers.size(); ++k) {
        if (layers[k].specular != SpecularModel::none) {
            ambient[k] = layer_ambient(layers[k], material.fresnel, x);
        }
    }
    const AmbientWeights weights = ambient_weights(material, x, ambient);
    EnvironmentLight light;
    for (std::size_t k = 0; k < layers.size(); ++k) {
        if (glm::any(layers[k].interface.present)) {
            light.specular += weights.specular[k] * gathered_radiance(layers[k], environment, normal, eye);
        }
    }
    if (material.diffuse != DiffuseModel::none) {
        const DiffuseLight diffuse = environment.diffuse_light(normal, tangential_eye(normal, eye));
        light.diffuse = material.albedo * weights.diffuse * diffuse_response(material, x, diffuse);
    }
    return light;
}

} // namespace clshade::reference
