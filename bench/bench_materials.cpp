#include "bench/bench_materials.h"

#include "bench/bench_frame.h"
#include "host/scene/metal_table.h"

#include <array>
#include <cmath>
#include <stdexcept>

namespace clshade {

namespace {

BoundParameter from_planes(int first, int count) {
    BoundParameter parameter;
    parameter.planes = {first, first + (count > 1 ? 1 : 0), first + (count > 1 ? 2 : 0)};
    parameter.averaged = false; // no coverage plane, nothing to divide by
    return parameter;
}

BoundParameter constant(glm::dvec3 value) {
    BoundParameter parameter;
    parameter.constant = value;
    return parameter;
}

BoundParameter constant(double value) {
    return constant(glm::dvec3(value));
}

double f0_of_index(double n) {
    return (n - 1.0) * (n - 1.0) / ((n + 1.0) * (n + 1.0));
}

/// alpha d that gives the colour of a' for light and view along the normal (models.md section 5).
glm::dvec3 optical_depth(const glm::dvec3& approximated) {
    return -0.5 * glm::log(1.0 - 2.0 * approximated);
}

struct Coat {
    double index;
    double shininess;
    glm::dvec3 absorption; ///< a'
};

BoundLayer layer_of(const Coat& coat, AbsorptionModel absorption) {
    BoundLayer layer;
    layer.specular = SpecularModel::blinn_phong;
    layer.f0 = constant(f0_of_index(coat.index));
    layer.shininess = constant(coat.shininess);
    if (absorption == AbsorptionModel::approximated) {
        layer.absorption = constant(coat.absorption);
    } else if (absorption == AbsorptionModel::original) {
        layer.absorption = constant(optical_depth(coat.absorption));
    }
    return layer;
}

/// Top first. All seven leave (0.80, 0.73, 0.62) of the light where light and view are along the normal.
constexpr std::array<Coat, most_coats> coats_top_first{{
    {1.50, 512.0, {0.020, 0.050, 0.100}},
    {1.35, 128.0, {0.010, 0.020, 0.030}},
    {1.60, 256.0, {0.030, 0.015, 0.010}},
    {1.40, 64.0, {0.012, 0.024, 0.036}},
    {1.65, 384.0, {0.005, 0.010, 0.020}},
    {1.45, 96.0, {0.025, 0.020, 0.015}},
    {1.55, 192.0, {0.008, 0.016, 0.012}},
}};

} // namespace

BoundMaterial single_layer(SpecularModel specular, DiffuseModel diffuse) {
    BoundMaterial material;
    material.name = "bench";
    BoundLayer& base = material.base();
    base.specular = specular;
    if (specular == SpecularModel::blinn_phong_spectral) {
        base.metal = built_in_metal("gold").value();
    } else {
        base.f0 = from_planes(bench_f0, 3);
    }
    if (specular == SpecularModel::blinn_phong_anisotropic) {
        base.shininess_u = from_planes(bench_shininess, 1);
        base.shininess_u.scale = 0.25;
        base.shininess_v = from_planes(bench_shininess, 1);
        base.tangent = constant(glm::dvec3(1.0, 0.0, 0.0));
    } else {
        base.shininess = from_planes(bench_shininess, 1);
    }
    material.diffuse = diffuse;
    if (diffuse != DiffuseModel::none) {
        material.albedo = from_planes(bench_albedo, 3);
    }
    if (diffuse != DiffuseModel::none && diffuse != DiffuseModel::lambert) {
        material.diffuse_shininess = from_planes(bench_shininess, 1);
    }
    return material;
}

BoundMaterial layer_base(DiffuseModel diffuse) {
    BoundMaterial material = single_layer(SpecularModel::blinn_phong, diffuse);
    material.base().f0 = constant(f0_of_index(2.0));
    return material;
}

BoundMaterial coated(int coats, FresnelModel fresnel, AbsorptionModel absorption, BoundMaterial base) {
    if (coats < 1 || coats > most_coats) {
        throw std::invalid_argument("a bench material has one to seven coats");
    }
    base.fresnel = fresnel;
    base.absorption = absorption;
    for (int k = coats - 1; k >= 0; --k) {
        base.layers.insert(base.layers.begin(), layer_of(coats_top_first.at(static_cast<std::size_t>(k)), absorption));
    }
    return base;
}

BoundMaterial skin() {
    constexpr double slope_deviation = 0.58;
    constexpr Coat oil{1.47, 128.0, {0.020, 0.028, 0.034}};
    BoundMaterial material = single_layer(SpecularModel::blinn_phong, DiffuseModel::oren_nayar);
    material.absorption = AbsorptionModel::approximated;
    material.base().f0 = constant(f0_of_index(1.40));
    material.base().shininess = constant(12.0);
    material.diffuse_shininess = constant(2.0 / (slope_deviation * slope_deviation));
    material.layers.insert(material.layers.begin(), layer_of(oil, material.absorption));
    return material;
}

} // namespace clshade
