// Stacks of layers made by hand or at random, without a frame.
#pragma once

#include "host/reference/brdf.h"
#include "host/reference/fresnel.h"
#include "host/reference/layers.h"
#include "host/reference/surface.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <vector>

namespace clshade::reference {

inline LayerValues layer_of(SpecularModel model, const glm::dvec3& f0, double shininess) {
    LayerValues layer;
    layer.specular = model;
    layer.f0 = f0;
    for (int i = 0; i < 3; ++i) {
        layer.index[i] = index_of_f0(f0[i]);
    }
    layer.shininess = shininess;
    layer.shininess_u = shininess;
    layer.shininess_v = shininess;
    layer.tangent_read = {1.0, 0.0, 0.0};
    return layer;
}

inline LayerValues layer_of_index(SpecularModel model, double n, double shininess) {
    return layer_of(model, glm::dvec3(f0_between(1.0, n)), shininess);
}

inline LayerValues layer_of_metal(const SpectralMetal& metal, double shininess) {
    LayerValues layer = layer_of(SpecularModel::blinn_phong_spectral, metal.f0(), shininess);
    layer.metal = &metal;
    return layer;
}

/// Top first, on N = (0, 0, 1).
inline MaterialValues stack_of(const std::vector<LayerValues>& layers, FresnelModel fresnel,
                               AbsorptionModel absorption = AbsorptionModel::none,
                               DiffuseModel diffuse = DiffuseModel::none, const glm::dvec3& albedo = glm::dvec3(0.0)) {
    MaterialValues material;
    material.fresnel = fresnel;
    material.absorption = absorption;
    material.diffuse = diffuse;
    material.albedo = albedo;
    material.diffuse_shininess = 5.945;
    material.resize(layers.size());
    std::copy(layers.begin(), layers.end(), material.layers().begin());
    find_tangents(material, {0.0, 0.0, 1.0});
    find_interfaces(material);
    return material;
}

/// f_cos of layer k's lobe alone.
inline glm::dvec3 specular_of_layer(const MaterialValues& material, const Angles& angles, std::size_t k) {
    return lobe_f_cos(material.layers()[k], material.fresnel, angles) * stack_weights(material, angles).specular[k];
}

} // namespace clshade::reference
