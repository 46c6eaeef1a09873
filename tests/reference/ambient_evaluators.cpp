// Evaluators of the published vectors of sections 6, 7 and 9 of models.md.
#include "host/reference/environment_light.h"
#include "host/reference/preintegrated_absorption.h"
#include "host/reference/radiance_filter.h"
#include "host/reference/sh_oren_nayar.h"
#include "host/reference/spherical_harmonics.h"
#include "tests/reference/stacks.h"
#include "tests/reference/vector_evaluators.h"
#include "tests/reference/zonal.h"

#include <array>
#include <cmath>
#include <map>
#include <string>

namespace clshade::reference {

namespace {

using nlohmann::json;

Outputs ambient_brdf_outputs(const json& in) {
    const Normaliser normaliser = in.at("norm") == "linear" ? Normaliser::linear : Normaliser::exact;
    const AmbientBrdf brdf = ambient_brdf(in.at("n"), in.at("NE"), normaliser);
    return {{"scale", brdf.scale}, {"bias", brdf.bias}};
}

Outputs zonal_outputs(const json& in) {
    Outputs outputs;
    for (int l = 0; l < 4; ++l) {
        outputs[std::to_string(l)] = zonal_coefficient(in.at("n"), l);
    }
    return outputs;
}

Outputs basis_outputs(const json& in) {
    const auto d = in.at("d").get<std::array<double, 3>>();
    const std::array<double, 9> basis = sh_basis({d[0], d[1], d[2]});
    Outputs outputs;
    for (std::size_t i = 0; i < basis.size(); ++i) {
        outputs[std::to_string(i)] = basis.at(i);
    }
    return outputs;
}

/// A distant light of irradiance E0 from +z, projected; seen by a normal at an angle gamma to it.
Outputs directional_outputs(const json& in) {
    const std::array<double, 9> towards = sh_basis({0.0, 0.0, 1.0});
    ShRadiance sh{};
    for (std::size_t i = 0; i < sh.size(); ++i) {
        sh[i] = glm::dvec3(in.at("E0").get<double>() * towards.at(i));
    }
    const double c = in.at("cos_gamma");
    const glm::dvec3 normal{std::sqrt(1.0 - c * c), 0.0, c};
    const double rho = in.at("rho");
    const double order2 = rho * (sh_irradiance_band(sh, 0, normal) + sh_irradiance_band(sh, 1, normal)).x;
    return {{"order2", order2}, {"order3", order2 + rho * sh_irradiance_band(sh, 2, normal).x}};
}

Outputs preintegrated_outputs(const json& in) {
    const glm::dvec3 a(in.at("alpha").get<double>());
    const double ne = in.at("NE");
    const auto deck = preintegrated_absorption(AmbientAbsorption::deck, a, ne);
    return {{"specular", deck.specular.x},
            {"diffuse", deck.diffuse.x},
            {"diffuse_clamped", preintegrated_absorption(AmbientAbsorption::clamped, a, ne).diffuse.y},
            {"diffuse_exp", preintegrated_absorption(AmbientAbsorption::exponential, a, ne).diffuse.z}};
}

Outputs dual_layer_ibl(const json& in) {
    const std::map<std::string, AmbientAbsorption> variants{{"deck", AmbientAbsorption::deck},
                                                            {"clamped", AmbientAbsorption::clamped},
                                                            {"exp", AmbientAbsorption::exponential}};
    LayerValues top = layer_of_index(SpecularModel::blinn_phong, in.at("n1"), in.at("shi_top"));
    top.absorption = glm::dvec3(in.at("alpha").get<double>());
    const LayerValues bottom = layer_of_index(SpecularModel::blinn_phong, in.at("n2"), in.at("shi_bottom"));
    MaterialValues material = stack_of({top, bottom}, FresnelModel::constant, AbsorptionModel::approximated,
                                       in.contains("shi_diffuse") ? DiffuseModel::oren_nayar : DiffuseModel::lambert,
                                       glm::dvec3(in.at("R_d").get<double>()));
    material.diffuse_shininess = in.value("shi_diffuse", 0.0);
    material.absorption_ibl = variants.at(in.at("variant"));
    material.ambient = AmbientDiffuse::fit; // these vectors have D from its polynomial
    const double x = in.at("NE");
    std::array<LayerAmbient, most_layers> ambient{};
    for (std::size_t k = 0; k < 2; ++k) { // integrated, not from the table
        const LayerValues& layer = material.layers()[k];
        ambient.at(k).brdf = ambient_brdf(layer.shininess, x, ambient_normaliser(layer, material.fresnel));
    }
    const AmbientWeights weights = ambient_weights(material, x, ambient);
    DiffuseLight light;
    light.constant = glm::dvec3(in.at("irradiance_over_pi").get<double>());
    const double above = weights.specular[0].x * in.at("pmrem_top").get<double>();
    const double below = weights.specular[1].y * in.at("pmrem_bottom").get<double>();
    const double diffuse = (material.albedo * weights.diffuse * diffuse_response(material, x, light)).z;
    return {{"top", above}, {"bottom_spec", below}, {"bottom_diff", diffuse}, {"L", above + below + diffuse}};
}

Outputs sh_oren_nayar_outputs(const json& in) {
    const double n = in.at("shi");
    const double x = in.at("NE");
    const auto d = [&](AmbientDiffuse form) { return sh_dc_factor(form, n, x, glm::dvec3(0.5)).x; };
    return {{"DC", d(AmbientDiffuse::precise)},
            {"DC_fit", d(AmbientDiffuse::fit)},
            {"DC_coarse", d(AmbientDiffuse::coarse)},
            {"DC_coarsest", d(AmbientDiffuse::coarsest)},
            {"DC_full_fit_rho05", d(AmbientDiffuse::full)},
            {"S", sh_linear_factor(n, x)}};
}

} // namespace

Evaluators ambient_evaluators() {
    return {{"ambient_brdf", ambient_brdf_outputs},
            {"pmrem_kernel",
             [](const json& in) {
                 return Outputs{{"", radiance_lobe(in.at("n"), in.at("c"))}};
             }},
            {"pmrem_zonal", zonal_outputs},
            {"mip_of_shininess",
             [](const json& in) { // the published levels fall by four
                 return Outputs{{"", mip_of_shininess(in.at("n"), in.at("n_max"), in.at("mip_max"), 2.0)}};
             }},
            {"sh9_basis", basis_outputs},
            {"sh_directional_radiance", directional_outputs},
            {"layer_preintegrated", preintegrated_outputs},
            {"dual_layer_ibl", dual_layer_ibl},
            {"sh_oren_nayar", sh_oren_nayar_outputs},
            {"sh_oren_nayar_K",
             [](const json& in) {
                 const double x = in.at("NE");
                 return Outputs{{"K", sh_k(x)}, {"K_fit", sh_k_fit(x)}, {"K_full_fit", sh_k_full_fit(x)}};
             }},
            {"sh_oren_nayar_linear_exact", [](const json& in) {
                 const ShLinearExact exact = sh_linear_exact(in.at("shi"), in.at("NE"));
                 return Outputs{{"a_N", exact.along_normal}, {"a_T", exact.along_tangent}};
             }}};
}

} // namespace clshade::reference
