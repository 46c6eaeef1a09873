// The published test vectors: tests/data/vectors.json (full precision) and tests/data/vectors_tables.json (the other
// rows of the tables in models.md, printed to nine digits, hence their tolerance of 5e-9).
#include "host/reference/blinn_phong.h"
#include "host/reference/diffuse.h"
#include "host/reference/fresnel.h"
#include "tests/reference/directions.h"
#include "tests/reference/vector_evaluators.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <string>

namespace clshade::reference {
namespace {

using nlohmann::json;

Angles angles_of(const json& in) {
    return vector_angles(in.at("theta_l_deg"), in.at("theta_e_deg"), in.at("dphi_deg"));
}

Outputs blinn_phong_outputs(const json& in, bool exact) {
    const Angles a = angles_of(in);
    if (a.nl <= 0.0 || a.ne <= 0.0) { // section 0, rule 1
        return {{"diffuse_f", 0.0}, {"specular_f", 0.0}, {"f", 0.0}, {"f_cos", 0.0}};
    }
    const glm::dvec3 f0(in.at("F0").get<double>());
    const glm::dvec3 rho(in.at("R_d").get<double>());
    const double n = in.at("n");
    const double diffuse = (lambert(a, rho) * (exact ? diffuse_weight_exact(a, f0) : diffuse_weight(f0))).x;
    const double specular = (exact ? blinn_phong_exact(a, f0, n) : blinn_phong(a, f0, n)).x;
    return {{"diffuse_f", diffuse / a.nl},
            {"specular_f", specular / a.nl},
            {"f", (diffuse + specular) / a.nl},
            {"f_cos", diffuse + specular}};
}

template <class Model>
Outputs oren_nayar_output(const json& in, const char* parameter, Model model) {
    const Angles a = angles_of(in);
    if (a.nl <= 0.0 || a.ne <= 0.0) {
        return {{"", 0.0}};
    }
    return {{"", model(a, glm::dvec3(in.at("rho").get<double>()), in.at(parameter).get<double>()).x}};
}

Evaluators single_layer_evaluators() {
    return {
        {"norm_exact",
         [](const json& in) {
             return Outputs{{"", normaliser_exact(in.at("n"))}};
         }},
        {"norm_linear",
         [](const json& in) {
             return Outputs{{"", normaliser_linear(in.at("n"))}};
         }},
        {"fresnel_schlick",
         [](const json& in) {
             return Outputs{{"", schlick(glm::dvec3(in.at("F0").get<double>()), in.at("c")).y}};
         }},
        {"fresnel_schlick_sg",
         [](const json& in) {
             return Outputs{{"", schlick_gaussian(glm::dvec3(in.at("F0").get<double>()), in.at("c")).z}};
         }},
        {"bp_exact", [](const json& in) { return blinn_phong_outputs(in, true); }},
        {"bp_approx", [](const json& in) { return blinn_phong_outputs(in, false); }},
        {"oren_nayar_full",
         [](const json& in) {
             const Angles a = angles_of(in);
             if (a.nl <= 0.0 || a.ne <= 0.0) {
                 return Outputs{{"L1", 0.0}, {"L2", 0.0}, {"L", 0.0}};
             }
             const double sigma = in.at("sigma");
             const auto parts = oren_nayar_full(a, glm::dvec3(in.at("rho").get<double>()), sigma * sigma);
             return Outputs{{"L1", parts.l1.x}, {"L2", parts.l2.x}, {"L", parts.l1.x + parts.l2.x}};
         }},
        {"oren_nayar_qualitative",
         [](const json& in) {
             return oren_nayar_output(in, "sigma", [](const Angles& a, const glm::dvec3& rho, double sigma) {
                 return oren_nayar_qualitative(a, rho, sigma * sigma);
             });
         }},
        {"oren_nayar_shininess", [](const json& in) { return oren_nayar_output(in, "shi", oren_nayar_shininess); }},
        {"oren_nayar_improved", [](const json& in) { return oren_nayar_output(in, "shi", oren_nayar_improved); }},
        {"oren_nayar_coefficients",
         [](const json& in) {
             const double shi = in.at("shi");
             // The table writes 1e30 for the infinite sigma of shininess 0.
             const double sigma = shi == 0.0 ? 1e30 : std::sqrt(sigma2_of_shininess(shi));
             return Outputs{
                 {"A", shininess_a(shi)}, {"B", shininess_b(shi)}, {"A_improved", improved_a(shi)}, {"sigma", sigma}};
         }},
    };
}

const Evaluators& evaluators() {
    static const Evaluators table = [] {
        Evaluators all = single_layer_evaluators();
        all.merge(layer_evaluators());
        all.merge(ambient_evaluators());
        return all;
    }();
    return table;
}

Outputs expected_outputs(const json& output) {
    if (output.is_number()) {
        return {{"", output.get<double>()}};
    }
    if (output.is_array()) {
        Outputs outputs;
        for (std::size_t i = 0; i < output.size(); ++i) {
            outputs[std::to_string(i)] = output.at(i);
        }
        return outputs;
    }
    return output.get<Outputs>();
}

/// Checks every vector of a model built today; returns how many per model.
std::map<std::string, int> check_file(const std::string& name) {
    std::ifstream file(std::string(CLSHADE_TEST_DATA) + "/" + name);
    const json vectors = json::parse(file);
    std::map<std::string, int> checked;
    for (const json& vector : vectors) {
        const auto evaluator = evaluators().find(vector.at("model"));
        if (evaluator == evaluators().end()) {
            continue; // a model of a later release
        }
        ++checked[vector.at("model")];
        const Outputs actual = evaluator->second(vector.at("inputs"));
        const double tolerance = vector.at("tolerance");
        for (const auto& [output, value] : expected_outputs(vector.at("output"))) {
            const auto found = actual.find(output);
            if (found == actual.end()) {
                ADD_FAILURE() << "no output " << output << " in " << vector.dump();
                continue;
            }
            EXPECT_LE(std::abs(found->second - value), tolerance * std::max(1.0, std::abs(value)))
                << output << " = " << found->second << " in " << vector.dump();
            // Nine printed digits: half a unit of the ninth is at most 5e-9 of the value, however small the value is.
            EXPECT_LE(std::abs(found->second - value), std::max(tolerance, 5e-9) * std::abs(value) + 1e-300)
                << output << " = " << found->second << " in " << vector.dump();
        }
    }
    return checked;
}

TEST(Vectors, FullPrecision) {
    const std::map<std::string, int> expected{{"norm_exact", 3},
                                              {"norm_linear", 2},
                                              {"fresnel_schlick", 3},
                                              {"fresnel_schlick_sg", 3},
                                              {"bp_exact", 4},
                                              {"bp_approx", 4},
                                              {"oren_nayar_full", 5},
                                              {"oren_nayar_qualitative", 4},
                                              {"oren_nayar_shininess", 5},
                                              {"oren_nayar_improved", 4},
                                              {"oren_nayar_coefficients", 3},
                                              {"aniso", 3},
                                              {"fresnel_conductor", 3},
                                              {"cmf_fit_xyz", 2},
                                              {"spectral_rgb", 3},
                                              {"fresnel_dielectric", 3},
                                              {"f_bottom_exact", 3},
                                              {"f_bottom_const", 2},
                                              {"absorption", 3},
                                              {"dual_layer", 10},
                                              {"skin_layered_oren_nayar", 3},
                                              {"ambient_brdf", 7},
                                              {"pmrem_kernel", 4},
                                              {"pmrem_zonal", 2},
                                              {"mip_of_shininess", 4},
                                              {"sh9_basis", 2},
                                              {"sh_directional_radiance", 3},
                                              {"layer_preintegrated", 3},
                                              {"dual_layer_ibl", 7},
                                              {"sh_oren_nayar", 6},
                                              {"sh_oren_nayar_K", 3},
                                              {"sh_oren_nayar_linear_exact", 2}};
    EXPECT_EQ(check_file("vectors.json"), expected);
}

TEST(Vectors, FurtherRowsOfTheTables) {
    const auto checked = check_file("vectors_tables.json");
    EXPECT_EQ(checked.size(), evaluators().size()); // every model has rows there too
    int rows = 0;
    for (const auto& [model, count] : checked) {
        rows += count;
    }
    EXPECT_EQ(rows, 115);
}

} // namespace
} // namespace clshade::reference
