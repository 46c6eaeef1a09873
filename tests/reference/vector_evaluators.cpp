#include "tests/reference/vector_evaluators.h"

#include "host/reference/absorption.h"
#include "host/reference/anisotropic.h"
#include "host/reference/blinn_phong.h"
#include "host/reference/spectral.h"
#include "host/scene/metal_table.h"
#include "tests/reference/directions.h"
#include "tests/reference/stacks.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace clshade::reference {

namespace {

using nlohmann::json;

Outputs three(const glm::dvec3& v) {
    return {{"0", v.x}, {"1", v.y}, {"2", v.z}};
}

/// Geometry with the azimuth of L; T = (1, 0, 0).
Angles turned_angles(const json& in) {
    const double phi = radians(in.at("phi_l_deg"));
    return unclamped_angles(direction_at(radians(in.at("theta_e_deg")), phi + radians(in.at("dphi_deg"))),
                            direction_at(radians(in.at("theta_l_deg")), phi));
}

Outputs anisotropic(const json& in) {
    const Angles a = turned_angles(in);
    const TangentFrame frame = tangent_frame({1.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    const double n_u = in.at("n_u");
    const double n_v = in.at("n_v");
    const glm::dvec3 f0(in.at("F0").get<double>());
    const double exponent = anisotropic_exponent(a, frame, n_u, n_v);
    const double f_cos = blinn_phong_anisotropic(a, frame, f0, n_u, n_v).x;
    const double cheap = normaliser_anisotropic_cheap(n_u, n_v);
    return {{"exponent", exponent},
            {"norm", normaliser_anisotropic(n_u, n_v)},
            {"specular_f", f_cos / a.nl},
            {"specular_f_cos", f_cos},
            {"norm_cheap", cheap},
            {"specular_f_cheap", cheap * schlick_gaussian(f0, a.eh).x * lobe(a, exponent) / std::max(a.nl, a.ne)}};
}

Outputs absorption(const json& in) {
    const glm::dvec3 alpha_d(in.at("alpha_d").get<double>());
    const double nl = in.at("NL");
    const double ne = in.at("NE");
    return {{"original", absorption_original(alpha_d, glm::dvec3(in.at("n1").get<double>()), nl, ne).x},
            {"approximated", absorption_approximated(alpha_d, nl, ne).y},
            {"exp_unrefracted", absorption_original(alpha_d, glm::dvec3(1.0), nl, ne).z}};
}

MaterialValues dual_layer_material(const json& in) {
    const std::map<std::string, FresnelModel> fresnel{{"exact", FresnelModel::exact},
                                                      {"const", FresnelModel::constant}};
    const std::map<std::string, AbsorptionModel> absorb{{"original", AbsorptionModel::original},
                                                        {"approx", AbsorptionModel::approximated},
                                                        {"none", AbsorptionModel::none}};
    const std::map<std::string, DiffuseModel> diffuse{{"lambert", DiffuseModel::lambert},
                                                      {"oren_nayar_improved", DiffuseModel::oren_nayar}};
    LayerValues top = layer_of_index(SpecularModel::blinn_phong, in.at("n1"), in.at("shi_top"));
    top.absorption = glm::dvec3(in.at("alpha").get<double>());
    const LayerValues bottom = layer_of_index(SpecularModel::blinn_phong, in.at("n2"), in.at("shi_bottom"));
    MaterialValues material = stack_of({top, bottom}, fresnel.at(in.at("fresnel")), absorb.at(in.at("absorption")),
                                       diffuse.at(in.at("diffuse")), glm::dvec3(in.at("R_d").get<double>()));
    material.diffuse_shininess = in.value("shi_diffuse", 0.0);
    return material;
}

Outputs dual_layer(const json& in) {
    const Angles a = vector_angles(in.at("theta_l_deg"), in.at("theta_e_deg"), in.at("dphi_deg"));
    const MaterialValues material = dual_layer_material(in);
    const Reflected reflected = reflect(material, a);
    if (a.nl <= 0.0) { // section 0, rule 1
        EXPECT_EQ(reflected.diffuse + reflected.specular, glm::dvec3(0.0));
        return {{"top", 0.0}, {"bottom_spec", 0.0}, {"bottom_diff", 0.0}, {"f", 0.0}, {"fcos", 0.0}};
    }
    const double f_cos = (reflected.diffuse + reflected.specular).x;
    return {{"top", specular_of_layer(material, a, 0).x / a.nl},
            {"bottom_spec", specular_of_layer(material, a, 1).x / a.nl},
            {"bottom_diff", reflected.diffuse.x / a.nl},
            {"f", f_cos / a.nl},
            {"fcos", f_cos}};
}

} // namespace

Evaluators layer_evaluators() {
    return {{"aniso", anisotropic},
            {"fresnel_conductor",
             [](const json& in) {
                 return Outputs{{"", fresnel_conductor(in.at("n"), in.at("k"), in.at("c"))}};
             }},
            {"cmf_fit_xyz", [](const json& in) { return three(cmf_fit_xyz(in.at("lambda_nm"))); }},
            {"spectral_rgb",
             [](const json& in) {
                 const SpectralMetal metal(built_in_metal(in.at("metal").get<std::string>()).value());
                 return three(metal.reflectance(in.at("c").get<double>()));
             }},
            {"fresnel_dielectric",
             [](const json& in) {
                 return Outputs{{"", fresnel_dielectric(in.at("n"), in.at("c"))}};
             }},
            {"f_bottom_exact",
             [](const json& in) {
                 return Outputs{{"", f_bottom_exact(in.at("n1"), in.at("n2"), in.at("c"))}};
             }},
            {"f_bottom_const",
             [](const json& in) {
                 return Outputs{{"", f_bottom_constant(in.at("n1"), in.at("n2"))}};
             }},
            {"absorption", absorption},
            {"dual_layer", dual_layer},
            {"skin_layered_oren_nayar", dual_layer}};
}

} // namespace clshade::reference
