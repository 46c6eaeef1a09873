#include "host/reference/layers.h"

#include "host/reference/absorption.h"
#include "host/reference/blinn_phong.h"
#include "host/reference/fresnel.h"

#include <algorithm>

namespace clshade::reference {

namespace {

/// `yes` in the channels where the condition holds, else `no`.
glm::dvec3 select(const glm::bvec3& condition, const glm::dvec3& yes, const glm::dvec3& no) {
    return glm::mix(no, yes, condition);
}

/// r_k of an interface that is there.
glm::dvec3 reflectance_at_normal_incidence(const LayerValues& layer, const Interface& interface) {
    if (glm::all(interface.outer)) {
        return layer.f0;
    }
    if (layer.specular == SpecularModel::blinn_phong_spectral) {
        return layer.metal->reflectance(interface.above, glm::dvec3(1.0));
    }
    glm::dvec3 r(0.0);
    for (int i = 0; i < 3; ++i) {
        // Against air that is f0 itself, spared the way over n.
        r[i] = interface.outer[i] ? layer.f0[i] : f0_between(interface.above[i], interface.medium[i]);
    }
    return r;
}

/// `outer`: nothing above it has an interface. Not told from m_{k-1} = 1: n of an F0 below 1e-32 rounds to 1.
Interface find_interface(const LayerValues& layer, bool is_base, const glm::dvec3& above, const glm::bvec3& outer) {
    Interface interface;
    interface.above = above;
    interface.outer = outer;
    for (int i = 0; i < 3; ++i) {
        interface.present[i] = layer.specular != SpecularModel::none && (is_base || layer.f0[i] > 0.0);
    }
    interface.medium = select(interface.present, layer.index, above);
    interface.r = select(interface.present, reflectance_at_normal_incidence(layer, interface), glm::dvec3(0.0));
    return interface;
}

/// F where an interface is met from air, fresnel = constant.
glm::dvec3 outer_fresnel(const LayerValues& layer, double eh) {
    switch (layer.specular) {
    case SpecularModel::none:
        break;
    case SpecularModel::blinn_phong:
        return schlick_gaussian(layer.interface.r, eh);
    case SpecularModel::blinn_phong_exact:
    case SpecularModel::blinn_phong_anisotropic:
        return schlick(layer.interface.r, eh);
    case SpecularModel::blinn_phong_spectral:
        return layer.metal->reflectance(eh);
    }
    return glm::dvec3(0.0);
}

glm::dvec3 exact_fresnel(const LayerValues& layer, double eh) {
    const Interface& interface = layer.interface;
    glm::dvec3 cosine(0.0);
    for (int i = 0; i < 3; ++i) {
        cosine[i] = refracted_cosine(eh, interface.above[i]);
    }
    if (layer.specular == SpecularModel::blinn_phong_spectral) {
        return layer.metal->reflectance(interface.above, cosine);
    }
    glm::dvec3 f(0.0);
    for (int i = 0; i < 3; ++i) {
        f[i] = fresnel_dielectric(relative_index(interface.above[i], interface.medium[i]), cosine[i]);
    }
    return f;
}

/// Diffuse weight of the base's own interface, fresnel = constant; U as in layers.h.
glm::dvec3 base_diffuse_weight(const LayerValues& base, const glm::dvec3& u, const Angles& angles) {
    const glm::dvec3 weight = 1.0 - base.interface.r * u;
    if (base.specular != SpecularModel::blinn_phong_exact) {
        return weight;
    }
    return select(base.interface.outer, diffuse_weight_exact(angles, base.interface.r), weight);
}

} // namespace

void find_interfaces(MaterialValues& material) {
    glm::dvec3 above(1.0);
    glm::bvec3 outer(true);
    for (LayerValues& layer : material.layers()) {
        layer.interface = find_interface(layer, &layer == &material.base(), above, outer);
        above = layer.interface.medium;
        for (int i = 0; i < 3; ++i) {
            outer[i] = outer[i] && !layer.interface.present[i];
        }
    }
}

glm::dvec3 interface_fresnel(const LayerValues& layer, FresnelModel model, double eh) {
    const Interface& interface = layer.interface;
    if (layer.specular == SpecularModel::none) {
        return glm::dvec3(0.0);
    }
    if (model == FresnelModel::exact) {
        return select(interface.present, exact_fresnel(layer, eh), glm::dvec3(0.0));
    }
    if (!glm::any(interface.outer)) {
        return interface.r;
    }
    const glm::dvec3 f = select(interface.outer, outer_fresnel(layer, eh), interface.r);
    return select(interface.present, f, glm::dvec3(0.0));
}

double lobe_f_cos(const LayerValues& layer, FresnelModel model, const Angles& angles) {
    const double cosine = attenuated_cosine(angles);
    switch (layer.specular) {
    case SpecularModel::none:
        break;
    case SpecularModel::blinn_phong:
    case SpecularModel::blinn_phong_spectral: {
        const double norm =
            model == FresnelModel::exact ? normaliser_exact(layer.shininess) : normaliser_linear(layer.shininess);
        return norm * lobe(angles, layer.shininess) * cosine;
    }
    case SpecularModel::blinn_phong_exact:
        return normaliser_exact(layer.shininess) * lobe(angles, layer.shininess) * cosine;
    case SpecularModel::blinn_phong_anisotropic:
        return anisotropic_f_cos(angles, layer.frame, layer.shininess_u, layer.shininess_v);
    }
    return 0.0;
}

glm::dvec3 layer_absorption(const LayerValues& layer, AbsorptionModel model, const Angles& angles) {
    switch (model) {
    case AbsorptionModel::none:
        break;
    case AbsorptionModel::approximated:
        return absorption_approximated(layer.absorption, angles.nl, angles.ne);
    case AbsorptionModel::original:
        return absorption_original(layer.absorption, layer.interface.medium, angles.nl, angles.ne);
    }
    return glm::dvec3(1.0);
}

StackWeights stack_weights(const MaterialValues& material, const Angles& angles) {
    const bool exact = material.fresnel == FresnelModel::exact;
    const std::span<const LayerValues> layers = material.layers();
    const std::size_t base = layers.size() - 1;
    StackWeights weights;
    glm::dvec3 to_specular(1.0); // prod (1 - F_j)(1 - r_j), or prod (1 - F_j)^2
    glm::dvec3 a(1.0);           // prod A_j
    glm::dvec3 u(1.0);           // U_k
    for (std::size_t k = 0; k < base; ++k) {
        const LayerValues& layer = layers[k];
        const glm::dvec3 r = layer.interface.r;
        const glm::dvec3 f = interface_fresnel(layer, material.fresnel, angles.eh);
        weights.specular[k] = f * to_specular * a;
        const glm::dvec3 through = (1.0 - f) * (exact ? 1.0 - f : 1.0 - r);
        to_specular *= through;
        weights.diffuse *= exact ? through : select(layer.interface.outer, 1.0 - f, 1.0 - r * u);
        u *= 1.0 - r;
        a *= layer_absorption(layer, material.absorption, angles);
    }
    const glm::dvec3 f = interface_fresnel(layers[base], material.fresnel, angles.eh);
    weights.specular[base] = f * to_specular * a;
    weights.diffuse *= a * (exact ? 1.0 - f : base_diffuse_weight(layers[base], u, angles));
    return weights;
}

} // namespace clshade::reference
